"""The API of Python: every public name of the package, by its docstrings."""

import inspect

import mrbd

PARTS = {
    "Walls, records, runs": ["Wall", "Diaphragm", "Record", "simulate", "Run", "simulate_many", "Table", "effects"],
    "One wall asked": ["push", "Push", "assess", "Assessment", "margin", "Margin", "risk", "Risk"],
    "Studies and fragility": ["study", "Study", "fragility", "Fragility"],
    "The laboratory": ["calibrate", "Calibration", "diagnose", "Diagnosis"],
    "Errors and warnings": ["InputError", "Error", "Interrupted", "Question"],
}


def python_api() -> str:
    """The page, in reStructuredText."""
    named = {name for names in PARTS.values() for name in names} | {"PATTERNS", "records"}
    if named != set(mrbd.__all__):
        raise SystemExit(f"names without a place in the API's page: {named ^ set(mrbd.__all__)}")
    lines = [*title("API of Python", "="), ".. automodule:: mrbd", "   :no-members:", ""]
    for part, names in PARTS.items():
        lines += [*title(part, "-"), *(line for name in names for line in entry(f"mrbd.{name}", getattr(mrbd, name)))]
    lines += title("mrbd.records", "-") + [".. automodule:: mrbd.records", "   :no-members:", ""]
    for name in mrbd.records.__all__:
        lines += entry(f"mrbd.records.{name}", getattr(mrbd.records, name))
    return "\n".join(lines) + "\n"


def title(text: str, line: str) -> list[str]:
    return [text, line * len(text), ""]


def entry(name: str, value: object) -> list[str]:
    if inspect.isclass(value):
        return [f".. autoclass:: {name}", "   :members:", "   :inherited-members: Exception, ValueError, Sequence", ""]
    return [f".. autofunction:: {name}", ""]

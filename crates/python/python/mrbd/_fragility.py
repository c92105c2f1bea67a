"""Fragility curves of tables and studies."""

from __future__ import annotations

import csv
import tempfile
import warnings
from collections.abc import Sequence
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mrbd._mrbd import Table, fit_fragility, write_parquet

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Fragility:
    """Fitted fragilities, one a group and limit, with what `mrbd fragility --json` tells of each."""

    def __init__(self, json: dict[str, Any], text: str, curves: str) -> None:
        self.json = json
        """Everything, as `mrbd fragility --json` prints it."""
        self._text, self._curves = text, curves

    @property
    def groups(self) -> list[dict[str, Any]]:
        """Each fragility: its group, median, β, intervals, fit; or why there is none."""
        groups: list[dict[str, Any]] = self.json["groups"]
        return groups

    @property
    def median(self) -> float:
        """Median of the only fragility, in the unit of its intensity."""
        return float(self._only()["median"])

    @property
    def beta(self) -> float:
        """Logarithmic standard deviation of the only fragility."""
        return float(self._only()["beta"])

    def _only(self) -> dict[str, Any]:
        if len(self.groups) != 1:
            raise ValueError(f"{len(self.groups)} fragilities; `groups` has them all")
        if self.groups[0]["status"] != "fitted":
            raise ValueError(self.groups[0]["message"])
        return self.groups[0]

    def curves(self) -> list[dict[str, Any]]:
        """The curves: the group, and arrays `intensity`, `probability`, `lower`, `upper` (NaN where open)."""
        import numpy as np

        rows = list(csv.DictReader(self._curves.splitlines()))
        names = ["intensity", "probability", "lower", "upper"]
        curves: dict[tuple[str, ...], dict[str, Any]] = {}
        for row in rows:
            group = {name: text for name, text in row.items() if name not in names}
            curve = curves.setdefault(tuple(group.values()), {"group": group, **{name: [] for name in names}})
            for name in names:
                curve[name].append(float(row[name] or "nan"))
        return [{**curve, **{name: np.array(curve[name]) for name in names}} for curve in curves.values()]

    def probability(self, intensity: Any) -> NDArray[np.float64]:
        """Probability of the only fragility at intensities: Φ(ln(x/median)/β)."""
        from math import erf, sqrt

        import numpy as np

        x = np.log(np.asarray(intensity, dtype=float) / self.median) / self.beta
        probability: NDArray[np.float64] = np.vectorize(lambda z: 0.5 * (1.0 + erf(z / sqrt(2.0))), otypes=[float])(x)
        return probability

    def plot(self, ax: Any = None) -> Any:
        """Draw the curves with their intervals by matplotlib; the axes."""
        from mrbd._plots import fragility as draw

        return draw(self, ax)

    def __repr__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self._text)}</pre>"


def _many(option: str, values: Sequence[Any] | Any) -> list[str]:
    if values is None:
        return []
    values = [values] if isinstance(values, (str, int, float)) else values
    return [f"{option}={value}" for value in values]


def fragility(
    table: Any,
    *,
    intensity: str | None = None,
    outcome: str | None = None,
    threshold: float | Sequence[float] | None = None,
    exceeds: float | None = None,
    trials: str | None = None,
    group: str | Sequence[str] | None = None,
    cluster: str | Sequence[str] | None = None,
    method: str | None = None,
    demand: str | None = None,
    limit: float | None = None,
    level: float | None = None,
    replicates: int | None = None,
    seed: int | None = None,
) -> Fragility:
    """Fit log-normal fragilities to outcomes at known intensities, as `mrbd fragility` does.

    `table` is a data frame or any table of the Arrow interface, a file (.csv, .parquet), or the folder of a study. The
    arguments are the options of the command.
    """
    if isinstance(table, (str, PathLike)):
        return _fitted(fspath(table), locals())
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "table.parquet"
        write_parquet(Table(table), file)
        return _fitted(str(file), locals())


def _fitted(file: str, asked: dict[str, Any]) -> Fragility:
    options = [
        "intensity",
        "outcome",
        "threshold",
        "exceeds",
        "trials",
        "group",
        "cluster",
        "method",
        "demand",
        "limit",
    ]
    words = ["mrbd.fragility", file]
    for option in [*options, "level", "replicates", "seed"]:
        words += _many(f"--{option}", asked[option])
    json, text, curves, notes = fit_fragility(words)
    for note in notes:
        warnings.warn(note.replace("--", ""), stacklevel=3)
    return Fragility(json, text, curves)

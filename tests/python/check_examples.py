"""Every example gives the medians that `mrbd aggregate` gives.

    python tests/python/check_examples.py MEDIANS.csv DIR EXAMPLE.py ...

MEDIANS.csv is what `mrbd aggregate DIR --csv` prints, of a sweep or of façades drawn under the records' own scale.
"""

import csv
import importlib.util
import math
import sys
from pathlib import Path


def expected(path):
    chosen = {"variant": "base", "parameter": "stiffness", "level": "mu", "measure": "theta1_max_over_alpha1"}
    with open(path, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if all(row[key] == value for key, value in chosen.items())]
    # No median: it lands among collapses.
    medians = {(row["configuration"], float(row["slenderness"])): float(row["median"] or "inf") for row in rows}
    assert len(medians) == 10, f"2 floors, 5 slendernesses: {len(medians)}"
    return medians


def expected_of_draws(path):
    with open(path, encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["quantity"] == "theta1_max_over_alpha1" and not row["record"]]
    medians = {row["configuration"]: float(row["median"] or "inf") for row in rows}
    assert len(medians) == len(rows) == 2, f"2 floors: {len(rows)}"
    return medians


def load(path):
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main(medians_path, folder, *examples):
    with open(medians_path, encoding="utf-8") as file:
        of_draws = "quantity" in file.readline().rstrip().split(",")
    medians = expected_of_draws(medians_path) if of_draws else expected(medians_path)
    for path in examples:
        module = load(path)
        found = module.medians(folder)
        assert found.keys() == medians.keys(), f"{path}: {sorted(found)}"
        for case, value in medians.items():
            # An odd number of records: the median is one of them. An even one: a sum and a product, 1e-16 each.
            same = found[case] == value or math.isclose(found[case], value, rel_tol=1e-14)
            assert same, f"{path}: {case}: {found[case]} against {value}"
        if hasattr(module, "units"):
            assert module.units(folder)["stiffness_n_per_m"][0] == "N/m"
        print(f"{path}: {len(medians)} medians agree")


if __name__ == "__main__":
    main(*sys.argv[1:])

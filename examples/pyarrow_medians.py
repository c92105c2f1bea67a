"""Medians over the records with pyarrow alone, and what the files say about themselves.

    python examples/pyarrow_medians.py outputs/sweep
"""

import statistics
import sys
from collections import defaultdict
from pathlib import Path

import pyarrow.dataset as ds


def open_runs(folder):
    return ds.dataset(Path(folder) / "runs", format="parquet")


def medians(folder):
    """{(configuration, slenderness): median θ₁/α₁}; inf where the median wall collapsed."""
    chosen = (ds.field("variant") == "base") & (ds.field("parameter") == "stiffness") & (ds.field("level") == "mu")
    columns = ["configuration", "slenderness", "outcome", "theta1_max_over_alpha1"]
    table = open_runs(folder).to_table(columns=columns, filter=chosen)
    rotations = defaultdict(list)
    for run in table.to_pylist():
        if run["outcome"] != "failed":
            stood = run["outcome"] == "stood"
            rotation = run["theta1_max_over_alpha1"] if stood else float("inf")
            rotations[run["configuration"], run["slenderness"]].append(rotation)
    return {case: statistics.median(values) for case, values in sorted(rotations.items())}


def units(folder):
    """{column: (unit, meaning)}, as every file tells."""
    described = {field.name: field.metadata for field in open_runs(folder).schema}
    return {name: (about[b"unit"].decode(), about[b"description"].decode()) for name, about in described.items()}


if __name__ == "__main__":
    for column, (unit, meaning) in units(sys.argv[1]).items():
        print(f"# {column} [{unit}]: {meaning}")
    for case, median in medians(sys.argv[1]).items():
        print(*case, median)

"""Medians over the records with pandas; pandas reads Parquet through pyarrow.

    python examples/pandas_medians.py outputs/sweep
"""

import sys
from pathlib import Path

import pandas as pd

COLUMNS = ["variant", "configuration", "parameter", "level", "slenderness", "outcome", "theta1_max_over_alpha1"]


def medians(folder):
    """{(configuration, slenderness): median θ₁/α₁}; inf where the median wall collapsed."""
    # `partitioning=None`: the record stands in the files too, and would otherwise come twice.
    runs = pd.read_parquet(Path(folder) / "runs", columns=COLUMNS, partitioning=None)
    runs = runs[(runs.variant == "base") & (runs.parameter == "stiffness") & (runs.level == "mu")]
    rotation = runs.theta1_max_over_alpha1.mask(runs.outcome == "collapsed", float("inf"))
    keys = [runs.configuration.astype(str), runs.slenderness]
    return rotation.groupby(keys).median().to_dict()


if __name__ == "__main__":
    for case, median in medians(sys.argv[1]).items():
        print(*case, median)

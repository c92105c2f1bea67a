"""Medians over drawn façades and records with polars, lazily.

    python examples/polars_monte_carlo.py outputs/monte_carlo
"""

import sys
from pathlib import Path

import polars as pl


def medians(folder):
    """{configuration: median θ₁/α₁}; inf where the median wall collapsed."""
    rotation = (
        pl.when(pl.col("outcome") == "stood")
        .then(pl.col("theta1_max_over_alpha1"))
        .when(pl.col("outcome") == "collapsed")
        .then(pl.lit(float("inf")))
    )
    frame = (
        pl.scan_parquet(str(Path(folder) / "runs/*/*.parquet"))
        .with_columns(pl.col("variant", "configuration", "outcome").cast(pl.String))
        .filter(variant=pl.lit("base"))
        .group_by("configuration")
        .agg(rotation.median().alias("median"))
        .sort("configuration")
        .collect()
    )
    return dict(frame.rows())


if __name__ == "__main__":
    for case, median in medians(sys.argv[1]).items():
        print(case, median)

"""Medians over the records with polars, lazily: only the columns and files that are needed are read.

    python examples/polars_medians.py outputs/sweep
"""

import sys
from pathlib import Path

import polars as pl


def medians(folder):
    """{(configuration, slenderness): median θ₁/α₁}; inf where the median wall collapsed."""
    text = pl.col("variant", "configuration", "parameter", "level", "outcome").cast(pl.String)
    rotation = (
        pl.when(pl.col("outcome") == "stood")
        .then(pl.col("theta1_max_over_alpha1"))
        .when(pl.col("outcome") == "collapsed")
        .then(pl.lit(float("inf")))
    )
    frame = (
        pl.scan_parquet(str(Path(folder) / "runs/*/*.parquet"))
        .with_columns(text)
        .filter(variant=pl.lit("base"), parameter=pl.lit("stiffness"), level=pl.lit("mu"))
        .group_by("configuration", "slenderness")
        .agg(rotation.median().alias("median"))
        .sort("configuration", "slenderness")
        .collect()
    )
    return {(configuration, slenderness): median for configuration, slenderness, median in frame.rows()}


if __name__ == "__main__":
    for case, median in medians(sys.argv[1]).items():
        print(*case, median)

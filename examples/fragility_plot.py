"""A fragility plot: the curves that `mrbd fragility` fitted, over the shares of runs that the Parquet files tell.

    make fragility
    python examples/fragility_plot.py outputs/fragility/curves.csv outputs/fragility fragility.svg

The study has stripes: runs at chosen intensities. Needs polars and matplotlib.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import polars as pl

LIMIT = 0.5  # θ/α of either body


def curves(path):
    """{configuration: [(intensity, probability, lower, upper)]}; None where the data set no bound."""
    found = defaultdict(list)
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["limit"] == str(LIMIT):
                numbers = (row[name] for name in ("intensity", "probability", "lower", "upper"))
                found[row["configuration"]].append(tuple(float(number) if number else None for number in numbers))
    return dict(found)


def shares(folder, limit=LIMIT):
    """{configuration: [(intensity, share of runs beyond the limit, runs)]}, a point a stripe; failed runs do not count.
    A limit of infinity is collapse."""
    rotation = pl.max_horizontal("theta1_max_over_alpha1", "theta2_max_over_alpha2")
    beyond = (pl.col("outcome") == "collapsed") | (rotation > limit)
    frame = (
        pl.scan_parquet(str(Path(folder) / "runs/*/*.parquet"))
        .with_columns(pl.col("configuration", "outcome").cast(pl.String))
        .filter(pl.col("outcome") != "failed")
        .group_by("configuration", "intensity")
        .agg(beyond.mean().alias("share"), pl.len().alias("runs"))
        .sort("configuration", "intensity")
        .collect()
    )
    found = defaultdict(list)
    for configuration, intensity, share, runs in frame.rows():
        found[configuration].append((intensity, share, runs))
    return dict(found)


def plot(curves, shares, path):
    """Draws both into an SVG, PDF or PNG; the figure."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 4), layout="constrained")
    for configuration, points in curves.items():
        intensity, probability, lower, upper = zip(*points)
        (line,) = axes.plot(intensity, probability, label=f"{configuration} floor")
        if None not in lower + upper:
            axes.fill_between(intensity, lower, upper, color=line.get_color(), alpha=0.2, linewidth=0)
        observed = shares[configuration]
        axes.scatter([i for i, *_ in observed], [share for _, share, _ in observed], color=line.get_color())
    axes.set(xscale="log", ylim=(0, 1), xlabel="PGV (m/s)", ylabel=f"P(θ/α > {LIMIT} or collapse)")
    axes.legend(title="fit, and share of each stripe's runs")
    figure.savefig(path)
    return figure


if __name__ == "__main__":
    curves_path, folder, picture = sys.argv[1:]
    plot(curves(curves_path), shares(folder), picture)

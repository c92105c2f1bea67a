"""The fragility plot shows the curves of `mrbd fragility` and what the Parquet files hold.

    python tests/python/check_fragility_plot.py CURVES.csv DIR FOLDER_FOR_THE_PICTURE

Without matplotlib only the reading is checked.
"""

import csv
import importlib.util
import math
import sys
from collections import Counter
from pathlib import Path

from check_examples import load


def expected_shares(path, example):
    """Counted row by row."""
    import polars as pl

    columns = ["configuration", "record", "outcome", example.INTENSITY, example.DEMAND]
    runs, beyond = Counter(), Counter()
    for file in sorted(Path(path).glob("runs/*/*.parquet")):
        for configuration, record, outcome, intensity, demand in pl.read_parquet(file, columns=columns).rows():
            if outcome != "failed":
                runs[configuration, intensity] += 1
                beyond[configuration, intensity] += outcome == "collapsed" or demand > example.LIMIT
    return {case: beyond[case] / count for case, count in runs.items()}, runs


def check_curves(path, curves):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert sorted(curves) == ["parallel", "perpendicular"], sorted(curves)
    assert sum(map(len, curves.values())) == len(rows) > 100, len(rows)
    for points in curves.values():
        probabilities = [probability for _, probability, *_ in points]
        assert probabilities == sorted(probabilities) and 0 < probabilities[0] < probabilities[-1] < 1


def check_picture(folder, example, curves, shares):
    path = Path(folder) / "fragility.svg"
    (axes,) = example.plot(curves, shares, path).axes
    drawn = [list(zip(*line.get_data())) for line in axes.lines]
    assert drawn == [[point[:2] for point in points] for points in curves.values()]
    dots = [tuple(map(float, dot)) for collection in axes.collections for dot in collection.get_offsets()]
    assert set((i, share) for points in shares.values() for i, share, _ in points) <= set(dots)
    assert path.read_text(encoding="utf-8").rstrip().endswith("</svg>")
    print(f"{path}: {len(drawn)} curves, {len(dots)} records' shares")


def main(curves_path, folder, pictures):
    example = load("examples/fragility_plot.py")
    curves, shares = example.curves(curves_path), example.shares(folder)
    check_curves(curves_path, curves)
    expected, runs = expected_shares(folder, example)
    found = {(configuration, i): (share, n) for configuration, points in shares.items() for i, share, n in points}
    assert found.keys() == expected.keys()
    for case, (share, count) in found.items():
        assert count == runs[case] and math.isclose(share, expected[case], rel_tol=1e-14), case
    assert 0 < sum(share for share in expected.values()), "some runs are beyond the limit"
    print(f"examples/fragility_plot.py: the shares of {len(found)} records and floors agree")
    if importlib.util.find_spec("matplotlib"):
        check_picture(pictures, example, curves, shares)


if __name__ == "__main__":
    main(*sys.argv[1:])

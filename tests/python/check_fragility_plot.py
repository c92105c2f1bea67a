"""The fragility plot shows the curves of `mrbd fragility` and the shares that `mrbd aggregate` tells.

    python tests/python/check_fragility_plot.py QUANTILES.csv CURVES.csv DIR FOLDER_FOR_THE_PICTURE

QUANTILES.csv is what `mrbd aggregate DIR --csv` prints of a study with stripes. Without matplotlib only the reading is
checked.
"""

import csv
import importlib.util
import math
import sys
from pathlib import Path

from check_examples import load


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def check_collapses(path, shares):
    """Shares of collapsed walls, and runs, by floor and stripe."""
    chosen = [row for row in rows(path) if row["quantity"] == "theta1_max_over_alpha1" and not row["record"]]
    expected = {
        (row["configuration"], float(row["intensity"])): (float(row["share_beyond"]), int(row["runs"]) - int(row["failed"]))
        for row in chosen
    }
    found = {(floor, i): (share, runs) for floor, points in shares.items() for i, share, runs in points}
    assert found.keys() == expected.keys(), sorted(found)
    for case, (share, runs) in expected.items():
        assert found[case][1] == runs and math.isclose(found[case][0], share, rel_tol=1e-14), case
    assert 0 < sum(share for share, _ in expected.values()) < len(expected), "some fall and some do not"


def check_curves(curves, shares):
    """Fitted to these shares: a curve rises through them and is 0.5 where they pass it, within a stripe."""
    assert sorted(curves) == ["parallel", "perpendicular"], sorted(curves)
    for floor, points in curves.items():
        probabilities = [probability for _, probability, *_ in points]
        assert probabilities == sorted(probabilities) and len(probabilities) > 50
        median = next(intensity for intensity, probability, *_ in points if probability >= 0.5)
        stripes = [intensity for intensity, *_ in shares[floor]]
        passed = next(k for k, (_, share, _) in enumerate(shares[floor]) if share >= 0.5)
        assert stripes[max(passed - 2, 0)] < median < stripes[min(passed + 1, len(stripes) - 1)], (floor, median)


def check_picture(folder, example, curves, shares):
    path = Path(folder) / "fragility.svg"
    (axes,) = example.plot(curves, shares, path).axes
    drawn = [list(zip(*line.get_data())) for line in axes.lines]
    assert drawn == [[point[:2] for point in points] for points in curves.values()]
    dots = [tuple(map(float, dot)) for collection in axes.collections for dot in collection.get_offsets()]
    assert set((i, share) for points in shares.values() for i, share, _ in points) <= set(dots)
    assert path.read_text(encoding="utf-8").rstrip().endswith("</svg>")
    print(f"{path}: {len(drawn)} curves over {sum(map(len, shares.values()))} stripes")


def main(quantiles, curves_path, folder, pictures):
    example = load("examples/fragility_plot.py")
    curves, shares = example.curves(curves_path), example.shares(folder)
    check_collapses(quantiles, example.shares(folder, math.inf))
    check_curves(curves, shares)
    print("examples/fragility_plot.py: shares and curves agree")
    if importlib.util.find_spec("matplotlib"):
        check_picture(pictures, example, curves, shares)


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Reads a fragility model in NRML with OpenQuake's own parser and holds its curves against those of `mrbd fragility`.

    python check_nrml.py MODEL.xml CURVES.csv
"""

import csv
import sys

import numpy as np
from openquake.hazardlib import nrml
from openquake.risklib import read_nrml  # noqa: F401  Registers the parser of fragility models.

# NRML has ten digits of mean and standard deviation, from which OpenQuake computes ln θ and β again.
TOLERANCE = 1e-7

# OpenQuake has PGV in cm/s.
UNIT_OF_MODEL = {"PGV": 0.01, "PGA": 1.0}


def curves(path):
    """Intensities and probabilities by floor and limit."""
    found = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            point = float(row["intensity"]), float(row["probability"])
            found.setdefault((row["configuration"], row["limit"]), []).append(point)
    return {key: np.array(points) for key, points in found.items()}


def limit_name(limit_state):
    return limit_state if limit_state == "collapse" else limit_state.removeprefix("theta_").replace("p", ".")


def main(model_path, curves_path):
    expected, checked, worst = curves(curves_path), 0, 0.0
    model = nrml.to_python(model_path)
    for (measure, name), functions in model.items():
        floor = name.removeprefix("configuration=")
        built = functions.build(model.limitStates, 20, 0)
        for limit_state, function in zip(model.limitStates, built):
            intensity, probability = expected[floor, limit_name(limit_state)].T
            intensity = intensity / UNIT_OF_MODEL[measure]
            # OpenQuake's curves are nothing below the intensity at which damage begins.
            inside = (intensity > functions.minIML) & (intensity < functions.maxIML)
            assert inside.sum() > 20, f"{name} {limit_state}: {inside.sum()} intensities"
            worst = max(worst, np.abs(function(intensity[inside]) - probability[inside]).max())
            checked += 1
    assert checked == len(expected), f"{checked} curves of {len(expected)}"
    assert worst < TOLERANCE, f"curves differ by {worst:.1e}"
    print(f"{checked} curves read by OpenQuake's parser, the same within {worst:.0e}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])

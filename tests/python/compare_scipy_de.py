"""Simulations scipy's differential_evolution needs for the misfit that `mrbd calibrate` reaches: `make bench-calibration`.

Usage: compare_scipy_de.py MRBD [SEED ...]

The experiments are six-test twins as `noisy_twins.py` makes them, under both impact laws, without noise and with 1 %.
For each seed mrbd calibrates with its joint searches; then scipy minimises the same mean WME, evaluated by
`mrbd calibrate --evaluate`, with its default settings (best1bin, population 15 times the variables, no polish), and stops
as soon as it reaches the misfit of mrbd's, or after three times as many vectors. A vector is six simulations.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from scipy.optimize import differential_evolution

from noisy_twins import write_twin

LIMIT = 3.0


class Reached(Exception):
    pass


def calibrate(mrbd, experiment, seed):
    with tempfile.TemporaryDirectory() as folder:
        out = folder + "/out"
        subprocess.run([mrbd, "calibrate", experiment, "--out", out, "--seed", str(seed)],
                       check=True, capture_output=True)
        with open(out + "/calibration.json") as file:
            return json.load(file)


def scipy_vectors(mrbd, experiment, seed, bounds, target, limit):
    """Vectors scipy evaluates until it reaches the target, and the lowest misfit it saw."""
    process = subprocess.Popen([mrbd, "calibrate", experiment, "--evaluate"], text=True,
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    seen = {"vectors": 0, "best": float("inf")}

    def mean_wme(x):
        process.stdin.write(",".join(repr(float(v)) for v in x) + "\n")
        process.stdin.flush()
        wme = [float(cell) for cell in process.stdout.readline().split(",")]
        cost = sum(wme) / len(wme)
        seen["vectors"] += 1
        seen["best"] = min(seen["best"], cost)
        if cost <= target or seen["vectors"] >= limit:
            raise Reached
        return cost

    try:
        differential_evolution(mean_wme, bounds, rng=seed, polish=False, maxiter=100000, tol=0)
    except Reached:
        pass
    process.stdin.close()
    process.wait()
    return seen


def compare(mrbd, experiment, title, seed):
    c = calibrate(mrbd, experiment, seed)
    bounds = [(p["lower_bound"], p["upper_bound"]) for p in c["parameters"]]
    tests = sum(t["purpose"] == "fit" for t in c["tests"])
    for method in ("joint", "refined"):
        m = next(m for m in c["methods"] if m["method"] == method)
        vectors = m["simulations"] // tests
        target = m["best"]["mean_wme"]
        scipy = scipy_vectors(mrbd, experiment, seed, bounds, target, LIMIT * vectors)
        needed = scipy["vectors"] if scipy["best"] <= target else f"> {scipy['vectors']} (at {scipy['best']:.3g})"
        print(f"{title:<22}{seed:>4}  {method:<9}{target:>10.3g}{vectors:>7}  {needed}", flush=True)


def main():
    mrbd, *seeds = sys.argv[1:]
    print(f"{'twin':<22}{'seed':>4}  {'search':<9}{'mean WME':>10}{'mrbd':>7}  scipy")
    for law in ("contact", "whole"):
        for noise in (0.0, 0.01):
            for seed in [int(s) for s in seeds] or [1, 2, 3]:
                with tempfile.TemporaryDirectory() as folder:
                    write_twin(mrbd, Path(folder), law, noise, seed)
                    compare(mrbd, folder + "/experiment.toml", f"{law}, noise {noise:g}", seed)


if __name__ == "__main__":
    main()

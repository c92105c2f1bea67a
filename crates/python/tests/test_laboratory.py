"""The laboratory: what the commands write, as objects."""

import json
import os
import pickle
import signal
import threading
import time

import pytest

import mrbd


@pytest.fixture(scope="module")
def experiment(command, tmp_path_factory):
    """The experiment of `mrbd init`, its searches shorter still."""
    folder = tmp_path_factory.mktemp("first")
    command("init", cwd=folder)
    file = folder / "experiment.toml"
    text = file.read_text()
    short = text.replace("most_generations = 20", "most_generations = 2").replace(
        "refine_vectors = 1000", "refine_vectors = 40"
    )
    assert short != text
    file.write_text(short)
    return file


@pytest.fixture(scope="module")
def diagnosis(experiment, tmp_path_factory):
    return mrbd.diagnose(experiment, out=tmp_path_factory.mktemp("diagnosed"), progress=False)


def without_times(results):
    return {key: value for key, value in results.items() if "seconds" not in key and "per_second" not in key}


def test_regress_a_calibration_is_that_of_the_command(command, experiment, tmp_path):
    found = mrbd.calibrate(experiment, seed=3, progress=False)
    command("calibrate", experiment, "--out", tmp_path / "out", "--seed", "3")
    written = json.loads((tmp_path / "out/calibration.json").read_text())
    assert without_times(found.json) == without_times(written)
    assert list(found.values.values()) == written["joint"]["values"]
    assert len(found.candidates()) > 0 and "<iframe" in found._repr_html_()
    assert found.wall == mrbd.Wall.read(tmp_path / "out/wall.calibrated.toml")
    assert pickle.loads(pickle.dumps(found)).values == found.values


def test_regress_a_diagnosis_is_that_of_the_command(command, experiment, diagnosis, tmp_path):
    command("diagnose", experiment, "--out", tmp_path / "out")
    written = json.loads((tmp_path / "out/diagnosis.json").read_text())
    assert without_times(diagnosis.json) == without_times(written)
    assert diagnosis.verdict == written["verdict"] and diagnosis.rivals()
    assert diagnosis.wall == mrbd.Wall.read(tmp_path / "out/wall.updated.toml")
    again = pickle.loads(pickle.dumps(diagnosis))
    assert again.verdict == diagnosis.verdict and again.html() == diagnosis.html()
    assert diagnosis.verdict in repr(diagnosis)


def test_regress_ctrl_c_leaves_a_diagnosis_within_a_second(experiment, tmp_path):
    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        mrbd.diagnose(experiment, out=tmp_path / "out", progress=False)
    # Half a second until the signal, and one to stop.
    assert time.monotonic() - begun < 1.5
    assert not (tmp_path / "out/diagnosis.json").exists()


def test_rejects_a_missing_experiment(tmp_path):
    with pytest.raises((mrbd.InputError, FileNotFoundError)):
        mrbd.diagnose(tmp_path / "none.toml", progress=False)

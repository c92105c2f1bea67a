"""Studies and fragilities: the files and figures of the command."""

import json
import os
import signal

import pytest

import mrbd

pa = pytest.importorskip("pyarrow")


@pytest.fixture(scope="module")
def pipeline(root, tmp_path_factory):
    """The repository's fragility study with fewer draws; its inputs are named from a folder of the repository."""
    text = (root / "pipelines/fragility.toml").read_text()
    lines = ["count = 12" if line.startswith("count") else line for line in text.splitlines()]
    text = "\n".join(lines).replace('"../inputs', f'"{root}/inputs')
    path = tmp_path_factory.mktemp("pipeline") / "fragility.toml"
    path.write_text(text)
    return path


@pytest.fixture(scope="module")
def study(pipeline, tmp_path_factory):
    return mrbd.study(pipeline, out=tmp_path_factory.mktemp("study") / "drawn", progress=False)


def test_regress_a_study_writes_the_files_of_the_command(command, pipeline, study, tmp_path):
    command("run", pipeline, "--out", tmp_path / "by_command")
    files = sorted(p.relative_to(study.folder) for p in study.folder.rglob("*.parquet"))
    assert files == sorted(p.relative_to(tmp_path / "by_command") for p in (tmp_path / "by_command").rglob("*.parquet"))
    for file in files:
        assert (study.folder / file).read_bytes() == (tmp_path / "by_command" / file).read_bytes(), file


def test_regress_runs_and_medians_are_tables(study):
    runs = study.runs()
    assert len(runs) > 0 and "theta_max_over_own_alpha" in runs.columns
    assert len(study.medians()) > 0
    assert "<iframe" in study._repr_html_() and repr(study).startswith("<mrbd.Study in ")


def test_regress_a_study_refuses_a_folder_with_another_and_resumes_its_own(pipeline, study):
    with pytest.raises(mrbd.InputError):
        mrbd.study(pipeline, out=study.folder, progress=False)
    again = mrbd.study(pipeline, out=study.folder, resume=True, progress=False)
    assert pa.table(again.runs()).equals(pa.table(study.runs()))


def test_regress_ctrl_c_stores_what_is_done(root, study, tmp_path):
    text = (root / "pipelines/check.toml").read_text().replace('"../inputs', f'"{root}/inputs')
    (tmp_path / "check.toml").write_text(text)
    calls = []

    def stop(done, parts):
        calls.append(done)
        if done and len(calls) < 10_000:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        mrbd.study(tmp_path / "check.toml", out=tmp_path / "out", progress=stop, threads=1)
    stored = len(mrbd.Study(tmp_path / "out").runs())
    assert 0 < stored < 6300
    whole = mrbd.study(tmp_path / "check.toml", out=tmp_path / "out", resume=True, progress=False)
    assert len(whole.runs()) == 6300


@pytest.mark.filterwarnings("ignore")
def test_regress_fragilities_are_those_of_the_command(command, study, tmp_path):
    options = ["--threshold", "0.1", "--threshold", "0.5", "--replicates", "100"]
    printed = command("fragility", study.folder, *options, "--json").stdout
    fitted = study.fragility(threshold=[0.1, 0.5], replicates=100)
    assert json.loads(printed) == fitted.json
    curves = fitted.curves()
    assert len(curves) >= 1 and all(len(curve["intensity"]) == 101 for curve in curves)
    plot = pytest.importorskip("matplotlib")
    plot.use("agg")
    assert len(fitted.plot().lines) == len(curves)


@pytest.mark.filterwarnings("ignore")
def test_regress_a_data_frame_gives_the_fragility_of_its_file(study, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    runs = pa.table(study.runs()).select(["pgv_m_s", "outcome", "record"])
    pq.write_table(runs, tmp_path / "runs.parquet")
    asked = {"intensity": "pgv_m_s", "outcome": "outcome", "cluster": "record", "replicates": 100}
    of_frame, of_file = mrbd.fragility(runs, **asked), mrbd.fragility(tmp_path / "runs.parquet", **asked)
    assert of_frame.json == of_file.json
    assert of_frame.probability([of_frame.median])[0] == pytest.approx(0.5, abs=1e-15)


def test_regress_what_the_command_notes_is_a_warning(study):
    with pytest.warns(UserWarning, match="independent"):
        mrbd.fragility(pa.table(study.runs()), intensity="pgv_m_s", outcome="outcome", replicates=0)


def test_rejects_fragilities_of_nothing(study):
    with pytest.raises(mrbd.InputError) as caught:
        mrbd.fragility(pa.table({"x": [1.0]}), outcome="x")
    assert caught.value.key == "intensity"
    with pytest.raises(mrbd.InputError) as caught:
        study.fragility(level=2.0)
    assert caught.value.key == "level"
    with pytest.raises(mrbd.InputError, match="method"):
        study.fragility(method="magic")

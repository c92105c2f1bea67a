"""One run: the bits of the command, arrays, pictures, pickles."""

import json
import pickle

import numpy as np
import pytest

import mrbd


def test_regress_the_summary_is_what_the_command_prints(command, wall_file, record_file, wall, record):
    for options, keywords in [
        ([], {"members": "auto"}),
        (["--alone"], {}),
        (
            ["--alone", "--scale", "1.3", "--tail", "2", "--tolerance", "1e-8"],
            {"scale": 1.3, "tail_s": 2, "tolerance": 1e-8},
        ),
        (
            ["--alone", "--vertical", record_file, "--vertical-scale", "0.4"],
            {"vertical": record, "vertical_scale": 0.4},
        ),
    ]:
        printed = command("simulate", wall_file, "--record", record_file, "--json", *options).stdout
        # JSON of both writes the shortest text of every number: equal texts are equal bits.
        assert json.loads(printed) == mrbd.simulate(wall, record, **keywords).summary


def test_regress_more_members_follow_where_a_run_is_chaotic(command, root, wall, wall_file):
    file = root / "inputs/records/emilia7/generated_4_600ya.csv"
    record = mrbd.Record.read(file)
    chaotic = mrbd.simulate(wall, record, scale=2.0, members="auto")
    printed = command("simulate", wall_file, "--record", file, "--scale", "2", "--json").stdout
    assert chaotic.summary == json.loads(printed)
    assert chaotic.summary["ensemble"]["members"] == 12
    assert mrbd.simulate(wall, record, scale=2.0, members=12).summary == chaotic.summary
    assert "differ by what nobody can know" in chaotic.remarks[0]


def test_regress_the_history_is_what_the_command_writes(command, wall_file, record_file, wall, record, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    pa = pytest.importorskip("pyarrow")
    file = tmp_path / "history.parquet"
    command("simulate", wall_file, "--record", record_file, "--alone", "--history", file)
    run = mrbd.simulate(wall, record)
    stored, table = pq.read_table(file), pa.table(run.table())
    assert stored.equals(table)
    for name in ["time_s", "theta1_rad", "theta2_rad"]:
        assert np.array_equal(stored[name].to_numpy(), getattr(run, name))
    assert stored["pattern"].to_pylist() == run.pattern.tolist()
    assert [mrbd.PATTERNS[i] for i in run.pattern_index] == run.pattern.tolist()


def test_analytic_a_free_release_swings_about_the_corner_it_was_released_on():
    wall = mrbd.Wall(
        thickness_m=0.3,
        height_m=4.0,
        length_m=1.0,
        density_kg_m3=1800.0,
        initial={"theta1_rad": 0.02, "theta2_rad": 0.02},
    )
    run = mrbd.simulate(wall, tail_s=1.0)
    assert run.theta1_rad[0] == 0.02 and run.pattern[0] == "3a"
    assert run.record is None and len(run.time_s) == 201


def test_regress_arrays_are_one_object_and_views_keep_their_record(wall, record):
    run = mrbd.simulate(wall, record)
    assert run.theta1_rad is run.theta1_rad
    samples = mrbd.Record([0.0, 1.0, 0.0], 0.01).acceleration_m_s2
    # The record is gone; its samples are not.
    assert samples.tolist() == [0.0, 1.0, 0.0] and not samples.flags.writeable and not samples.flags.owndata
    with pytest.raises(ValueError):
        samples[0] = 1.0


def test_regress_walls_records_and_runs_pickle(wall, record):
    run = mrbd.simulate(wall, record, scale=1.1)
    again = pickle.loads(pickle.dumps(run))
    assert again.summary == run.summary and np.array_equal(again.theta2_rad, run.theta2_rad)
    assert again.wall == wall and again.record == record
    table = pickle.loads(pickle.dumps(run.table()))
    assert table.columns == run.table().columns and np.array_equal(table["theta1_rad"], run.theta1_rad)
    error = pickle.loads(pickle.dumps(pytest.raises(mrbd.InputError, mrbd.simulate, wall, record, scale=np.nan).value))
    assert error.key == "scale"


def test_regress_a_run_shows_itself(wall, record, tmp_path):
    run = mrbd.simulate(wall, record)
    assert repr(run).startswith("<mrbd.Run ") and "impacts" in repr(run)
    assert "<iframe srcdoc=" in run._repr_html_() and "<svg" in run.html()
    run.write(tmp_path / "run.svg")
    assert (tmp_path / "run.svg").read_text().startswith("<svg")
    assert wall._repr_html_().startswith("<svg") and repr(wall).startswith("<mrbd.Wall ")
    assert repr(record).startswith("<mrbd.Record ")
    assert "10 s, peak" in record._repr_html_() and "<path" in record._repr_html_()
    table = run.table()
    assert table._repr_html_().count("<tr>") == 11 and f"{len(table):,} rows" in table._repr_html_()
    assert len(table.head(3)) == 3 and len(table.head(10**9)) == len(table)
    suite = mrbd.records.generate()
    assert suite._repr_html_().count("<svg") == len(suite) and "7 records" in repr(suite)


def test_regress_a_run_plots_into_given_axes(wall, record):
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    _, ax = pyplot.subplots()
    assert mrbd.simulate(wall, record).plot(ax) is ax
    assert len(ax.lines) == 2


@pytest.mark.parametrize(
    ("keywords", "key"),
    [
        ({"scale": np.inf}, "scale"),
        ({"tail_s": -1.0}, "tail_s"),
        ({"tolerance": 1.0}, "tolerance"),
        ({"members": 13}, "members"),
        ({"members": "all"}, "members"),
        ({"members": 0}, "members"),
        ({"step_s": 0.0}, "step_s"),
    ],
)
def test_rejects_arguments_with_their_names(wall, record, keywords, key):
    with pytest.raises(mrbd.InputError, match=key) as caught:
        mrbd.simulate(wall, record, **keywords)
    assert caught.value.key == key and caught.value.file == "mrbd.simulate()"
    assert "allowed" in str(caught.value) and caught.value.allowed


def test_rejects_a_wall_at_rest_without_a_record(wall):
    with pytest.raises(mrbd.InputError, match="at rest"):
        mrbd.simulate(wall)

"""Many runs: the bits of single runs and of `mrbd run`, whatever the threads."""

import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import mrbd

pa = pytest.importorskip("pyarrow")


def results(table):
    """The columns that depend on the run alone."""
    return pa.table(table).drop_columns(["wall", "record", "record_scale"])


def test_regress_many_runs_are_single_runs_whatever_the_threads(wall, suite):
    walls = [wall.replace(height_m=height_m) for height_m in (3.5, 3.984, 4.5)]
    tables = [mrbd.simulate_many(walls, suite, scales=[1.0, 2.5], threads=n, progress=False) for n in (1, 2, 3)]
    assert pa.table(tables[0]).equals(pa.table(tables[1])) and pa.table(tables[0]).equals(pa.table(tables[2]))
    table = tables[0]
    assert len(table) == 3 * 2 * len(suite)
    assert table["wall"].tolist()[:4] == [0, 1, 2, 0] and table["record_scale"].tolist()[:4] == [1.0] * 3 + [2.5]
    for row in (0, 4, len(table) - 1):
        index, scale = int(table["wall"][row]), table["record_scale"][row]
        record = next(r for r in suite if r.name == table["record"][row])
        summary = mrbd.simulate(walls[index], record, scale=scale).summary
        assert summary["theta1_max_rad"] == table["theta1_max_rad"][row]
        assert summary["theta2_max_over_alpha2"] == table["theta2_max_over_alpha2"][row]
        assert summary["impacts"] == pa.table(table)["impacts"][row].as_py()


def test_regress_a_study_run_again_from_its_own_table_has_its_bits(command, root, tmp_path):
    command("run", "pipelines/check.toml", "--out", tmp_path / "study", cwd=root)
    stored = mrbd.Study(tmp_path / "study").runs()
    runs = pa.table(stored)
    runs = runs.filter(pa.array([name == "base" for name in runs["variant"].to_pylist()]))
    first = runs["record"][0].as_py()
    runs = runs.filter(pa.array([name == first and i % 7 == 0 for i, name in enumerate(runs["record"].to_pylist())]))
    by_name = {record.name: record for record in mrbd.records.suite(root / "inputs/records/emilia7/suite.toml")}
    again = results(mrbd.simulate_many(runs, by_name[first], tail_s=runs["tail_s"][0].as_py(), progress=False))
    for name in again.column_names:
        assert again[name].to_pylist() == runs[name].to_pylist(), name


def test_regress_pairs_go_one_by_one(wall, suite):
    walls = [wall, wall.replace(height_m=4.5)]
    table = mrbd.simulate_many(walls, list(suite)[:2], scales=[1.0, 2.0], pairs="matched", progress=False)
    assert table["record"] == [record.name for record in list(suite)[:2]]
    alone = mrbd.simulate(walls[1], suite[1], scale=2.0).summary
    assert table["theta1_max_rad"][1] == alone["theta1_max_rad"]
    with pytest.raises(mrbd.InputError, match="matched"):
        mrbd.simulate_many(walls, list(suite)[:3], pairs="matched", progress=False)


def test_regress_rows_of_a_table_are_walls(suite):
    heights = np.linspace(3.0, 5.0, 5)
    table = pa.table(
        {"thickness_m": [0.3] * 5, "height_m": heights, "length_m": [1] * 5, "density_kg_m3": [1800.0] * 5}
    )
    walls = [mrbd.Wall(thickness_m=0.3, height_m=h, length_m=1, density_kg_m3=1800.0) for h in heights]
    of_rows = mrbd.simulate_many(table, suite[0], scales=3.0, progress=False)
    assert pa.table(of_rows).equals(pa.table(mrbd.simulate_many(walls, suite[0], scales=3.0, progress=False)))
    impossible = table.set_column(1, "height_m", pa.array([4.0, None, -1.0, 4.0, 4.0]))
    rows = mrbd.simulate_many(impossible, suite[0], progress=False)
    assert [o == "failed" for o in rows["outcome"]] == [False, True, True, False, False]
    assert "no height_m" in rows["reason"][1] and "height" in rows["reason"][2]


def test_rejects_tables_that_are_no_walls(wall, suite):
    for columns, match in [
        ({"thickness_m": [0.3]}, "height_m"),
        ({"thickness_m": [0.3], "height_m": [4.0], "length_m": [1.0], "crack_hieght_m": [2.0]}, "did you mean"),
        ({"thickness_m": ["thick"], "height_m": [4.0], "length_m": [1.0]}, "thickness_m"),
    ]:
        with pytest.raises(mrbd.InputError, match=match):
            mrbd.simulate_many(pa.table(columns), suite[0], progress=False)
    with pytest.raises(mrbd.InputError, match="threads"):
        mrbd.simulate_many(wall, suite[0], threads=0)
    with pytest.raises(mrbd.InputError, match="walls"):
        mrbd.simulate_many([], suite[0])


def test_regress_progress_counts_to_the_end(wall, suite):
    seen = []
    mrbd.simulate_many(wall, suite, progress=lambda done, parts: seen.append((done, parts)))
    assert seen[-1] == (len(suite), len(suite)) and all(a <= b for (a, _), (b, _) in zip(seen, seen[1:]))


def test_regress_ctrl_c_stops_within_a_second_and_hands_on_what_is_done(wall, suite):
    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    begun = time.monotonic()
    with pytest.raises(mrbd.Interrupted) as caught:
        mrbd.simulate_many([wall] * 20_000, suite, scales=[2.0, 3.0], progress=False)
    # Half a second until the signal, and one to stop.
    assert time.monotonic() - begun < 1.5
    done = caught.value.done
    assert 0 < len(done) < 20_000 * len(suite) * 2
    assert isinstance(caught.value, KeyboardInterrupt)


def test_regress_other_threads_of_python_run_meanwhile(wall, suite):
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.wait(0.01):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    mrbd.simulate_many([wall] * 300, suite, progress=False, threads=1)
    stop.set()
    thread.join()
    assert len(ticks) > 5


def test_regress_a_table_pickles_and_is_read_by_other_libraries(wall, suite):
    table = mrbd.simulate_many(wall, suite, progress=False)
    assert pa.table(pickle.loads(pickle.dumps(table))).equals(pa.table(table))
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(table)
    assert frame.height == len(suite) and frame["theta1_max_rad"].to_list() == table["theta1_max_rad"].tolist()
    assert table.to_pandas().shape == frame.shape


def test_regress_a_forked_process_runs_too(wall, suite):
    import multiprocessing

    mrbd.simulate_many(wall, suite, progress=False)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        tables = pool.starmap(mrbd.simulate_many, [(wall, [record]) for record in suite])
    assert [len(table) for table in tables] == [1] * len(suite)

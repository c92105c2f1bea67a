"""Questions of a single wall: to the bit what the commands print as JSON."""

import json
import os
import pickle
import signal
import threading
import time

import pytest

import mrbd

HAZARD = """pga_g,annual_rate,annual_rate_16,annual_rate_84
0.02,0.05,0.04,0.07
0.05,0.02,0.015,0.03
"""


@pytest.fixture(scope="module")
def site(root):
    return root / "inputs/site_mirandola.toml"


@pytest.fixture(scope="module")
def suite_file(root):
    return root / "inputs/records/emilia7/suite.toml"


@pytest.fixture(scope="module")
def measured(root):
    return root / "inputs/measured/griffith_2004"


@pytest.fixture(scope="module")
def coarse(wall_file, suite_file):
    """A margin in large steps, quick to search."""
    return mrbd.margin(wall_file, suite_file, growth=2.0, bracket=2.0, progress=False)


def printed(command, *words):
    # JSON of both writes the shortest text of every number: equal values are equal bits.
    return json.loads(command(*words, "--json").stdout)


def test_regress_a_description_is_that_of_the_command(command, wall, wall_file):
    assert wall.describe() == printed(command, "describe", wall_file)


def test_regress_a_push_is_that_of_the_command(command, wall, wall_file, measured, tmp_path):
    assert mrbd.push(wall_file).json == printed(command, "push", wall_file)
    options = ["--at", "crack", "--side", "left", "--held", "--bed", "2.7e8", "--measured", measured / "push.csv"]
    keywords = {"at": "crack", "side": "left", "held": True, "bed_pa_per_m": 2.7e8, "measured": measured / "push.csv"}
    griffith = measured / "wall.toml"
    pushed = mrbd.push(mrbd.Wall.read(griffith), **keywords, out=tmp_path / "push")
    assert pushed.json == printed(command, "push", griffith, *options)
    assert json.loads((tmp_path / "push/push.json").read_text()) == pushed.json
    assert pushed.html() == (tmp_path / "push/report.html").read_text() and "<iframe" in pushed._repr_html_()
    assert pushed.force_n.tolist() == [point["force_n"] for point in pushed.json["curve"]["points"]]
    assert "of its weight" in repr(pushed) and len(pushed.notes) == 3


def test_regress_an_assessment_is_that_of_the_command(command, wall, wall_file, site, suite_file, measured):
    plain = mrbd.assess(wall_file, site, progress=False)
    assert plain.json == printed(command, "assess", wall_file, "--site", site)
    assert plain.alpha_0 == plain.json["alpha_0"] and plain.zeta == plain.json["zeta"]
    other = measured / "wall.toml"
    whole = mrbd.assess(wall, site, records=suite_file, compare=other, language="it", threads=1, progress=False)
    words = ["--records", suite_file, "--compare", other, "--language", "it"]
    assert whole.json == printed(command, "assess", wall_file, "--site", site, *words)
    assert whole.json["dynamic"]["runs"] == 7 and 'lang="it"' in whole.html()
    assert "alpha_0" in repr(plain)


def test_regress_margin_and_risk_are_those_of_the_commands(command, coarse, wall_file, suite_file, tmp_path):
    words = ["--growth", "2", "--bracket", "2", "--out", tmp_path / "margin"]
    assert coarse.json == printed(command, "margin", wall_file, "--suite", suite_file, *words)
    assert len(coarse.scales) == 7 and all(scale > 0.25 for scale in coarse.scales.values())
    (tmp_path / "hazard.csv").write_text(HAZARD)
    with pytest.warns(UserWarning, match="of the rate lies"):
        risk = mrbd.risk(coarse, tmp_path / "hazard.csv")
    words = [tmp_path / "margin/margin.json", "--hazard", tmp_path / "hazard.csv"]
    assert risk.json == printed(command, "risk", *words)
    with pytest.warns(UserWarning):
        assert mrbd.risk(tmp_path / "margin/margin.json", tmp_path / "hazard.csv").json == risk.json
    assert risk.limit_states[0]["annual_rate"] > 0.0


def test_regress_answers_pickle(coarse):
    again = pickle.loads(pickle.dumps(coarse))
    assert again.json == coarse.json and again.html() == coarse.html() and repr(again) == repr(coarse)


def test_regress_a_push_plots_into_given_axes(wall):
    pytest.importorskip("matplotlib").use("agg")
    from matplotlib import pyplot

    _, ax = pyplot.subplots()
    assert mrbd.push(wall).plot(ax) is ax and len(ax.lines) == 2


def test_regress_ctrl_c_leaves_a_margin_within_a_second(wall, suite_file):
    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        # Hours, if it were not stopped.
        mrbd.margin(wall, suite_file, growth=1.0001, tolerance=1e-9, progress=False)
    # Half a second until the signal, and one to stop.
    assert time.monotonic() - begun < 1.5


@pytest.mark.parametrize(
    ("ask", "keywords", "key"),
    [
        (mrbd.push, {"bed_pa_per_m": 1.0}, "bed_pa_per_m"),
        (mrbd.push, {"at": "bottom"}, ""),
        (mrbd.margin, {"tail_s": -1.0}, "tail_s"),
        (mrbd.margin, {"growth": 1.0}, "growth"),
        (mrbd.margin, {"limit": 9.0}, "limit"),
        (mrbd.margin, {"threads": 10_000}, "threads"),
    ],
)
def test_rejects_options_by_their_keywords(wall, suite_file, ask, keywords, key):
    needed = [suite_file] if ask is mrbd.margin else []
    with pytest.raises(mrbd.InputError) as caught:
        ask(wall, *needed, **keywords)
    assert caught.value.key == key and caught.value.file == f"mrbd.{ask.__name__}()"


def test_rejects_results_in_the_way(wall, tmp_path):
    mrbd.push(wall, out=tmp_path / "push")
    with pytest.raises(mrbd.InputError, match="force"):
        mrbd.push(wall, out=tmp_path / "push")
    assert mrbd.push(wall, out=tmp_path / "push", force=True).json["wall"] == "table_wall.toml"

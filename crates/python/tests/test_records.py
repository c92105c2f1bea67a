"""Records: formats, measures, suites."""

import numpy as np
import pytest

import mrbd


def test_regress_a_record_is_written_and_read_to_the_bit(tmp_path):
    made = mrbd.Record(np.linspace(-1.0, 1.0, 101) ** 3, 0.01, name="cubic")
    made.write(tmp_path / "cubic.csv")
    again = mrbd.Record.read(tmp_path / "cubic.csv")
    assert again == made and again.name == "cubic" and len(again) == 101
    assert again.time_s[-1] == again.duration_s == 1.0


def test_analytic_measures_of_a_sine():
    t = 0.005 * np.arange(201)
    sine = mrbd.Record(2.0 * np.sin(2 * np.pi * t), 0.005)
    measures = sine.measures()
    # ∫a dt over half a period is aT/π; lines between 200 samples lose (2π/200)²/12 = 8e-5 of it.
    assert measures["pgv_m_s"] == pytest.approx(2.0 / np.pi, rel=1e-4)
    assert measures["pgv_m_s"] == np.abs(sine.velocity_m_s).max()
    assert sine.scaled(2.0).measures()["pga_m_s2"] == 2.0 * measures["pga_m_s2"]
    # A stiff oscillator has the peak of the ground itself, one with the period of the sine 2.7 times as much.
    assert sine.spectrum_m_s2([0.02, 1.0]) / 2.0 == pytest.approx([1.0, 2.7], abs=0.02)


def test_regress_a_generated_suite_is_that_of_the_command(command, root, tmp_path):
    command("records", "generate", "--name", "some", "--seed", "7", "--out", tmp_path / "some")
    stored = mrbd.records.suite(tmp_path / "some/suite.toml")
    made = mrbd.records.generate(seed=7)
    assert [record.name for record in made] and len(made) == len(stored)
    factors = [np.abs(s.acceleration_m_s2).max() / np.abs(m.acceleration_m_s2).max() for s, m in zip(stored, made)]
    # The suite scales its records; to the rounding of the factor and of the peak.
    for s, m, factor in zip(stored, made, factors):
        assert np.allclose(s.acceleration_m_s2, factor * m.acceleration_m_s2, rtol=1e-12, atol=1e-12)


def test_regress_a_suite_that_fits_a_site(root):
    found = mrbd.records.select(
        root / "inputs/records/emilia7/suite.toml", root / "inputs/site_mirandola.toml", count=3, most_of_event=3
    )
    assert len(found[0].names) == 3 and found[0].deviation_rms <= found[-1].deviation_rms


def test_rejects_records_with_what_is_allowed(tmp_path):
    for keywords, key in [
        ({"acceleration_m_s2": [0.0, np.nan], "step_s": 0.01}, "acceleration_m_s2"),
        ({"acceleration_m_s2": [0.0, 1.0], "step_s": -0.01}, "step_s"),
    ]:
        with pytest.raises(mrbd.InputError) as caught:
            mrbd.Record(**keywords)
        assert caught.value.key == key
    (tmp_path / "text.txt").write_text("no record\n")
    with pytest.raises(mrbd.InputError) as caught:
        mrbd.Record.read(tmp_path / "text.txt")
    assert caught.value.file == str(tmp_path / "text.txt")
    with pytest.raises(mrbd.InputError) as caught:
        mrbd.Record.read(tmp_path / "text.txt", unit="furlong")
    assert caught.value.key == "unit"

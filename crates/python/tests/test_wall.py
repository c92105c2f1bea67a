"""Walls: the keys of wall files, by keyword."""

import pytest

import mrbd

STRIP = {"thickness_m": 0.291, "height_m": 3.984, "crack_height_m": 2.191, "length_m": 1.5, "mass_kg": 3614.0}


def test_regress_keywords_make_the_wall_of_the_file(root):
    text = (root / "inputs/walls/table_wall.toml").read_text()
    wall = mrbd.Wall.parse(text)
    keys = {name: getattr(wall, name) for name in STRIP}
    made = mrbd.Wall(
        **keys,
        corners={"lower_width_m": wall.lower_width_m, "upper_width_m": wall.upper_width_m},
        diaphragm=mrbd.Diaphragm(
            mass_kg=wall.diaphragm_mass_kg,
            carriage_mass_kg=wall.carriage_mass_kg,
            stiffness_n_per_m=wall.stiffness_n_per_m,
            eccentricity_m=wall.eccentricity_m,
        ),
        restitution=wall.restitution,
        effects=wall.effects,
    )
    assert made == wall
    assert mrbd.Wall.parse(made.toml) == wall and made.toml != text


def test_regress_a_wall_is_changed_key_by_key():
    wall = mrbd.Wall(**STRIP, diaphragm={"mass_kg": 179.0, "stiffness_n_per_m": 37e3})
    stiffer = wall.replace(diaphragm={"stiffness_n_per_m": 50e3}, height_m=4)
    assert (stiffer.stiffness_n_per_m, stiffer.diaphragm_mass_kg, stiffer.height_m) == (50e3, 179.0, 4.0)
    assert wall.stiffness_n_per_m == 37e3 and wall != stiffer


def test_regress_every_effect_of_the_catalogue_goes_into_a_wall_and_back():
    wall = mrbd.Wall(**STRIP, diaphragm={"mass_kg": 179.0, "stiffness_n_per_m": 37e3})
    kinds = [entry["name"] for entry in mrbd.effects()]
    assert "viscous_damping" in kinds and len(kinds) >= 15
    damped = wall.replace(effects=[{"kind": "viscous_damping", "coefficient_n_s_per_m": 1500.0}])
    assert damped.effects == [{"kind": "viscous_damping", "coefficient_n_s_per_m": 1500.0}]


def test_regress_a_formula_goes_into_a_wall_and_back_and_runs_as_the_effect_of_the_catalogue(record_file):
    wall = mrbd.Wall(**STRIP, diaphragm={"mass_kg": 179.0, "stiffness_n_per_m": 37e3})
    named = wall.replace(effects=[{"kind": "viscous_damping", "coefficient_n_s_per_m": 1500.0}])
    parameters = {"c": {"value": 1500.0, "unit": "N*s/m"}}
    law = {"kind": "formula", "place": "top", "force_n": "-c*v", "parameters": parameters}
    written = wall.replace(effects=[law])
    assert written.effects == [law] and mrbd.Wall.parse(written.toml) == written
    record = mrbd.records.read(record_file)
    assert mrbd.simulate(written, record).theta1_rad.tolist() == mrbd.simulate(named, record).theta1_rad.tolist()
    with pytest.raises(mrbd.InputError, match=r"effects\[0\]: .*`-c\*x` in N\*s .*; allowed: N"):
        wall.replace(effects=[{**law, "force_n": "-c*x"}])


def test_analytic_a_description_tells_the_acceleration_that_opens_a_block():
    block = mrbd.Wall(thickness_m=0.3, height_m=3.0, length_m=1.0, density_kg_m3=1800.0)
    # tan α = b/h, to the rounding of a handful of products.
    assert block.describe()["opening"]["ground_g"] == pytest.approx(0.1, abs=1e-15)


def test_rejects_what_a_wall_file_may_not_hold(tmp_path):
    with pytest.raises(mrbd.InputError, match="did you mean `crack_height_m`") as caught:
        mrbd.Wall(**STRIP, crack_hieght_m=2.0)
    assert caught.value.file == "mrbd.Wall()" and caught.value.line is None
    with pytest.raises(mrbd.InputError) as caught:
        mrbd.Wall(**{**STRIP, "crack_height_m": 5.0})
    assert caught.value.key == "wall.crack_height_m"
    file = tmp_path / "wall.toml"
    file.write_text("[wall]\nthickness_m = 0,3\n")
    with pytest.raises(mrbd.InputError, match="decimal comma") as caught:
        mrbd.Wall.read(file)
    assert (caught.value.file, caught.value.line) == (str(file), 2)
    with pytest.raises(mrbd.InputError, match="No such file") as caught:
        mrbd.Wall.read(tmp_path / "none.toml")
    assert caught.value.file == str(tmp_path / "none.toml")
    with pytest.raises(TypeError, match="a number, a text"):
        mrbd.Wall(**{**STRIP, "height_m": object()})


def test_regress_a_number_that_few_walls_have_is_a_warning():
    with pytest.warns(mrbd.Question):
        mrbd.Wall(**{**STRIP, "crack_height_m": 5.0, "height_m": 12.0})

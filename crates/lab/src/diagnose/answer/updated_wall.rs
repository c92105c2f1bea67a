//! The wall file with what was found.

use toml::{Table, Value};

use super::Findings;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::hypothesis::{WALL_NUMBERS, WallNumber};
use crate::diagnose::trials::FittedHypothesis;
use mrbd_files::error::InputError;
use mrbd_kernel::model::{FurtherLaw, WallParameters};

impl Findings<'_> {
    /// The text of the wall file with what was found.
    ///
    /// # Errors
    /// Input errors of the wall file: values outside their bounds, or what TOML cannot hold.
    pub(super) fn updated_wall_toml(&self) -> Result<String, InputError> {
        updated_wall_toml(self.experiment, self.found.kept())
    }
}

/// The text of the wall file with the numbers and effects of a fitted hypothesis.
fn updated_wall_toml(experiment: &Experiment, after: &FittedHypothesis) -> Result<String, InputError> {
    let path = &experiment.wall_path;
    let mut table = experiment.wall_table.clone();
    let (h, values) = (&after.hypothesis, &after.fit.values);
    let impossible =
        || InputError::file(path, format!("effects with {values:?}"), "values within their bounds");
    let found = h.parameters_of_wall(values).ok_or_else(impossible)?;
    let given = experiment.wall.parameters();
    set_numbers(&mut table, &found, given);
    if found.restitution.coefficients != given.restitution.coefficients {
        let list = found.restitution.coefficients.iter().map(|c| Value::Float(*c)).collect();
        set(&mut table, "restitution.coefficients", Value::Array(list));
    }
    let effects = h.effects(values).ok_or_else(impossible)?.into_iter().map(FurtherLaw::Effect);
    let formulas = h.formulas(values).ok_or_else(impossible)?.into_iter().map(FurtherLaw::Formula);
    let added = effects.chain(formulas).collect::<Vec<_>>();
    if !added.is_empty() {
        let unwritable =
            |e: toml::ser::Error| InputError::file(path, e.to_string(), "effects that can be written");
        let effects = table.entry("effects").or_insert_with(|| Value::Array(Vec::new()));
        for effect in added {
            let value = Value::try_from(effect).map_err(unwritable)?;
            if let Value::Array(list) = effects {
                list.push(value);
            }
        }
    }
    let text = toml::to_string_pretty(&table);
    text.map_err(|e| InputError::file(path, e.to_string(), "a table that can be written"))
}

/// Sets the numbers in which a fitted wall differs from the one that the file gives.
fn set_numbers(table: &mut Table, found: &WallParameters, given: &WallParameters) {
    let moved = |number: &&WallNumber| (number.get)(found) != (number.get)(given);
    // What the file gives by a density or a strength would follow the other numbers, and be another wall than the fitted one.
    let derived = if WALL_NUMBERS.iter().any(|n| moved(&n)) { derived(table) } else { Vec::new() };
    for number in WALL_NUMBERS.iter().filter(|n| moved(n) || derived.contains(&n.key)) {
        set(table, number.key, Value::Float((number.get)(found)));
    }
}

/// Numbers that the wall file does not give themselves.
fn derived(table: &Table) -> Vec<&'static str> {
    let gives = |name: &str, key: &str| table.get(name).and_then(|keys| keys.get(key)).is_some();
    let mass = gives("wall", "density_kg_m3").then_some("wall.mass_kg");
    let widths = ["corners.lower_width_m", "corners.upper_width_m"];
    let widths = if gives("corners", "lower_width_m") { &[] } else { &widths[..] };
    let floor = ["diaphragm.mass_kg", "diaphragm.stiffness_n_per_m"];
    let floor = if table.contains_key("diaphragm") { &[] } else { &floor[..] };
    mass.into_iter().chain(widths.iter().chain(floor).copied()).collect()
}

/// Sets a dotted key, and takes out what the new value stands in place of.
fn set(table: &mut Table, key: &str, value: Value) {
    let Some((name, last)) = key.split_once('.') else { return };
    let entry = table.entry(name).or_insert_with(|| Value::Table(Table::new()));
    let Value::Table(keys) = entry else { return };
    keys.insert(last.to_owned(), value);
    match key {
        "wall.mass_kg" => drop(keys.remove("density_kg_m3")),
        "corners.lower_width_m" | "corners.upper_width_m" => drop(keys.remove("compressive_strength_pa")),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use mrbd_files::parse_wall;

    const BY_DENSITY_AND_STRENGTH: &str = "[wall]\nthickness_m = 0.29\nheight_m = 4.0\ncrack_height_m = 2.2\n\
        length_m = 1.5\ndensity_kg_m3 = 1800.0\n[corners]\ncompressive_strength_pa = 3.5e6\n\
        [diaphragm]\nmass_kg = 900.0\ncarriage_mass_kg = 0.0\nstiffness_n_per_m = 37e3\n";

    #[test]
    fn analytic_a_wall_of_the_fewest_keys_is_written_as_it_was_fitted() {
        let path = Path::new("wall.toml");
        let fewest = BY_DENSITY_AND_STRENGTH.split("[corners]").next().expect("a beginning");
        let given = parse_wall(path, fewest).expect("a wall").parameters().clone();
        // The widths were those of the thickness given, and one width or a part of a floor makes no wall.
        for found in [
            WallParameters { thickness_m: 0.31, ..given.clone() },
            WallParameters { lower_width_m: 0.25, ..given.clone() },
            WallParameters { stiffness_n_per_m: 1e4, ..given.clone() },
            WallParameters { eccentricity_m: 0.02, ..given.clone() },
        ] {
            let mut table: Table = toml::from_str(fewest).expect("TOML");
            set_numbers(&mut table, &found, &given);
            let text = toml::to_string_pretty(&table).expect("TOML");
            let written = parse_wall(path, &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(*written.parameters(), found, "{text}");
        }
    }

    #[test]
    fn analytic_a_wall_given_by_density_and_strength_is_written_as_it_was_fitted() {
        let path = Path::new("wall.toml");
        let given = parse_wall(path, BY_DENSITY_AND_STRENGTH).expect("a wall").parameters().clone();
        let mut table: Table = toml::from_str(BY_DENSITY_AND_STRENGTH).expect("TOML");
        set_numbers(&mut table, &given, &given);
        assert_eq!(toml::from_str::<Table>(BY_DENSITY_AND_STRENGTH).expect("TOML"), table, "nothing moved");
        // From either, other widths and another mass would follow; from one width alone no wall.
        for found in [
            WallParameters { diaphragm_mass_kg: 300.0, ..given.clone() },
            WallParameters { height_m: 4.1, ..given.clone() },
            WallParameters { lower_width_m: 0.25, ..given.clone() },
        ] {
            let mut table: Table = toml::from_str(BY_DENSITY_AND_STRENGTH).expect("TOML");
            set_numbers(&mut table, &found, &given);
            let text = toml::to_string_pretty(&table).expect("TOML");
            let written = parse_wall(path, &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(*written.parameters(), found, "{text}");
        }
    }
}

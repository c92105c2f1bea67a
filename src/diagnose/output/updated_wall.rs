//! The wall file with what was found.

use toml::{Table, Value};

use crate::diagnose::experiment::Experiment;
use crate::diagnose::hypothesis::WALL_NUMBERS;
use crate::diagnose::trials::Tried;
use crate::error::{InputError, Result};
use crate::input::toml_file;

/// The text of the wall file with the numbers and effects of a fitted hypothesis.
///
/// # Errors
/// Input errors of the wall file; a number that has no place in it.
pub fn updated_wall(experiment: &Experiment, after: &Tried) -> Result<String> {
    let path = &experiment.wall_path;
    let mut table: Table = toml_file::load(path)?;
    let (h, values) = (&after.hypothesis, &after.fit.values);
    let impossible =
        || InputError::file(path, format!("effects with {values:?}"), "values within their bounds");
    let found = h.parameters_of_wall(values).ok_or_else(impossible)?;
    let given = experiment.wall.parameters();
    for number in &WALL_NUMBERS {
        let value = (number.get)(&found);
        if value != (number.get)(given) {
            set(&mut table, number.key, Value::Float(value));
        }
    }
    if found.restitution.coefficients != given.restitution.coefficients {
        let list = found.restitution.coefficients.iter().map(|c| Value::Float(*c)).collect();
        set(&mut table, "restitution.coefficients", Value::Array(list));
    }
    let added = h.effects(values).ok_or_else(impossible)?;
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
    Ok(text.map_err(|e| InputError::file(path, e.to_string(), "a table that can be written"))?)
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

//! What a hidden law shows at all: the same case with the law in the wall file that is given.
//!
//! A law that was not told may leave no trace in its tests. How much the true law gains over the wall with its own numbers fitted, these
//! fitted beside it too, says so; what speaks against that wall alone does not, for it is anything from −660 to 7530 natural logarithms over
//! 131 walls with nothing hidden.

use std::path::{Path, PathBuf};

use mrbd_lab::diagnose::answer::Summary;
use toml::{Table, Value};

use super::super::cases::draw::Case;
use super::super::cases::hidden::Hidden;
use super::super::diagnose::{Program, copy_experiment};
use super::super::score::reading::{Diagnosed, json};
use super::row::LawRow;

/// Diagnoses a case with its hidden laws in the wall file, where another answer was given and they have a formula.
///
/// # Errors
/// Text for people: a file that cannot be read or written, a program that cannot be started.
pub fn with_the_law(case: &Case, folder: &Path, program: &Program) -> Result<(), String> {
    let laws = case.hidden.iter().filter_map(|hidden| match hidden {
        Hidden::Law(atom) => Some(Value::Table(atom.effect())),
        _ => None,
    });
    let laws = laws.collect::<Vec<_>>();
    // Beside a diagnosis that failed there is nothing to gain over.
    let is_missed = |row: LawRow| row.against_recalibrated.is_some() && !row.right();
    let is_missed = LawRow::load(folder)?.is_some_and(is_missed);
    if laws.is_empty() || !is_missed {
        return Ok(());
    }
    let own = folder_of(folder);
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", own.display());
    std::fs::create_dir_all(&own).map_err(|e| told(&e))?;
    copy_experiment(folder, &own).map_err(|e| told(&e))?;
    let wall = own.join("wall.toml");
    let mut table =
        std::fs::read_to_string(&wall).map_err(|e| told(&e))?.parse::<Table>().map_err(|e| told(&e))?;
    let effects = table.entry("effects").or_insert_with(|| Value::Array(Vec::new()));
    effects.as_array_mut().ok_or_else(|| told(&"effects that are no array"))?.extend(laws);
    std::fs::write(&wall, table.to_string()).map_err(|e| told(&e))?;
    program.diagnose(&own)
}

/// What the true law gains over the wall without it, each with the wall's own numbers fitted, in natural logarithms of likelihood; `None`
/// where that was not asked, or the two are judged by other windows.
///
/// # Errors
/// Text for people if a file cannot be read.
pub fn gain(case: &Diagnosed, folder: &Path) -> Result<Option<f64>, String> {
    let own = folder_of(folder).join("diagnosis").join("diagnosis.json");
    let Some(without) = case.diagnosis.as_ref().filter(|_| own.is_file()) else { return Ok(None) };
    let with: Summary = json(&own)?;
    let same = with.windows == without.windows;
    Ok(same.then_some(without.against.recalibrated - with.against.recalibrated))
}

fn folder_of(case: &Path) -> PathBuf {
    case.join("with_the_law")
}

//! The output folder of a diagnosis.
//!
//! ```text
//! manifest.json        `kind`: `diagnosis`; program, files that were read; written first
//! *.parquet            what the figures show, see [`crate::results::diagnosis::tables`]
//! wall.updated.toml    the wall with the effect added, for every other command
//! diagnosis.json       the verdict, with everything it rests on; written last: where it is, all is there
//! ```

mod folder;
mod manifest;
mod rivals;
mod summary;
mod tests;
mod updated_wall;

pub use folder::OutputNames;

use serde_json::{Value, json};

use crate::error::{Error, InputError, Result};
use crate::results::diagnosis::tables::Tables;
use crate::store::write_durably;
use manifest::write_manifest;
use mrbd_lab::diagnose::certainty::next_tests;
use mrbd_lab::diagnose::experiment::Experiment;
use mrbd_lab::diagnose::flow::Diagnosis;
use summary::summary;
use updated_wall::updated_wall;

/// Kind of the folder in its manifest and its report.
pub const KIND: &str = "diagnosis";

/// Writes what a diagnosis found; the files are whole or absent.
///
/// # Errors
/// [`Error::Io`] if the disk refuses; input errors of a wall file that changed meanwhile.
pub fn write_results(names: &OutputNames, experiment: &Experiment, diagnosis: &Diagnosis) -> Result<Value> {
    let mut summary = summary(experiment, diagnosis);
    let no_wall = || InputError::file(&experiment.wall_path, "a diagnosis that is no wall", "a wall");
    let tables = Tables::new(experiment, diagnosis).ok_or_else(no_wall)?;
    summary["missing_force"] = tables.summary();
    summary["next_tests"] = json!(next_tests(experiment, diagnosis));
    let wall = updated_wall(experiment, diagnosis.found.kept())?;
    names.clear()?;
    write_manifest(&names.manifest, experiment, names.started_unix_s)?;
    tables.write(&names.folder)?;
    write_durably(&names.wall, wall.as_bytes())?;
    let text = serde_json::to_string_pretty(&summary).map_err(|e| Error::table(&names.diagnosis, e))?;
    write_durably(&names.diagnosis, text.as_bytes())?;
    Ok(summary)
}

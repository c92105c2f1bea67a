//! The output folder of a diagnosis: written from what [`mrbd_lab::diagnose::diagnose`] returns, with nothing computed.
//!
//! ```text
//! manifest.json        `kind`: `diagnosis`; program, files that were read; written first
//! *.parquet            what the figures show, see [`tables`]
//! wall.updated.toml    the wall with the effect added, for every other command
//! diagnosis.json       the verdict, with everything it rests on; written last: where it is, all is there
//! ```

mod folder;
mod manifest;
pub mod tables;

pub use folder::OutputNames;
pub use mrbd_lab::diagnose::answer::KIND;

use std::path::Path;

use crate::error::{Error, Result};
use crate::store::write_durably;
use manifest::write_manifest;
use mrbd_files::FileNote;
use mrbd_lab::diagnose::Diagnosis;
use mrbd_lab::diagnose::answer::Summary;

/// Writes a diagnosis and the files it was made from; every file is whole or absent.
///
/// # Errors
/// [`Error::Table`] or [`Error::Io`] if the disk refuses.
pub fn write_results(names: &OutputNames, inputs: &[FileNote], diagnosis: &Diagnosis) -> Result<()> {
    names.clear()?;
    write_manifest(&names.manifest, inputs, names.started_unix_s)?;
    tables::write_tables(&names.folder, &diagnosis.tables)?;
    write_durably(&names.wall, diagnosis.updated_wall_toml.as_bytes())?;
    write_durably(&names.diagnosis, json(&names.diagnosis, &diagnosis.summary)?.as_bytes())
}

/// The text of `diagnosis.json`, keys in the order of the alphabet.
fn json(path: &Path, summary: &Summary) -> Result<String> {
    let value = serde_json::to_value(summary).map_err(|e| Error::table(path, e))?;
    serde_json::to_string_pretty(&value).map_err(|e| Error::table(path, e))
}

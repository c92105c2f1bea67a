//! Files of results, and the inputs that were read for them, found again.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::{InputError, Result};
use mrbd_files::{FileNote, file_sha256};

/// The manifest of results that are not a study of runs: a calibration, a diagnosis, a comparison of models.
#[derive(Debug, Deserialize)]
pub struct Note {
    /// Name of what was done; empty where it has none.
    #[serde(default)]
    pub name: String,
    /// Version of the program.
    pub tool_version: String,
    /// Suite of records, where there is one.
    pub suite: Option<String>,
    /// Whether its records are generated rather than recorded.
    #[serde(default)]
    pub generated: bool,
    /// Files that were read.
    pub inputs: Vec<FileNote>,
    /// When it began, seconds since 1970.
    pub started_unix_s: u64,
}

impl Note {
    /// Reads a manifest.
    ///
    /// # Errors
    /// As [`read_json`].
    pub fn read(path: &Path) -> Result<Self> {
        read_json(path, "a manifest as mrbd writes it beside its results")
    }
}

/// Reads JSON that mrbd wrote.
///
/// # Errors
/// An input error for a file that is not there or holds something else.
pub fn read_json<T: DeserializeOwned>(path: &Path, allowed: &str) -> Result<T> {
    let refuse = |found: String| InputError::file(path, found, allowed);
    let bytes = std::fs::read(path).map_err(|e| refuse(e.to_string()))?;
    Ok(serde_json::from_slice(&bytes).map_err(|e| refuse(e.to_string()))?)
}

/// A file that was read, found again: where it was, or from the folder of the results.
///
/// `None` where it is gone or another one now.
pub fn found_again(folder: &Path, inputs: &[FileNote], role: &str) -> Option<PathBuf> {
    let note = inputs.iter().find(|input| input.role == role)?;
    let beside = note.path_from_folder.as_ref().map(|path| folder.join(path));
    let places = std::iter::once(PathBuf::from(&note.path)).chain(beside);
    places.into_iter().find(|path| file_sha256(path).is_ok_and(|sha256| sha256 == note.sha256))
}

/// The first row of something, or an input error for a study without any.
pub fn first<'a, T>(folder: &Path, all: &'a [T]) -> Result<&'a T> {
    let missing = || InputError::file(folder, "run files without a run", "the results of a study");
    Ok(all.first().ok_or_else(missing)?)
}

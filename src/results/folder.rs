//! The folders of results, and `manifest.json` in them: what kind of results they are and where they come from.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use crate::error::{Error, InputError, Result};
use crate::store::write_durably;
use mrbd_files::FileNote;

/// Name of the file.
pub(super) const MANIFEST: &str = "manifest.json";
/// Version of the files' keys and columns.
const SCHEMA_VERSION: u32 = 1;

/// What `manifest.json` says.
#[derive(Debug, Serialize)]
pub(super) struct Manifest {
    kind: &'static str,
    tool_version: &'static str,
    schema_version: u32,
    /// SHA-256 of everything that decides the results, where they can be gone on with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub request_sha256: Option<String>,
    /// Seed of the searches, where there are random numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Files that were read, seen from the folder.
    inputs: Vec<FileNote>,
    started_unix_s: u64,
}

impl Manifest {
    /// Of results of a kind, made from these files, begun at a time, seconds since 1970.
    pub fn new(kind: &'static str, inputs: Vec<FileNote>, started_unix_s: u64) -> Self {
        Self {
            kind,
            tool_version: env!("CARGO_PKG_VERSION"),
            schema_version: SCHEMA_VERSION,
            request_sha256: None,
            seed: None,
            inputs,
            started_unix_s,
        }
    }

    /// Writes it into a folder.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn write(mut self, folder: &Path) -> Result<()> {
        self.inputs = self.inputs.into_iter().map(|note| note.seen_from(folder)).collect();
        let text = format!("{:#}\n", serde_json::json!(self));
        write_durably(&folder.join(MANIFEST), text.as_bytes())
    }
}

/// Whether a folder has a manifest that says it holds results of a kind.
pub(super) fn holds(folder: &Path, kind: &str) -> bool {
    let text = std::fs::read(folder.join(MANIFEST)).unwrap_or_default();
    serde_json::from_slice::<Value>(&text).is_ok_and(|value| value["kind"] == kind)
}

/// Makes a folder if there is none, and gives the paths of what is in it.
///
/// # Errors
/// An input error for a folder that cannot be made; [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder)
        .map_err(|e| refuse(format!("{}: {e}", folder.display()), "a folder that can be written"))?;
    let entries = std::fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?;
    Ok(entries.filter_map(std::result::Result::ok).map(|entry| entry.path()).collect())
}

/// Refuses the folder of `--out`.
pub(super) fn refuse(found: String, allowed: &str) -> InputError {
    InputError::option("--out", found, allowed)
}

/// Removes files of earlier results in this order, and those that are not there no more.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn remove_all<'p>(mut paths: impl Iterator<Item = &'p PathBuf>) -> Result<()> {
    paths.try_for_each(|path| match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::io("remove earlier results", path, e))
        }
        _ => Ok(()),
    })
}

//! `manifest.json` of a diagnosis: what kind of results its folder holds and where they come from.

use std::path::Path;

use serde::Serialize;

use super::KIND;
use crate::error::Result;
use crate::store::write_durably;
use mrbd_files::FileNote;

/// Version of the files' keys and columns.
const SCHEMA_VERSION: u32 = 1;

#[derive(Serialize)]
struct Manifest {
    kind: &'static str,
    tool_version: &'static str,
    schema_version: u32,
    inputs: Vec<FileNote>,
    started_unix_s: u64,
}

/// Writes the manifest of a diagnosis that began at a time, seconds since 1970.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write_manifest(path: &Path, inputs: &[FileNote], started_unix_s: u64) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let manifest = Manifest {
        kind: KIND,
        tool_version: env!("CARGO_PKG_VERSION"),
        schema_version: SCHEMA_VERSION,
        inputs: inputs.iter().map(|note| note.clone().seen_from(folder)).collect(),
        started_unix_s,
    };
    let text = format!("{:#}\n", serde_json::json!(manifest));
    write_durably(path, text.as_bytes())
}

//! `manifest.json`: what kind of results a folder holds and where they come from, written before the first simulation.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::error::Result;
use crate::store::write_durably;
use mrbd_files::FileNote;
use mrbd_lab::calibrate::Experiment;

/// Kind of results, by which a report tells the folder of a calibration from that of a study.
pub const KIND: &str = "calibration";

/// Version of the files' keys and columns.
const SCHEMA_VERSION: u32 = 1;

#[derive(Serialize)]
struct Manifest {
    kind: &'static str,
    tool_version: &'static str,
    schema_version: u32,
    request_sha256: String,
    seed: u64,
    inputs: Vec<FileNote>,
    started_unix_s: u64,
}

/// Writes the manifest of a calibration.
///
/// # Errors
/// An input error for a file that cannot be read; [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write_manifest(path: &Path, experiment: &Experiment) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let note = |(role, file): &(String, PathBuf)| Ok(FileNote::of(role, file)?.seen_from(folder));
    let manifest = Manifest {
        kind: KIND,
        tool_version: env!("CARGO_PKG_VERSION"),
        schema_version: SCHEMA_VERSION,
        request_sha256: experiment.request.clone(),
        seed: experiment.settings.seed,
        inputs: experiment.files.iter().map(note).collect::<Result<_>>()?,
        started_unix_s: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
    };
    let text = format!("{:#}\n", serde_json::json!(manifest));
    write_durably(path, text.as_bytes())
}

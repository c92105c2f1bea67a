//! Where a page comes from: the manifest, what is generated or assumed, and the files behind it.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::page::{Link, address};
use crate::aggregate::VariantNote;
use crate::error::{InputError, Result};
use crate::study::runs::{Manifest, listed_run_files};
use crate::text::utc;
use mrbd_files::{FileNote, file_sha256};

/// The manifest as names and values.
pub fn of(manifest: &Manifest) -> Vec<(String, String)> {
    let pair = |name: &str, value: String| (name.to_owned(), value);
    let mut pairs = vec![
        pair(
            "program",
            format!("mrbd {}, result columns version {}", manifest.tool_version, manifest.schema_version),
        ),
        pair("plan", format!("{}, {} runs, SHA-256 {}", manifest.plan, manifest.runs, manifest.plan_sha256)),
        pair("seed", manifest.seed.map_or("none: nothing is drawn".to_owned(), |seed| seed.to_string())),
        pair("begun", format!("{} (UTC)", utc(manifest.started_unix_s))),
        pair("gravity", format!("{} m/s²", manifest.gravity_m_s2)),
    ];
    pairs.extend(inputs(&manifest.inputs));
    pairs.extend(manifest.suite.records.iter().map(|record| {
        let event = if record.event.is_empty() { String::new() } else { format!(", {}", record.event) };
        let text = format!("{}{event}, scaled by {}, SHA-256 {}", record.name, record.scale, record.sha256);
        ("record".to_owned(), text)
    }));
    pairs
}

/// The files that were read, by role.
pub fn inputs(files: &[FileNote]) -> impl Iterator<Item = (String, String)> {
    files.iter().map(|file| {
        // The folder a file lay in says nothing to who reads the page.
        let name =
            Path::new(&file.path).file_name().map_or(file.path.clone(), |n| n.to_string_lossy().into_owned());
        (file.role.clone(), format!("{name}, SHA-256 {}", file.sha256))
    })
}

/// A file that was read, found again: where it was, or from the folder of the results; none where it is gone or another
/// one now.
pub fn found_again(folder: &Path, inputs: &[FileNote], role: &str) -> Option<PathBuf> {
    let note = inputs.iter().find(|input| input.role == role)?;
    let beside = note.path_from_folder.as_ref().map(|path| folder.join(path));
    let places = std::iter::once(PathBuf::from(&note.path)).chain(beside);
    places.into_iter().find(|path| file_sha256(path).is_ok_and(|sha256| sha256 == note.sha256))
}

/// The manifest of results that are not a study of runs: a calibration, a comparison of models.
#[derive(Debug, Deserialize)]
pub struct Note {
    /// Name of what was done; empty where it has none.
    #[serde(default)]
    pub name: String,
    /// Version of the program.
    pub tool_version: String,
    /// Suite of records, where there is one, and whether it is generated.
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

    /// The manifest as names and values.
    pub fn pairs(&self) -> Vec<(String, String)> {
        let pair = |name: &str, value: String| (name.to_owned(), value);
        let mut pairs = vec![
            pair("program", format!("mrbd {}", self.tool_version)),
            pair("begun", format!("{} (UTC)", utc(self.started_unix_s))),
        ];
        pairs.extend(self.suite.iter().map(|suite| pair("suite", suite.clone())));
        pairs.extend(inputs(&self.inputs));
        pairs
    }

    /// A sentence on generated records; none where they are recorded.
    pub fn generated_note(&self) -> Option<String> {
        let suite = self.suite.as_deref().filter(|_| self.generated)?;
        Some(format!("The records of suite “{suite}” are generated, not measured."))
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

/// What a reader must know before the figures: generated records, assumptions, failed runs.
pub fn notes(manifest: &Manifest, variants: &[VariantNote]) -> Vec<String> {
    let suite = &manifest.suite;
    let mut notes = vec![if suite.generated {
        format!(
            "The records of suite “{}” are generated, not measured: the figures say what the model does under such motions, not what the paper’s records did.",
            suite.name
        )
    } else {
        format!(
            "The records of suite “{}” are measured; the paper’s own are another selection for the same spectrum.",
            suite.name
        )
    }];
    if let Some(base) = variants.first() {
        notes.push(format!(
            "Assumed where the paper is silent (variant “{}”): strip of {} m, density {} kg/m³, impact law “{}”, capture velocity {:e} rad/s.",
            base.name, base.length_m, base.density_kg_m3, base.law, base.capture_velocity_rad_s
        ));
    }
    let failed: u64 = variants.iter().map(|variant| variant.failed).sum();
    if failed > 0 {
        notes.push(format!("{failed} runs failed and take no part in the medians."));
    }
    notes
}

/// Links to the run files, one a record and part.
///
/// # Errors
/// As [`listed_run_files`].
pub fn run_links(folder: &Path) -> Result<Vec<Link>> {
    let link = |path: &std::path::PathBuf| {
        let relative = path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/");
        let text = relative.strip_prefix("runs/record=").unwrap_or(&relative).to_owned();
        Link { text, href: address(&relative) }
    };
    // The figures beside them were made of the same files, checked.
    Ok(listed_run_files(folder)?.iter().map(link).collect())
}

/// All files behind a page.
pub fn files(runs: Vec<Link>) -> Vec<Link> {
    let named = |name: &str| Link { text: name.to_owned(), href: name.to_owned() };
    let mut files = vec![named("manifest.json"), named("plan.toml"), named("medians.parquet")];
    files.extend(runs);
    files
}

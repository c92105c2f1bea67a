//! Which kind of results a folder holds, and the page made from them.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::page::Page;
use super::provenance::read_json;
use super::{calibration, comparison, diagnosis, drawn, history, overturning, sweep};
use crate::error::{Error, InputError, Result};
use crate::results;
use crate::store::PAGE_NAME;
use crate::store::write_durably;
use crate::study::runs::Manifest;
use mrbd_records::Site;

/// Makes the page of the results in a folder, or of a history file; gives where it is. Records are held against the code
/// of a site.
///
/// # Errors
/// An input error for results that are none or damaged; [`crate::Error::Io`] if the disk refuses.
pub fn report(results: &Path, site: Option<&Site>) -> Result<PathBuf> {
    let (page, path) = if results.is_dir() {
        (page_of(results, site), results.join(PAGE_NAME))
    } else if results.exists() {
        (history::page(results), page_beside(results))
    } else {
        return Err(InputError::file(results, "nothing there", RESULTS).into());
    };
    write_durably(&path, page.map_err(as_damage)?.html()?.as_bytes())?;
    Ok(path)
}

/// FILE.html for a history FILE: `run.html` beside `run.parquet` may be the page of `mrbd simulate --plot`.
fn page_beside(history: &Path) -> PathBuf {
    let mut name = history.as_os_str().to_owned();
    name.push(".html");
    PathBuf::from(name)
}

/// What a page can be made of.
const RESULTS: &str =
    "a folder of `mrbd run`, `mrbd calibrate` or `mrbd diagnose`, or a history of `mrbd simulate`";

/// What a manifest says its folder holds; without a word, a study of runs.
#[derive(Deserialize)]
struct Kind {
    kind: Option<String>,
}

fn page_of(folder: &Path, site: Option<&Site>) -> Result<Page> {
    let path = folder.join("manifest.json");
    if !path.is_file() {
        // An overturning spectrum keeps its provenance in its tables.
        return match folder.join("boundaries.parquet").is_file() {
            true => overturning::page(folder),
            false => Err(InputError::file(folder, "no manifest.json", RESULTS).into()),
        };
    }
    let Kind { kind } = read_json(&path, "a manifest as mrbd writes it beside its results")?;
    match kind.as_deref() {
        Some(results::calibration::KIND) => calibration::page(folder),
        Some(results::diagnosis::KIND) => diagnosis::page(folder),
        Some(crate::classics::comparison::KIND) => comparison::page(folder),
        _ => study(folder, &path, site),
    }
}

fn study(folder: &Path, path: &Path, site: Option<&Site>) -> Result<Page> {
    match Manifest::read(path)? {
        Some(manifest) if manifest.kind.is_drawn() => drawn::page(folder, &manifest, site),
        Some(manifest) => sweep::page(folder, &manifest, site),
        None => Err(InputError::file(path, "nothing there", RESULTS).into()),
    }
}

/// Results that cannot be read are bad input here: whatever wrote them, a page cannot be made from them.
fn as_damage(error: Error) -> Error {
    match error {
        Error::Table { path, message } => {
            let allowed = "results as `mrbd run` writes them; run the study again with --force";
            InputError::file(&path, message, allowed).into()
        }
        other => other,
    }
}

//! What a page shows of results: read from their folder and computed before anything is drawn.
//!
//! | module | what |
//! | --- | --- |
//! | `sweep` | medians, the paper's conclusions, the reference façades record by record |
//! | `drawn` | distributions over drawn façades, the façades drawn beside the survey's |
//! | `sequences` | what records do after others |
//! | `fragility` | the probability of reaching each limit |
//! | `spectra` | response spectra of the records |
//! | `calibration` | the tests simulated again with the calibrated wall |
//! | `file` | files of results, and inputs found again |

mod calibration;
mod drawn;
mod file;
mod fragility;
mod sequences;
mod spectra;
mod sweep;

pub use calibration::{Calibrated, Rotations, TestRotations};
pub use drawn::{Drawn, FloorSamples, Samples};
pub use file::{Note, read_json};
pub use fragility::{DEFAULT_INTENSITY, LEVEL, LimitFragility};
pub use sequences::AfterOthers;
pub use spectra::{CodeSpectrum, Spectra};
pub use sweep::Sweep;

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::aggregate::SEQUENCES_TABLE;
use crate::error::{Error, InputError, Result};
use crate::results;
use crate::study;
use crate::study::runs::{Completeness, Manifest};
use mrbd_records::Site;

/// Results as a page shows them.
#[derive(Debug)]
pub enum Summary {
    /// A sweep.
    Sweep(Box<Sweep>),
    /// Drawn façades.
    Drawn(Box<Drawn>),
    /// Records one after another.
    Sequences(Box<AfterOthers>),
    /// A calibration.
    Calibration(Box<Calibrated>),
    /// The folder of a diagnosis, drawn as it is stored.
    Diagnosis(PathBuf),
    /// The folder of a comparison of models, drawn as it is stored.
    Comparison(PathBuf),
    /// The folder of an overturning spectrum, drawn as it is stored.
    Overturning(PathBuf),
    /// The folder of sweeps under several suites, drawn as it is stored.
    Suites(PathBuf),
    /// The folder of intensity measures, drawn as it is stored.
    Measures(PathBuf),
    /// The folder of shares of a variance, drawn as it is stored.
    Variance(PathBuf),
    /// The folder of a wall's margin, drawn as it is stored.
    Margin(PathBuf),
    /// The folder of an assessment, drawn as it is stored.
    Assessment(PathBuf),
    /// The folder of a survey's assessments, drawn as it is stored.
    Portfolio(PathBuf),
    /// The folder of a slow push, drawn as it is stored.
    Push(PathBuf),
    /// The file of a history, drawn as it is stored.
    History(PathBuf),
}

/// What a page can be made of.
const RESULTS: &str =
    "a folder of `mrbd run`, `mrbd calibrate` or `mrbd diagnose`, or a history of `mrbd simulate`";

/// What a manifest says its folder holds; `None` for a study of runs.
#[derive(Deserialize)]
struct Kind {
    kind: Option<String>,
}

impl Summary {
    /// Reads the results in a folder, or a history file, and computes what their page shows.
    ///
    /// # Errors
    /// An input error for a path without results, or with damaged ones.
    pub fn of(results: &Path, site: Option<&Site>) -> Result<Self> {
        if !results.exists() {
            return Err(InputError::file(results, "nothing there", RESULTS).into());
        }
        if !results.is_dir() {
            return Ok(Self::History(results.to_path_buf()));
        }
        let manifest = results.join("manifest.json");
        if manifest.is_file() {
            return of_folder(results, &manifest, site).map_err(as_damage);
        }
        // An overturning spectrum keeps its provenance in its tables.
        match results.join("boundaries.parquet").is_file() {
            true => Ok(Self::Overturning(results.to_path_buf())),
            false => Err(InputError::file(results, "no manifest.json", RESULTS).into()),
        }
    }

    /// How much of its plan the study has run; `None` for results of other kinds, which are written whole.
    pub fn completeness(&self) -> Option<Completeness> {
        match self {
            Self::Sweep(sweep) => sweep.medians.completeness,
            Self::Drawn(drawn) => drawn.distributions.completeness,
            Self::Sequences(after) => after.sequences.completeness,
            _ => None,
        }
    }

    /// Writes the tables to which the page links and which a study does not write itself.
    ///
    /// # Errors
    /// [`Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn write_tables(&self, folder: &Path) -> Result<()> {
        let medians = folder.join("medians.parquet");
        match self {
            Self::Sweep(sweep) => sweep.write_medians(&medians),
            Self::Drawn(drawn) => drawn.distributions.write(&medians),
            Self::Sequences(after) => after.sequences.write(&folder.join(SEQUENCES_TABLE)),
            _ => Ok(()),
        }
    }
}

fn of_folder(folder: &Path, manifest: &Path, site: Option<&Site>) -> Result<Summary> {
    let Kind { kind } = read_json(manifest, "a manifest as mrbd writes it beside its results")?;
    match kind.as_deref() {
        Some(results::calibration::KIND) => Ok(Summary::Calibration(Box::new(Calibrated::read(folder)?))),
        Some(results::diagnosis::KIND) => Ok(Summary::Diagnosis(folder.to_path_buf())),
        Some(crate::sensitivity::suites::KIND) => Ok(Summary::Suites(folder.to_path_buf())),
        Some(crate::sensitivity::measures::KIND) => Ok(Summary::Measures(folder.to_path_buf())),
        Some(crate::sensitivity::variance::KIND) => Ok(Summary::Variance(folder.to_path_buf())),
        Some(crate::assessment::margin::KIND) => Ok(Summary::Margin(folder.to_path_buf())),
        Some(crate::assessment::wall::KIND) => Ok(Summary::Assessment(folder.to_path_buf())),
        Some(crate::assessment::portfolio::KIND) => Ok(Summary::Portfolio(folder.to_path_buf())),
        Some(crate::assessment::push::KIND) => Ok(Summary::Push(folder.to_path_buf())),
        Some(crate::classics::comparison::KIND) => Ok(Summary::Comparison(folder.to_path_buf())),
        _ => of_study(folder, manifest, site),
    }
}

fn of_study(folder: &Path, path: &Path, site: Option<&Site>) -> Result<Summary> {
    match Manifest::read(path)? {
        Some(manifest) if manifest.kind == crate::study::pipeline::Kind::Variance => {
            let allowed = "the folder that `mrbd variance DIR --out …` makes of it, with its page";
            Err(InputError::file(path, "a study of variance", allowed).into())
        }
        Some(manifest) if manifest.kind.is_drawn() => {
            Ok(Summary::Drawn(Box::new(Drawn::read(folder, manifest, site)?)))
        }
        Some(manifest) if manifest.kind == study::pipeline::Kind::Sequence => {
            Ok(Summary::Sequences(Box::new(AfterOthers::read(folder, manifest, site)?)))
        }
        Some(manifest) => Ok(Summary::Sweep(Box::new(Sweep::read(folder, manifest, site)?))),
        None => Err(InputError::file(path, "nothing there", RESULTS).into()),
    }
}

/// Results that cannot be read are bad input here: whatever wrote them, a page cannot be made from them.
pub fn as_damage(error: Error) -> Error {
    match error {
        Error::Table { path, message } => {
            let allowed = "results as `mrbd run` writes them; run the study again with --force";
            InputError::file(&path, message, allowed).into()
        }
        other => other,
    }
}

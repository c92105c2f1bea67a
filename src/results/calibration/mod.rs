//! The output folder of a calibration.
//!
//! ```text
//! manifest.json            `kind`: `calibration`; program, seed, files that were read; written first
//! calibration.json         everything found
//! candidates.parquet       every simulation
//! generations.parquet      how every search converged
//! wall.calibrated.toml     the wall with the vector for all tests, for `mrbd simulate`
//! journal.tsv              simulations so far, while the calibration runs
//! ```

mod candidates;
mod generations;
mod manifest;

pub use manifest::KIND;

use std::path::{Path, PathBuf};

use crate::error::{Error, InputError, Result};
use crate::store::write_durably;
use candidates::write_candidates;
use generations::write_generations;
use manifest::write_manifest;
use mrbd_lab::calibrate::Archive;
use mrbd_lab::calibrate::Calibration;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::calibrate::method_names;

/// Where things go in the output folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputNames {
    /// Kind and provenance.
    pub manifest: PathBuf,
    /// Everything found.
    pub calibration: PathBuf,
    /// Every simulation.
    pub candidates: PathBuf,
    /// How every search converged.
    pub generations: PathBuf,
    /// The wall with the joint vector, for `mrbd simulate`.
    pub wall: PathBuf,
    /// Simulations of a calibration that is running or was stopped.
    pub journal: PathBuf,
}

impl OutputNames {
    /// The names in a folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            manifest: folder.join("manifest.json"),
            calibration: folder.join("calibration.json"),
            candidates: folder.join("candidates.parquet"),
            generations: folder.join("generations.parquet"),
            wall: folder.join("wall.calibrated.toml"),
            journal: folder.join("journal.tsv"),
        }
    }

    /// Makes the folder ready: it must be empty, or `resume` a calibration that was stopped.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written, or holds results or other files.
    pub fn prepare(folder: &Path, experiment: &Experiment, resume: bool) -> Result<Self> {
        let refuse = |found: String, allowed: &str| InputError::option("--out", found, allowed);
        std::fs::create_dir_all(folder)
            .map_err(|e| refuse(format!("{}: {e}", folder.display()), "a folder that can be written"))?;
        let names = Self::new(folder);
        let entries = std::fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?;
        let stopped = names.journal.exists();
        if stopped && !resume {
            let found = format!("{}, which holds a stopped calibration", folder.display());
            return Err(refuse(found, "an empty folder, or --resume to go on with it").into());
        }
        // Alone it was left by a stop before the first simulation.
        let other = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.is_ok_and(|entry| entry.path() != names.manifest)
        };
        if !stopped && entries.into_iter().any(other) {
            let found = format!("{}, which holds other files", folder.display());
            return Err(refuse(found, "an empty folder").into());
        }
        if !stopped {
            write_manifest(&names.manifest, experiment)?;
        }
        Ok(names)
    }
}

/// What the calibration that is finished in a folder found; `None` where none is.
///
/// A journal beside it was left by a stop after the last result was written, and is removed.
///
/// # Errors
/// Input errors for results of other inputs, or that cannot be read; [`mrbd_files::Error::Io`] if the disk refuses.
pub fn finished(folder: &Path, experiment: &Experiment) -> Result<Option<Calibration>> {
    let names = OutputNames::new(folder);
    if !names.calibration.exists() {
        return Ok(None);
    }
    let bytes = std::fs::read(&names.calibration).map_err(|e| Error::io("read", &names.calibration, e))?;
    let refuse = |found: String, allowed: &str| InputError::file(&names.calibration, found, allowed);
    let stored: Calibration = serde_json::from_slice(&bytes)
        .map_err(|e| refuse(e.to_string(), "results as `mrbd calibrate` writes them"))?;
    if stored.request_sha256 != experiment.request {
        let allowed = "the output folder of this calibration, with the same inputs and seed, or a new folder";
        return Err(refuse("the results of another calibration".into(), allowed).into());
    }
    if names.journal.exists() {
        std::fs::remove_file(&names.journal).map_err(|e| Error::io("remove", &names.journal, e))?;
    }
    Ok(Some(stored))
}

/// Writes everything a calibration found; the files are whole or absent.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
pub fn write_results(
    names: &OutputNames,
    experiment: &Experiment,
    calibration: &Calibration,
    archive: Archive,
) -> Result<()> {
    let rows = archive.rows(&method_names(experiment));
    write_candidates(&names.candidates, &rows, &experiment.space.parameters, &experiment.tests)?;
    write_generations(&names.generations, &calibration.methods)?;
    write_durably(&names.wall, wall_text(experiment, calibration).as_bytes())?;
    let json = serde_json::to_string_pretty(calibration)
        .map_err(|e| Error::io("write the results", &names.calibration, e.into()))?;
    write_durably(&names.calibration, (json + "\n").as_bytes())?;
    Ok(archive.close()?)
}

fn wall_text(experiment: &Experiment, calibration: &Calibration) -> String {
    let table = experiment.space.table_with(&calibration.joint.values);
    let wme = calibration.joint.mean_wme.map_or_else(|| "none".to_owned(), |wme| format!("{wme:.4}"));
    format!(
        "# Calibrated by mrbd {} to {} test(s); mean WME {wme}; seed {}.\n\n{table}",
        calibration.tool_version,
        experiment.fit_tests().len(),
        calibration.seed,
    )
}

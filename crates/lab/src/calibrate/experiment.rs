//! An experiment, read whole: what is calibrated, the tests, the settings.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::space::ParameterSpace;
use crate::experiment::file::{CalibrateTable, ExperimentFile, Purpose};
use crate::experiment::{Test, load_tests};
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::Accuracy;

/// An experiment ready to be calibrated.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// The file.
    pub path: PathBuf,
    /// What is calibrated.
    pub space: ParameterSpace,
    /// The tests, in the order of the file.
    pub tests: Vec<Test>,
    /// The settings.
    pub settings: CalibrateTable,
    /// What was read, each file with its role.
    pub files: Vec<(String, PathBuf)>,
    /// SHA-256 of everything that decides the result.
    pub request: String,
}

impl Experiment {
    /// Reads an experiment and every file it names; `seed` replaces the file's.
    ///
    /// # Errors
    /// Input errors with file, key or line, what was found and what is allowed.
    pub fn load(path: &Path, seed: Option<u64>) -> Result<Self> {
        let file = ExperimentFile::load(path)?;
        let space = ParameterSpace::load(path, &file)?;
        // With C_l as in its file, which a start time is matched by.
        let given =
            Wall::new(space.base().clone()).map_err(|e| InputError::key(path, e.key, e.found, e.allowed))?;
        let settings = CalibrateTable { seed: seed.unwrap_or(file.calibrate.seed), ..file.calibrate.clone() };
        let accuracy = Accuracy { tolerance: settings.tolerance };
        let tests = load_tests(path, &file, &given, accuracy)?;
        let files = file.files(path);
        let request = request(&files, &settings)?;
        Ok(Self { path: path.to_path_buf(), space, tests, settings, files, request })
    }

    /// Numbers of the tests that the search sees.
    pub fn fit_tests(&self) -> Vec<usize> {
        (0..self.tests.len()).filter(|&k| self.tests[k].purpose == Purpose::Fit).collect()
    }

    /// Accuracy of the simulations.
    pub fn accuracy(&self) -> Accuracy {
        Accuracy { tolerance: self.settings.tolerance }
    }
}

/// Identifies the inputs: program, settings, and the bytes of every file.
fn request(files: &[(String, PathBuf)], settings: &CalibrateTable) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(format!("{settings:?}"));
    for (_, name) in files {
        let readable = |e: std::io::Error| InputError::file(name, e.to_string(), "a readable file");
        hash.update(std::fs::read(name).map_err(readable)?);
    }
    Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

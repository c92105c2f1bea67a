//! Drawn façades: distributions of the response, fragilities, and the draws against the survey.

use std::path::{Path, PathBuf};

use super::file::first;
use super::fragility::{LimitFragility, fragilities};
use super::samples::Samples;
use super::spectra::Spectra;
use super::sweep::run_files;
use crate::aggregate::{Distributions, distributions};
use crate::error::Result;
use crate::study::runs::Manifest;
use mrbd_records::Site;

/// A study of drawn façades as its page shows it.
#[derive(Debug)]
pub struct Drawn {
    /// Its manifest.
    pub manifest: Manifest,
    /// Quantiles of the response; there is at least one variant.
    pub distributions: Distributions,
    /// Fragilities of the first variant.
    pub fragilities: Vec<LimitFragility>,
    /// The façades of the first variant.
    pub samples: Samples,
    /// Spectra of the records; `None` where they are gone or other ones now.
    pub spectra: Option<Spectra>,
    /// Run files, from the folder of the results.
    pub run_files: Vec<PathBuf>,
}

impl Drawn {
    /// Reads the study in a folder.
    ///
    /// # Errors
    /// An input error for a folder without results; [`crate::Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path, manifest: Manifest, site: Option<&Site>) -> Result<Self> {
        let distributions = distributions(folder, manifest.kind)?;
        let base = &first(folder, &distributions.variants)?.name;
        Ok(Self {
            fragilities: fragilities(folder, &distributions, base)?,
            samples: Samples::read(folder, &manifest, base)?,
            spectra: Spectra::of(folder, &manifest, site),
            run_files: run_files(folder)?,
            distributions,
            manifest,
        })
    }
}

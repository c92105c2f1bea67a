//! Records one after another: what each does after the others, and their spectra.

use std::path::{Path, PathBuf};

use super::file::first;
use super::spectra::Spectra;
use super::sweep::run_files;
use crate::aggregate::{Sequences, sequences};
use crate::error::Result;
use crate::study::runs::Manifest;
use mrbd_records::Site;

/// A study of sequences as its page shows it.
#[derive(Debug)]
pub struct AfterOthers {
    /// Its manifest.
    pub manifest: Manifest,
    /// What records do after others; there is at least one variant.
    pub sequences: Sequences,
    /// Spectra of the records; `None` where they are gone or other ones now.
    pub spectra: Option<Spectra>,
    /// Run files, from the folder of the results.
    pub run_files: Vec<PathBuf>,
}

impl AfterOthers {
    /// Reads the study in a folder.
    ///
    /// # Errors
    /// An input error for a folder without results; [`crate::Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path, manifest: Manifest, site: Option<&Site>) -> Result<Self> {
        let sequences = sequences(folder)?;
        first(folder, &sequences.variants)?;
        let spectra = Spectra::of(folder, &manifest, site);
        Ok(Self { run_files: run_files(folder)?, spectra, sequences, manifest })
    }
}

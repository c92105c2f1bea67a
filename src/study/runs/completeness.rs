//! How much of its plan a study has run: what every figure that is made of it has to say.

use std::collections::BTreeSet;
use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};

use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use serde::Serialize;

use super::manifest::Manifest;
use super::parts::run_files;
use crate::error::{Error, Result};

/// The runs that a folder holds, of those that its study has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Completeness {
    /// Runs that are stored.
    pub runs: u64,
    /// Runs of the plan.
    pub planned_runs: u64,
    /// Records under which any run is stored.
    pub records: u64,
    /// Records of the suite.
    pub planned_records: u64,
    /// Whether sequences of records are counted in their place.
    #[serde(skip)]
    pub of_sequences: bool,
}

impl Completeness {
    /// Of the study in a folder; `None` without a manifest, where nobody knows what was planned.
    ///
    /// # Errors
    /// As [`run_files`]; [`Error::Table`] for files that cannot be read.
    pub fn of(folder: &Path) -> Result<Option<Self>> {
        manifest_of(folder)?.map(|manifest| Self::counted(&manifest, &run_files(folder)?)).transpose()
    }

    /// The same where its files are known already, those of [`run_files`].
    ///
    /// # Errors
    /// As [`Completeness::of`].
    pub fn of_files(folder: &Path, files: &[PathBuf]) -> Result<Option<Self>> {
        manifest_of(folder)?.map(|manifest| Self::counted(&manifest, files)).transpose()
    }

    fn counted(manifest: &Manifest, files: &[PathBuf]) -> Result<Self> {
        Ok(Self {
            runs: files.iter().map(rows).sum::<Result<u64>>()?,
            planned_runs: manifest.runs,
            // A file lies in the folder of its record, finished or not.
            records: files.iter().filter_map(|file| file.parent()?.file_name()).collect::<BTreeSet<_>>().len()
                as u64,
            planned_records: manifest.motions().len() as u64,
            of_sequences: !manifest.sequences.is_empty(),
        })
    }

    /// Whether all runs are there.
    pub fn is_whole(&self) -> bool {
        self.runs >= self.planned_runs
    }

    /// What is to be said of figures that are made of the runs; `None` if all are there.
    pub fn note(&self) -> Option<String> {
        (!self.is_whole()).then(|| format!("the study is unfinished: {self}"))
    }
}

impl fmt::Display for Completeness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { runs, planned_runs, records, planned_records, of_sequences } = self;
        let motions = if *of_sequences { "sequences" } else { "records" };
        write!(f, "{runs} of {planned_runs} runs, under {records} of {planned_records} {motions}")
    }
}

fn manifest_of(folder: &Path) -> Result<Option<Manifest>> {
    Manifest::read(&folder.join("manifest.json"))
}

/// Rows of a file, by its footer.
fn rows(path: &PathBuf) -> Result<u64> {
    let file = File::open(path).map_err(|e| Error::io("read", path, e))?;
    let footer = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| Error::table(path, e))?;
    Ok(footer.metadata().file_metadata().num_rows().unsigned_abs())
}

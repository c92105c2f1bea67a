//! A sweep: medians over the records, the paper's conclusions, and the reference façades record by record.

use std::path::{Path, PathBuf};

use super::file::first;
use super::spectra::Spectra;
use crate::aggregate::{Medians, ReferenceRun, aggregate, reference_runs, write_medians};
use crate::error::Result;
use crate::findings::{Conclusions, View, conclusions};
use crate::study::runs::{Manifest, listed_run_files};
use crate::survey::Configuration;
use mrbd_records::Site;

/// A sweep as its page shows it.
#[derive(Debug)]
pub struct Sweep {
    /// Its manifest.
    pub manifest: Manifest,
    /// Records under which runs are stored.
    pub records: usize,
    /// Medians over the records; there is at least one variant.
    pub medians: Medians,
    /// The paper's conclusions under each variant, the first the one that the figures show.
    pub conclusions: Vec<Conclusions>,
    /// Runs of the reference façades under the first variant; empty for a single record.
    pub reference: Vec<ReferenceRun>,
    /// Spectra of the records; `None` where they are gone or other ones now.
    pub spectra: Option<Spectra>,
    /// Run files, from the folder of the results.
    pub run_files: Vec<PathBuf>,
}

impl Sweep {
    /// Reads the sweep in a folder.
    ///
    /// # Errors
    /// An input error for a folder without results; [`crate::Error::Table`] for files that cannot be read.
    pub fn read(folder: &Path, manifest: Manifest, site: Option<&Site>) -> Result<Self> {
        let medians = aggregate(folder)?;
        let base = first(folder, &medians.variants)?.name.clone();
        // Of an unfinished study, those that were run.
        let records = medians.completeness.map_or(manifest.suite.records.len() as u64, |study| study.records);
        let reference = match records {
            1 => Vec::new(),
            _ => reference(folder, &View::new(&medians, &base))?,
        };
        Ok(Self {
            conclusions: conclusions(&medians),
            spectra: Spectra::of(folder, &manifest, site),
            run_files: run_files(folder)?,
            reference,
            medians,
            records: records as usize,
            manifest,
        })
    }

    /// The medians of the variant that the figures show.
    pub fn view(&self) -> View<'_> {
        View::new(&self.medians, self.conclusions.first().map_or("", |first| &first.variant))
    }

    /// Writes the medians.
    ///
    /// # Errors
    /// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn write_medians(&self, path: &Path) -> Result<()> {
        write_medians(path, &self.medians)
    }
}

fn reference(folder: &Path, view: &View) -> Result<Vec<ReferenceRun>> {
    let first = |c: Configuration| view.parameters(c).first().map(|&parameter| (c, parameter));
    let among: Vec<_> = Configuration::ALL.into_iter().filter_map(first).collect();
    reference_runs(folder, view.variant(), &among)
}

/// Run files of a study, from its folder.
///
/// # Errors
/// As [`listed_run_files`].
pub fn run_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let relative = |path: PathBuf| path.strip_prefix(folder).map(Path::to_path_buf).unwrap_or(path);
    // The figures beside them are made of the same files, checked.
    Ok(listed_run_files(folder)?.into_iter().map(relative).collect())
}

//! `mrbd aggregate`: medians and quantiles of a study that was run, and what a sweep decides.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use crate::aggregate::{
    Distributions, Medians, SEQUENCES_TABLE, Sequences, aggregate, distributions, print_medians, sequences,
    write_medians,
};
use crate::error::Result;
use crate::findings::{
    Conclusions, conclusions, report, report_distributions, report_sequences, write_findings,
};
use crate::sensitivity::variance::{self, Shares};
use crate::study::pipeline::Kind;
use crate::study::runs::{Completeness, Manifest};

/// Read the runs of a study, write medians.parquet (and findings.csv of a sweep, sequences.parquet of sequences,
/// indices.parquet of a study of variance) beside them, print tables and findings.
#[derive(Debug, Args)]
pub struct AggregateCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Print the medians and quantiles as CSV instead of tables.
    #[arg(long)]
    csv: bool,
}

impl AggregateCommand {
    /// Runs the command. A folder that cannot be written, say a colleague's, is read all the same.
    ///
    /// # Errors
    /// An input error for a folder without results.
    pub fn execute(self) -> Result<()> {
        let aggregated = read(&self.folder)?;
        match (&aggregated, self.csv) {
            (Aggregated::Sweep(medians, _), true) => {
                output::to_stdout(|out| print_medians(out, medians).map_err(output::failed))?;
            }
            (Aggregated::Sequences(study), true) => {
                output::to_stdout(|out| study.print_csv(out).map_err(output::failed))?;
            }
            (Aggregated::Drawn(study), true) => {
                output::to_stdout(|out| study.print_csv(out).map_err(output::failed))?;
            }
            (Aggregated::Variance(shares), true) => {
                output::to_stdout(|out| variance::print_csv(out, shares).map_err(output::failed))?;
            }
            (_, false) => print(&aggregated)?,
        }
        if let Err(e) = keep(&self.folder, &aggregated) {
            eprintln!("mrbd: note: the medians are not kept beside the runs: {e}");
        }
        Ok(())
    }
}

/// What a study tells, by its kind.
enum Aggregated {
    Sweep(Medians, Vec<Conclusions>),
    Drawn(Distributions),
    Sequences(Sequences),
    Variance(Shares),
}

/// Aggregates the study in a folder, prints its medians with what they decide and writes them there.
///
/// # Errors
/// As [`AggregateCommand::execute`]; [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses.
pub(super) fn aggregate_and_print(folder: &Path) -> Result<()> {
    let aggregated = read(folder)?;
    print(&aggregated)?;
    keep(folder, &aggregated)
}

fn print(aggregated: &Aggregated) -> Result<()> {
    output::to_stdout(|out| {
        let printed = match aggregated {
            Aggregated::Sweep(medians, conclusions) => report(out, medians, conclusions),
            Aggregated::Drawn(study) => report_distributions(out, study),
            Aggregated::Sequences(study) => report_sequences(out, study),
            Aggregated::Variance(shares) => variance::print_tables(out, shares),
        };
        printed.map_err(output::failed)
    })
}

fn read(folder: &Path) -> Result<Aggregated> {
    let aggregated = match kind_of(folder)? {
        Kind::Sweep => {
            let medians = aggregate(folder)?;
            let conclusions = conclusions(&medians);
            Aggregated::Sweep(medians, conclusions)
        }
        Kind::Sequence => Aggregated::Sequences(sequences(folder)?),
        Kind::Variance => Aggregated::Variance(variance::of_folder(folder)?),
        kind => Aggregated::Drawn(distributions(folder, kind)?),
    };
    let completeness = match &aggregated {
        Aggregated::Sweep(medians, _) => medians.completeness,
        Aggregated::Drawn(study) => study.completeness,
        Aggregated::Sequences(study) => study.completeness,
        // It is told of whole studies alone.
        Aggregated::Variance(_) => None,
    };
    tell_unfinished(completeness);
    Ok(aggregated)
}

/// Writes medians, and the findings of a sweep, beside the runs; nothing is printed of a study that is finished.
///
/// # Errors
/// The folder holds no results that can be aggregated; medians that cannot be written.
pub fn keep_medians(folder: &Path) -> Result<()> {
    keep(folder, &read(folder)?)
}

fn keep(folder: &Path, aggregated: &Aggregated) -> Result<()> {
    let file = folder.join("medians.parquet");
    match aggregated {
        Aggregated::Sweep(medians, conclusions) => {
            write_medians(&file, medians)?;
            write_findings(&folder.join("findings.csv"), medians, conclusions)
        }
        Aggregated::Drawn(study) => study.write(&file),
        Aggregated::Sequences(study) => study.write(&folder.join(SEQUENCES_TABLE)),
        Aggregated::Variance(shares) => variance::write_table(&folder.join("indices.parquet"), shares),
    }
}

/// The kind of the study in a folder; files without a manifest are read as a sweep's.
pub(super) fn kind_of(folder: &Path) -> Result<Kind> {
    Ok(Manifest::read(&folder.join("manifest.json"))?.map_or(Kind::Sweep, |manifest| manifest.kind))
}

/// Says so before figures of an unfinished study are given.
pub(super) fn tell_unfinished(study: Option<Completeness>) {
    if let Some(note) = study.and_then(|study| study.note()) {
        eprintln!("mrbd: {note}; `mrbd status` tells more, `mrbd run … --resume` does the rest");
    }
}

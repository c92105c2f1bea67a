//! `mrbd aggregate`: medians, tables and findings of a study that was run.

use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use crate::aggregate::{Medians, aggregate, print_medians, write_medians};
use crate::error::Result;
use crate::findings::{report, write_findings};
use crate::store::OutputFolder;

/// Read the runs of a study, write medians.parquet and findings.csv beside them, print tables and findings.
#[derive(Debug, Args)]
pub struct AggregateCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Print the medians and quantiles as CSV instead of tables.
    #[arg(long)]
    csv: bool,
}

impl AggregateCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// An input error for a folder without results; [`crate::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        match self.csv {
            true => {
                let medians = aggregate_into(&self.folder)?;
                output::to_stdout(|out| print_medians(out, &medians).map_err(output::failed))
            }
            false => aggregate_and_print(&self.folder),
        }
    }
}

/// Aggregates the study in a folder, writes its medians there and prints them with what they decide.
///
/// # Errors
/// As [`AggregateCommand::execute`].
pub(super) fn aggregate_and_print(folder: &Path) -> Result<()> {
    let medians = aggregate_into(folder)?;
    output::to_stdout(|out| report(out, &medians).map_err(output::failed))
}

fn aggregate_into(folder: &Path) -> Result<Medians> {
    let medians = aggregate(folder)?;
    tell_missing(folder, &medians)?;
    write_medians(&folder.join("medians.parquet"), &medians)?;
    write_findings(&folder.join("findings.csv"), &medians)?;
    Ok(medians)
}

/// Medians of an unfinished study are of the runs there are.
fn tell_missing(folder: &Path, medians: &Medians) -> Result<()> {
    let all = OutputFolder::look(folder)?.manifest().runs;
    let runs: u64 = medians.variants.iter().map(|variant| variant.runs).sum();
    if runs < all {
        eprintln!("mrbd: the study is unfinished: medians of {runs} of {all} runs");
    }
    Ok(())
}

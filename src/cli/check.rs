//! `mrbd check`: whether the medians of a study are still those that were accepted.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::aggregate::{kind_of, tell_unfinished};
use super::output;
use crate::aggregate::{aggregate, distributions};
use crate::check::{Baseline, Change, compare, figures_of_drawn, figures_of_sweep};
use crate::error::{Error, InputError, Result};
use crate::study::pipeline::Kind;
use crate::study::runs::Completeness;

/// Compare the medians of a study with a baseline and fail with a table of what moved.
#[derive(Debug, Args)]
pub struct CheckCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// The accepted medians (CSV).
    #[arg(long, value_name = "FILE")]
    baseline: PathBuf,
    /// Make the study's medians the accepted ones.
    #[arg(long, requires = "because")]
    accept: bool,
    /// Why; it is kept in the baseline.
    #[arg(long, value_name = "REASON", requires = "accept")]
    because: Option<String>,
}

impl CheckCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// [`Error::Moved`] if anything moved beyond its tolerance; input errors for a folder without results, a baseline
    /// that is none or an empty reason; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        let (variants, figures, study) = match kind_of(&self.folder)? {
            Kind::Sweep => {
                let medians = aggregate(&self.folder)?;
                (medians.variants.clone(), figures_of_sweep(&medians), medians.completeness)
            }
            Kind::Sequence => {
                let allowed = "a sweep or a study of drawn façades; `mrbd aggregate` tells what sequences do";
                return Err(
                    InputError::file(&self.folder, "a study of sequences, without medians", allowed).into()
                );
            }
            Kind::Variance => {
                let allowed = "a study with medians; shares of a variance have intervals instead";
                return Err(InputError::file(&self.folder, "a study of variance", allowed).into());
            }
            kind => {
                let study = distributions(&self.folder, kind)?;
                (study.variants.clone(), figures_of_drawn(&study), study.completeness)
            }
        };
        self.check_whole(study)?;
        let now = Baseline::of(&variants, figures, &self.folder)?;
        let accepted = match self.accept && !self.baseline.exists() {
            true => None,
            false => Some(Baseline::load(&self.baseline)?),
        };
        let changes = accepted.as_ref().map_or(Vec::new(), |accepted| compare(accepted, &now));
        let told = accepted.as_ref().unwrap_or(&now);
        output::to_stdout(|out| print_changes(out, told, &changes).map_err(output::failed))?;
        match &self.because {
            Some(why) => self.accept(why, accepted, now),
            None if changes.is_empty() => Ok(()),
            None => Err(Error::Moved { figures: changes.len(), baseline: self.baseline }),
        }
    }

    /// Medians of an unfinished study cannot be accepted; what moved of them is told with a word on it.
    fn check_whole(&self, study: Option<Completeness>) -> Result<()> {
        tell_unfinished(study);
        match study.and_then(|study| study.note()).filter(|_| self.accept) {
            Some(note) => Err(InputError::file(&self.folder, note, "a study that is run to its end").into()),
            None => Ok(()),
        }
    }

    fn accept(&self, why: &str, accepted: Option<Baseline>, mut now: Baseline) -> Result<()> {
        let why = why.split_whitespace().collect::<Vec<_>>().join(" ");
        if why.is_empty() {
            return Err(InputError::option("--because", "nothing", "why the new medians are right").into());
        }
        now.accepted = accepted.map_or(Vec::new(), |accepted| accepted.accepted);
        now.accepted.push(why);
        now.write(&self.baseline)?;
        eprintln!("mrbd: {} medians accepted into {}", now.entries.len(), self.baseline.display());
        Ok(())
    }
}

fn print_changes(out: &mut dyn Write, baseline: &Baseline, changes: &[Change]) -> std::io::Result<()> {
    let entries = baseline.entries.len();
    let unsure = baseline.entries.iter().filter(|entry| entry.tolerance.is_infinite()).count();
    writeln!(
        out,
        "{entries} medians compared, {unsure} of them undecided by roundings; {} figures moved",
        changes.len()
    )?;
    writeln!(out, "tolerance: {}", baseline.tolerance_source)?;
    if changes.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n{:<60} {:<24} {:>10} {:>10} {:>10} {:>9}",
        "case", "figure", "was", "is", "by", "allowed"
    )?;
    for change in changes {
        let Change { case, figure, was, is, by, tolerance } = change;
        let by = by.map_or("-".to_owned(), |by| format!("{by:+.2e}"));
        writeln!(out, "{case:<60} {figure:<24} {was:>10} {is:>10} {by:>10} {tolerance:>9.1e}")?;
    }
    Ok(())
}

//! `mrbd check-tolerance`: how many runs of a study depend on the tolerance of the solver, and whether medians do.

use std::num::NonZero;
use std::path::PathBuf;

use clap::Args;

use super::aggregate::tell_unfinished;
use super::threads::Threads;
use super::{output, progress, replay};
use crate::aggregate::{Compared, MOVED_SHARE, stored_answers};
use crate::check::{Conditioning, conditioning, run_again, sampled};
use crate::error::{InputError, Result};
use crate::study::pipeline::Kind;
use crate::study::plan::Plan;
use crate::study::runs::{Completeness, OutputFolder};
use crate::text::aligned;
use mrbd_kernel::simulate::Accuracy;

/// Run a sample of a study's runs again at a tighter tolerance: the share that comes out differently, and the medians.
///
/// Such runs are ill-conditioned: two impacts nearly coincide, and a tiny change of step decides the later motion. The
/// sample has one run of each equal stretch of the plan; runs that are not stored yet, or failed, are left out.
#[derive(Debug, Args)]
pub struct CheckToleranceCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Runs to do again.
    #[arg(long, value_name = "N", default_value = "500")]
    sample: NonZero<u64>,
    /// Tolerance of the runs again; without it a hundredth of the study's.
    #[arg(long, value_name = "X")]
    tolerance: Option<f64>,
    /// Seed of the sample.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    threads: Threads,
}

impl CheckToleranceCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for a folder without runs, inputs that changed since, or a tolerance that is not tighter.
    pub fn execute(self) -> Result<()> {
        let folder = OutputFolder::look(&self.folder)?;
        if folder.manifest().kind == Kind::Sequence {
            let allowed = "a sweep or a study of drawn façades, whose runs are apart";
            return Err(InputError::file(&self.folder, "a study of sequences", allowed).into());
        }
        let plan = replay::plan_of(&folder)?;
        self.check_tolerance(&plan)?;
        let compared = Compared::of(plan.kind());
        let mut positions = sampled(plan.len(), self.sample.get(), self.seed);
        // A member of an ensemble is itself a run again.
        positions.retain(|&position| plan.run(position).variant.member.is_none());
        tell_unfinished(Completeness::of(folder.path())?);
        let stored = stored_answers(folder.path(), &positions, &compared)?;
        eprintln!("mrbd: {} runs again at a tighter tolerance", stored.len());
        let progress = progress::of_runs(stored.len() as u64);
        let again = || run_again(&plan, &stored, self.tolerance, &progress);
        let sample = self.threads.pool()?.install(again);
        progress.finish_and_clear();
        let found = conditioning(&compared, &sample);
        let compared_runs: u64 = found.iter().map(|group| group.runs).sum();
        if compared_runs < sample.len() as u64 {
            let failed = sample.len() as u64 - compared_runs;
            eprintln!("mrbd: {failed} of them failed and are not compared");
        }
        output::print(&table(&compared, &found))
    }

    fn check_tolerance(&self, plan: &Plan) -> Result<()> {
        let Some(tolerance) = self.tolerance else { return Ok(()) };
        let tightest = plan.variants().map(|v| v.assumptions.tolerance).fold(f64::INFINITY, f64::min);
        if (*Accuracy::TOLERANCES.start()..tightest).contains(&tolerance) {
            return Ok(());
        }
        let allowed =
            format!("{:e} or more, and below the study's {tightest:e}", Accuracy::TOLERANCES.start());
        Err(InputError::option("--tolerance", format!("{tolerance:e}"), allowed).into())
    }
}

fn table(compared: &Compared, found: &[Conditioning]) -> String {
    let mut head = ["variant", "floor", "runs", "ill-conditioned", "95 % interval", "other outcome"]
        .map(str::to_owned)
        .to_vec();
    for name in compared.numbers {
        head.extend([format!("median {name}"), "tighter".to_owned()]);
    }
    let percent = |x: f64| format!("{:.1} %", 100.0 * x);
    let rows = found.iter().map(|group| {
        let [share, low, high] =
            group.share().map_or(["-"; 3].map(str::to_owned), |shares| shares.map(percent));
        let mut row = vec![group.variant.clone(), group.configuration.clone(), group.runs.to_string()];
        row.extend([share, format!("{low} to {high}"), group.other_outcome.to_string()]);
        let cell = |median: &Option<f64>| median.map_or("beyond".to_owned(), |value| format!("{value:.5}"));
        row.extend(group.medians.iter().flatten().map(cell));
        row
    });
    let lines: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    let note = format!(
        "ill-conditioned: another outcome, or a number that differs by more than {} %",
        100.0 * MOVED_SHARE
    );
    format!("{}\n{note}", aligned(&lines))
}

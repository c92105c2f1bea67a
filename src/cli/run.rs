//! `mrbd run`: a study from its pipeline to its medians.

use std::io::{BufWriter, Write};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::output;
use crate::batch::{self, Finished, Tally};
use crate::error::{Error, InputError, Result};
use crate::input::pipeline::Pipeline;
use crate::overturning;
use crate::plan::Plan;
use crate::simulate::simulate;
use crate::store::{COLUMNS, Manifest, OutputFolder, RunSink, Stage, print_csv};

/// The whole study is one part.
const ONLY_SHARD: u32 = 1;

/// Failed runs that are told one by one; all are counted, and stored with their reasons.
const FAILURES_TOLD: usize = 10;

/// Runs a study: plans it, runs it on all threads, stores every run, prints medians and findings.
#[derive(Debug, Args)]
pub struct RunCommand {
    /// Pipeline file (TOML) that says what to run.
    pipeline: PathBuf,
    /// Folder for the results; without it outputs/<name of the pipeline>.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the list of runs with all their inputs as CSV, and run nothing.
    #[arg(long)]
    dry_run: bool,
    /// Suite of records instead of the pipeline's.
    #[arg(long, value_name = "FILE")]
    suite: Option<PathBuf>,
    /// Threads; without it one for each processor. Results do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<NonZero<usize>>,
    /// Replace the results of an earlier study in the folder.
    #[arg(long)]
    force: bool,
}

impl RunCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the pipeline and what it names, and of the output folder; [`Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        if let Some(study) = overturning::Study::load(&self.pipeline)? {
            return self.overturning(&study);
        }
        if crate::comparison::is_comparison(&self.pipeline)? {
            return super::compare_models::execute(
                &self.pipeline,
                self.suite.as_deref(),
                self.out.as_deref(),
            );
        }
        let pipeline = Pipeline::load(&self.pipeline)?;
        let plan = Plan::load(&pipeline, self.suite.as_deref())?;
        if self.dry_run {
            return output::to_stdout(|out| print_plan(&plan, out));
        }
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&pipeline.name));
        let manifest = Manifest::of(&plan, &pipeline, self.suite.as_deref().unwrap_or(&pipeline.suite))?;
        let folder = OutputFolder::prepare(&out, &manifest, &pipeline.text, self.force)?;
        self.run(&plan, &folder)?;
        super::aggregate::aggregate_and_print(&out)
    }

    /// An overturning spectrum: a study of one wall under pulses, without survey and suite.
    fn overturning(&self, study: &overturning::Study) -> Result<()> {
        let refused = [("--suite", self.suite.is_some()), ("--dry-run", self.dry_run)];
        if let Some((option, _)) = refused.into_iter().find(|(_, given)| *given) {
            let allowed = "left out: an overturning spectrum has pulses for records and a grid for a plan";
            return Err(InputError::option(option, "given", allowed).into());
        }
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&study.name));
        overturning::prepare(&out)?;
        let progress = batch::progress_bar(study.frequency_over_p.values().len() as u64);
        let threads =
            rayon::ThreadPoolBuilder::new().num_threads(self.threads.map_or(0, NonZero::get)).build();
        let threads = threads.map_err(|e| InputError::option("--threads", e.to_string(), "fewer threads"))?;
        let spectrum = threads.install(|| overturning::spectrum(study, || progress.inc(1)))?;
        progress.finish_and_clear();
        overturning::store(&out, study, &spectrum)?;
        eprintln!("mrbd: trials.parquet and boundaries.parquet in {}", out.display());
        output::print(&overturning::picture(&spectrum))
    }

    fn run(&self, plan: &Plan, folder: &OutputFolder) -> Result<()> {
        let threads = self.threads.or(std::thread::available_parallelism().ok()).map_or(1, NonZero::get);
        eprintln!(
            "mrbd: {} runs of {:?} under suite {:?} on {threads} thread(s) into {}",
            plan.len(),
            plan.name(),
            plan.motions().suite.name,
            folder.path().display()
        );
        let start = Instant::now();
        let progress = batch::progress_bar(plan.len());
        let mut sink = RunSink::new(folder, ONLY_SHARD);
        let mut failures = 0;
        let keep = |block: Vec<Finished>| {
            progress.suspend(|| tell_failures(&block, &mut failures));
            sink.keep(&block)
        };
        let tally = batch::run_batch(plan, 0..plan.len(), threads, &simulate, keep, &progress)?;
        sink.finish()?;
        progress.finish_and_clear();
        report(tally, start.elapsed().as_secs_f64());
        Ok(())
    }
}

/// Says which runs failed and why, up to [`FAILURES_TOLD`].
fn tell_failures(block: &[Finished], told: &mut usize) {
    let failed = block.iter().filter_map(|finished| Some((&finished.run, finished.failure.as_ref()?)));
    for (run, reason) in failed.take(FAILURES_TOLD - *told) {
        eprintln!(
            "mrbd: run {} ({}) under record {} failed: {reason}",
            run.position,
            run.id,
            run.record().name
        );
        *told += 1;
    }
}

fn report(tally: Tally, seconds: f64) {
    let runs = tally.stood + tally.collapsed + tally.failed;
    eprintln!(
        "mrbd: {runs} runs in {seconds:.1} s, {:.0} a second: {} stood, {} collapsed, {} failed",
        runs as f64 / seconds.max(f64::MIN_POSITIVE),
        tally.stood,
        tally.collapsed,
        tally.failed
    );
}

/// Every run with every input, by the columns of the result files.
fn print_plan(plan: &Plan, out: &mut dyn Write) -> Result<()> {
    let inputs = COLUMNS.iter().filter(|column| column.stage == Stage::Input);
    let mut broken = None;
    let rows = (0..plan.len()).map_while(|position| match plan.run(position) {
        Ok(run) => Some(Finished { run, response: None, failure: None }),
        Err(e) => {
            broken = Some(Error::Plan { position, message: e.to_string() });
            None
        }
    });
    print_csv(&mut BufWriter::new(out), inputs, rows).map_err(output::failed)?;
    broken.map_or(Ok(()), Err)
}

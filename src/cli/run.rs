//! `mrbd run`: a study from its pipeline to its medians.

use std::io::{BufWriter, Write};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::threads::Threads;
use super::{output, progress, stop};
use crate::classics::overturning;
use crate::error::{Error, InputError, Result};
use crate::study::batch::{Finished, SideBySide, Tally};
use crate::study::campaign::{Block, Layout, Shard, Standing, Work, run_missing};
use crate::study::pipeline::Pipeline;
use crate::study::plan::Plan;
use crate::survey::sampling::Sampling;

use crate::store::{Stage, WholeFolder, print_csv};
use crate::study::runs::{COLUMNS, Earlier, Manifest, OutputFolder};

/// Failed runs that are told one by one; all are counted, and stored with their reasons.
const FAILURES_TOLD: usize = 10;

/// Run a study: plan it, run it on all threads, store every run, print medians and findings.
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
    #[command(flatten)]
    threads: Threads,
    /// Replace the results of an earlier study in the folder.
    #[arg(long, conflicts_with_all = ["resume", "shard"])]
    force: bool,
    /// Go on with a study that was stopped: do only what is missing or damaged.
    #[arg(long)]
    resume: bool,
    /// Do part I of N and leave the rest to other processes, on any machines that share the folder; what is finished
    /// is not done again. `auto` reads I and N from SLURM_ARRAY_TASK_ID and _COUNT, or JOB_COMPLETION_INDEX and
    /// JOB_COMPLETIONS. `mrbd merge DIR` puts the parts together.
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Runs stored at once: a stop by force loses those at work, a few of these blocks. Without it 512 to 8192, by the size of the study.
    #[arg(long, value_name = "N")]
    block_runs: Option<NonZero<u64>>,
}

impl RunCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the pipeline and what it names, and of the output folder; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn execute(self) -> Result<()> {
        if let Some(study) = overturning::Study::load(&self.pipeline)? {
            return self.overturning(&study);
        }
        if crate::classics::comparison::is_comparison(&self.pipeline)? {
            self.refuse_parts("a comparison of models has a few runs, done at once")?;
            let out = self.out.as_deref();
            let compare =
                || super::compare_models::execute(&self.pipeline, self.suite.as_deref(), out, self.force);
            return self.threads.pool()?.install(compare);
        }
        let pipeline = Pipeline::load(&self.pipeline)?;
        let plan = Plan::load(&pipeline, self.suite.as_deref())?;
        if self.dry_run {
            return output::to_stdout(|out| print_plan(&plan, out));
        }
        let shard = self.shard()?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&pipeline.name));
        let suite = self.suite.as_deref().unwrap_or(&pipeline.suite);
        let manifest = Manifest::of(&plan, &pipeline, suite, self.block_runs)?;
        let folder = OutputFolder::prepare(&out, &manifest, &pipeline.text, self.earlier())?;
        self.run(&plan, &folder, shard.unwrap_or(Shard::WHOLE))?;
        if shard.is_none() {
            // From this thread, which stored the blocks: its memory serves again.
            self.threads.take()?;
            return super::merge::merge_and_print(&folder);
        }
        eprintln!("mrbd: `mrbd merge {}` puts the parts together when all are done", out.display());
        Ok(())
    }

    fn shard(&self) -> Result<Option<Shard>> {
        match self.shard.as_deref() {
            None => Ok(None),
            Some("auto") => Shard::of_scheduler(|name| std::env::var(name).ok()).map(Some),
            Some(text) => text.parse().map(Some),
        }
    }

    fn earlier(&self) -> Earlier {
        match (&self.shard, self.resume, self.force) {
            (Some(_), _, _) => Earlier::Share,
            (None, true, _) => Earlier::Resume,
            (None, false, true) => Earlier::Replace,
            (None, false, false) => Earlier::Refuse,
        }
    }

    /// Options of plans, for what has none.
    fn refuse_parts(&self, why: &str) -> Result<(), InputError> {
        let options =
            [("--dry-run", self.dry_run), ("--shard", self.shard.is_some()), ("--resume", self.resume)];
        match options.into_iter().find(|(_, given)| *given) {
            Some((option, _)) => Err(InputError::option(option, "given", format!("left out: {why}"))),
            None => Ok(()),
        }
    }

    /// An overturning spectrum: a study of one wall under pulses, without survey and suite.
    fn overturning(&self, study: &overturning::Study) -> Result<()> {
        let why = "an overturning spectrum has pulses for records and a grid for a plan";
        if self.suite.is_some() {
            return Err(InputError::option("--suite", "given", format!("left out: {why}")).into());
        }
        self.refuse_parts(why)?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&study.name));
        let folder = WholeFolder::check(&out, &overturning::FILES, self.force)?;
        let progress = progress::of_runs(study.frequency_over_p.values().len() as u64);
        let spectrum = self.threads.pool()?.install(|| overturning::spectrum(study, || progress.inc(1)))?;
        progress.finish_and_clear();
        overturning::store(folder.cleared()?, study, &spectrum)?;
        eprintln!("mrbd: trials.parquet and boundaries.parquet in {}", out.display());
        output::print(&overturning::picture(&spectrum))
    }

    fn run(&self, plan: &Plan, folder: &OutputFolder, shard: Shard) -> Result<()> {
        let pool = self.threads.pool()?;
        let layout = Layout::of(folder.manifest());
        let standing = pool.install(|| Standing::of(folder, &layout))?;
        tell_standing(plan, folder, &standing, &layout);
        let todo = |block: &Block| shard.has(block.index) && !standing.has(block);
        let missing = layout.iter().filter(todo).map(|block| block.runs.end - block.runs.start).sum();
        eprintln!("mrbd: {missing} runs to do on {} thread(s)", pool.current_num_threads());
        let stop = stop::on_signals()?;
        let start = Instant::now();
        let progress = progress::of_runs(missing);
        let mut failures = 0;
        let watch = |runs: &[Finished]| progress.suspend(|| tell_failures(runs, &mut failures));
        let work = Work {
            plan,
            folder,
            shard,
            pool: &pool,
            simulate: &SideBySide,
            stop: &stop,
            progress: &progress,
        };
        let tally = run_missing(&work, &standing, watch).inspect_err(|_| self.tell_again(folder.path()))?;
        progress.finish_and_clear();
        report(tally, start.elapsed().as_secs_f64());
        match tally.runs() == missing {
            true => Ok(()),
            false => Err(Error::Stopped { done: tally.runs(), missing, again: self.again(folder.path()) }),
        }
    }

    fn tell_again(&self, out: &Path) {
        eprintln!("mrbd: what was finished is stored; to go on when the fault is gone: {}", self.again(out));
    }

    /// The command that goes on where this one was stopped.
    fn again(&self, out: &Path) -> String {
        let mut command = format!("mrbd run {} --out {}", self.pipeline.display(), out.display());
        if let Some(suite) = &self.suite {
            command += &format!(" --suite {}", suite.display());
        }
        if let Some(block_runs) = self.block_runs {
            command += &format!(" --block-runs {block_runs}");
        }
        match &self.shard {
            Some(shard) => command + " --shard " + shard,
            None => command + " --resume",
        }
    }
}

fn tell_standing(plan: &Plan, folder: &OutputFolder, standing: &Standing, layout: &Layout) {
    let (suite, path) = (&plan.motions().suite.name, folder.path().display());
    eprintln!("mrbd: {} runs of {:?} under suite {suite:?} into {path}", plan.len(), plan.name());
    if let Some(drawn) = plan.drawn() {
        let Sampling { count, seed, design, .. } = drawn.sampling;
        eprintln!("mrbd: {count} façades, drawn {} from seed {seed}", design.name());
    }
    for (configuration, variable, probability) in plan.truncated() {
        let (floor, percent) = (configuration.name(), 100.0 * probability);
        eprintln!("mrbd: truncation leaves out {percent:.4} % of {}, {floor} floor", variable.name());
    }
    for damaged in &standing.damaged {
        eprintln!("mrbd: {} is damaged, or its checksum is gone; its runs are done again", damaged.display());
    }
    match standing.runs(layout) {
        0 => {}
        done => eprintln!("mrbd: {done} of them are done already"),
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
    let runs = tally.runs();
    let before = match tally.collapsed_before {
        0 => String::new(),
        fallen => format!(", {fallen} found the wall fallen"),
    };
    eprintln!(
        "mrbd: {runs} runs in {seconds:.1} s, {:.0} a second: {} stood, {} collapsed, {} failed{before}",
        runs as f64 / seconds.max(f64::MIN_POSITIVE),
        tally.stood,
        tally.collapsed,
        tally.failed
    );
}

/// Every run with every input, by the columns of the result files.
fn print_plan(plan: &Plan, out: &mut dyn Write) -> Result<()> {
    let inputs = COLUMNS.iter().filter(|column| column.stage == Stage::Input);
    let rows = (0..plan.len()).map(|position| Finished::planned(plan.run(position)));
    print_csv(&mut BufWriter::new(out), inputs, rows).map_err(output::failed)
}

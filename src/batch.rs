//! Many runs: spread over threads, handed on in order, none lost.
//!
//! Threads take runs as they come free, but results leave in the order of the plan, so nothing that is written
//! depends on the number of threads. Only a block of results is held at a time, and no histories.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use rayon::prelude::*;

use crate::error::{Error, InputError, Result};
use crate::model::Wall;
use crate::plan::{Plan, Run};
use crate::simulate::{Accuracy, Outcome, Response, Shaking};

/// Runs handed on at once: a few seconds of work, so that threads seldom wait for the end of a block,
/// and a few megabytes of results.
const BLOCK: u64 = 4096;

/// A run and what came of it.
#[derive(Debug, Clone)]
pub struct Finished {
    /// What was run.
    pub run: Run,
    /// What the run told; none where the program itself failed.
    pub response: Option<Response>,
    /// Why there is no usable response; none where there is one.
    pub failure: Option<String>,
}

impl Finished {
    /// The response of a run that was carried to its end, standing or collapsed.
    pub fn usable(&self) -> Option<&Response> {
        self.response.as_ref().filter(|_| self.failure.is_none())
    }

    /// `stood`, `collapsed` or `failed`.
    pub fn outcome(&self) -> &'static str {
        self.usable().map_or("failed", |response| response.outcome.name())
    }
}

/// How many runs ended how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Stood to the end.
    pub stood: u64,
    /// Collapsed.
    pub collapsed: u64,
    /// Could not be finished.
    pub failed: u64,
}

impl Tally {
    fn count(&mut self, finished: &Finished) {
        match finished.outcome() {
            "stood" => self.stood += 1,
            "collapsed" => self.collapsed += 1,
            _ => self.failed += 1,
        }
    }
}

/// Runs the runs at `positions` of a plan on `threads` threads and hands them on in blocks, in order.
///
/// `simulate` runs one wall; it is a parameter so that a batch can be tested without the cost.
/// `keep` receives every run, failed and collapsed ones too.
///
/// # Errors
/// Whatever `keep` meets; an input error if the threads cannot be had.
pub fn run_batch<S, K>(
    plan: &Plan,
    positions: Range<u64>,
    threads: usize,
    simulate: &S,
    mut keep: K,
    progress: &ProgressBar,
) -> Result<Tally>
where
    S: Fn(&Wall, &Shaking, Accuracy) -> Response + Sync,
    K: FnMut(Vec<Finished>) -> Result<()>,
{
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| {
        InputError::option("--threads", e.to_string(), "a number of threads the system grants")
    })?;
    let mut tally = Tally::default();
    let mut start = positions.start;
    while start < positions.end {
        let end = positions.end.min(start + BLOCK);
        let block = pool.install(|| run_block(plan, start..end, simulate, progress))?;
        block.iter().for_each(|finished| tally.count(finished));
        keep(block)?;
        start = end;
    }
    Ok(tally)
}

fn run_block<S>(
    plan: &Plan,
    positions: Range<u64>,
    simulate: &S,
    progress: &ProgressBar,
) -> Result<Vec<Finished>>
where
    S: Fn(&Wall, &Shaking, Accuracy) -> Response + Sync,
{
    positions
        .into_par_iter()
        .map(|position| {
            let run = plan.run(position).map_err(|e| Error::Plan { position, message: e.to_string() })?;
            let finished = run_one(run, simulate);
            progress.inc(1);
            Ok(finished)
        })
        .collect()
}

/// Runs one run; a panic of the simulator is a failure of this run, not of the study.
pub fn run_one<S>(run: Run, simulate: &S) -> Finished
where
    S: Fn(&Wall, &Shaking, Accuracy) -> Response,
{
    let shaking = run.shaking();
    let outcome = catch_unwind(AssertUnwindSafe(|| simulate(&run.wall, &shaking, run.accuracy())));
    match outcome {
        Ok(response) => Finished { failure: fault_of(&response), response: Some(response), run },
        Err(panic) => Finished { run, response: None, failure: Some(message_of(panic.as_ref())) },
    }
}

/// Why a response cannot be used; none where it can.
fn fault_of(response: &Response) -> Option<String> {
    if let Outcome::Failed { reason, .. } = &response.outcome {
        return Some(reason.clone());
    }
    let values = [
        response.theta_max_rad[0].value,
        response.theta_max_rad[1].value,
        response.top_displacement_m.value,
        response.energy.residual(),
    ];
    let finite = values.iter().all(|value| value.is_finite());
    (!finite).then(|| "a result is not a finite number".to_owned())
}

fn message_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("panicked: {}", text.unwrap_or("without a message"))
}

/// A bar on stderr with rate and time left; silent where stderr is not a terminal.
pub fn progress_bar(runs: u64) -> ProgressBar {
    let style = ProgressStyle::with_template(
        "{bar:30} {human_pos}/{human_len} runs  {rate}  {elapsed_precise} gone, {eta_precise} left",
    );
    // A template that does not parse would be a slip of this file; the plain bar then does.
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        // A text that cannot take a number has nowhere to say so.
        let _ = write!(out, "{:.0} a second", state.per_sec());
    };
    ProgressBar::new(runs).with_style(style.with_key("rate", rate))
}

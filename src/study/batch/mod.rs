//! Many runs: spread over threads, handed on in order, none lost.
//!
//! Threads take runs as they come free, but results leave in the order of the plan, so nothing that is written
//! depends on the number of threads. No histories are held.

mod growing;
mod side_by_side;

use std::panic::{AssertUnwindSafe, catch_unwind};

use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::study::plan::{Plan, Run};
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking, simulate};

/// A run and what came of it.
#[derive(Debug, Clone)]
pub struct Finished {
    /// What was run.
    pub run: Run,
    /// What the run told; none where the program itself failed.
    pub response: Option<Response>,
    /// Why there is no usable response; none where there is one.
    pub failure: Option<String>,
    /// Simulations it took: none of a façade that is no wall, several of an incremental analysis.
    pub simulations: u64,
    /// What an incremental analysis found beside its last run.
    pub found: Option<Found>,
}

/// What an incremental analysis found; the run and its response are those at the intensity it ended with: the lowest
/// found to exceed the limit, or the last one where none did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Whether the limit was exceeded.
    pub exceeded: bool,
    /// Highest intensity below that at which it was not.
    pub stood_intensity: f64,
}

impl Finished {
    /// A run that nothing came of yet.
    pub fn planned(run: Run) -> Self {
        Self { run, response: None, failure: None, simulations: 0, found: None }
    }

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
    /// All of them.
    pub fn runs(self) -> u64 {
        self.stood + self.collapsed + self.failed
    }

    /// Counts these runs too.
    pub fn count(&mut self, runs: &[Finished]) {
        for finished in runs {
            match finished.outcome() {
                "stood" => self.stood += 1,
                "collapsed" => self.collapsed += 1,
                _ => self.failed += 1,
            }
        }
    }
}

/// What simulates walls: a closure for one wall, so that a batch can be tested without the cost, or [`SideBySide`].
pub trait Simulate {
    /// Simulates one wall.
    fn one(&self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Response;

    /// Whether [`simulate`] of several walls side by side is the same.
    fn goes_side_by_side(&self) -> bool {
        false
    }
}

impl<F: Fn(&Wall, &Shaking, Accuracy) -> Response> Simulate for F {
    fn one(&self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Response {
        self(wall, shaking, accuracy)
    }
}

/// [`simulate`], of several walls side by side where there are several; the responses have the same bits.
#[derive(Debug, Clone, Copy)]
pub struct SideBySide;

impl Simulate for SideBySide {
    fn one(&self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Response {
        simulate(wall, shaking, accuracy)
    }

    fn goes_side_by_side(&self) -> bool {
        true
    }
}

/// Runs the runs at `positions` of a plan on the threads of the current pool: one result a position, in order,
/// failed and collapsed ones too. Neighbouring positions mostly share the record.
pub fn run_all(
    plan: &Plan,
    positions: Vec<u64>,
    simulate: &(impl Simulate + Sync),
    progress: &ProgressBar,
) -> Vec<Finished> {
    if simulate.goes_side_by_side() {
        return side_by_side::run_all(plan, &positions, progress);
    }
    let one = |position| {
        let finished = run_one(plan.run(position), simulate);
        progress.inc(1);
        finished
    };
    positions.into_par_iter().map(one).collect()
}

/// Runs one run; a façade that is no wall, or a panic of the simulator, is a failure of this run, not of the study.
pub fn run_one(run: Run, simulate: &impl Simulate) -> Finished {
    let planned = Finished::planned(run);
    let outcome = catch_unwind(AssertUnwindSafe(|| match planned.run.growth() {
        None => single(planned.clone(), simulate),
        Some(&growth) => growing::search(planned.clone(), growth, |finished| single(finished, simulate)),
    }));
    outcome.unwrap_or_else(|panic| Finished { failure: Some(message_of(panic.as_ref())), ..planned })
}

/// Simulates a run at the factor it is at.
fn single(finished: Finished, simulate: &impl Simulate) -> Finished {
    let run = &finished.run;
    let wall = match &run.wall {
        Ok(wall) => wall,
        Err(impossible) => return Finished { failure: Some(format!("no wall: {impossible}")), ..finished },
    };
    let response = simulate.one(wall, &run.shaking(), run.accuracy());
    answered(finished, response)
}

/// A run with its response.
fn answered(finished: Finished, response: Response) -> Finished {
    let simulations = finished.simulations + 1;
    Finished { failure: fault_of(&response), response: Some(response), simulations, ..finished }
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

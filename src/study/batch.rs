//! Many runs: spread over threads, handed on in order, none lost.
//!
//! Threads take runs as they come free, but results leave in the order of the plan. So nothing that is written depends on
//! the number of threads. No histories are held. A thread takes the next run as soon as a lane is free. An incremental
//! analysis is runs at growing intensities, until one exceeds a limit.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::chain;
use super::ladder::Search;
use super::pipeline::{Limit, Variant};
use super::plan::{Growth, Plan, Run};
use super::shared::{Share, run_shared};
use indicatif::ProgressBar;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Outcome, Prepared, Response, Shaking, Simulator, Start, simulate};

/// A run, of a plan or told otherwise, and what came of it.
#[derive(Debug, Clone)]
pub struct Finished<R = Run> {
    /// What was run.
    pub run: R,
    /// What the run told; none where the program itself failed.
    pub response: Option<Response>,
    /// Why there is no usable response; none where there is one.
    pub failure: Option<String>,
    /// Simulations it took: none of a façade that is no wall, several of an incremental analysis.
    pub simulations: u64,
    /// What an incremental analysis found beside its last run.
    pub found: Option<Found>,
    /// Part of the sequence, from 0, in which the wall had fallen before that of the run began.
    pub fell_in: Option<usize>,
}

/// The outcome of a part of a sequence that found the wall fallen.
pub const COLLAPSED_BEFORE: &str = "collapsed before";

/// What an incremental analysis found; the run and its response are those at the intensity it ended with: the lowest
/// found to exceed the limit, or the last one where none did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Whether the limit was exceeded.
    pub exceeded: bool,
    /// Highest intensity below that at which it was not.
    pub stood_intensity: f64,
}

impl<R> Finished<R> {
    /// A run that nothing came of yet.
    pub fn planned(run: R) -> Self {
        Self { run, response: None, failure: None, simulations: 0, found: None, fell_in: None }
    }

    /// The response of a run that was carried to its end, standing or collapsed.
    pub fn usable(&self) -> Option<&Response> {
        self.response.as_ref().filter(|_| self.failure.is_none())
    }

    /// `stood`, `collapsed` or `failed`; `collapsed before` of a part of a sequence that found the wall fallen.
    pub fn outcome(&self) -> &'static str {
        if self.fell_in.is_some() {
            return COLLAPSED_BEFORE;
        }
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
    /// Found the wall fallen in an earlier part of the sequence.
    pub collapsed_before: u64,
}

impl Tally {
    /// All of them.
    pub fn runs(self) -> u64 {
        self.stood + self.collapsed + self.failed + self.collapsed_before
    }

    /// Counts these runs too.
    pub fn count(&mut self, runs: &[Finished]) {
        for finished in runs {
            match finished.outcome() {
                "stood" => self.stood += 1,
                "collapsed" => self.collapsed += 1,
                COLLAPSED_BEFORE => self.collapsed_before += 1,
                _ => self.failed += 1,
            }
        }
    }
}

/// What simulates walls: a closure for one wall, so that a batch can be tested without the cost, or [`SideBySide`].
pub trait Simulate {
    /// Simulates one wall.
    fn one(&self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Response;

    /// Simulates one wall from where an earlier run left it.
    fn from(&self, wall: &Wall, shaking: &Shaking, accuracy: Accuracy, start: &Start) -> Response {
        let simulator = Simulator::new(wall, shaking, accuracy);
        simulator.run_from(start, simulator.end_s(), &mut ())
    }

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

/// Runs at these positions of a plan, and what came of them.
struct Listed {
    positions: Vec<u64>,
    next: AtomicUsize,
    done: Mutex<Vec<(usize, Finished)>>,
}

impl Share for Listed {
    fn next(&self) -> Option<(usize, u64)> {
        let number = self.next.fetch_add(1, Ordering::Relaxed);
        Some((number, *self.positions.get(number)?))
    }

    fn done(&self, number: usize, finished: Finished) {
        self.done.lock().unwrap_or_else(PoisonError::into_inner).push((number, finished));
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
    if plan.sequences().len() > 0 {
        return chain::run_chains(plan, &positions, simulate, progress);
    }
    let done = Mutex::new(Vec::with_capacity(positions.len()));
    let listed = Listed { positions, next: AtomicUsize::new(0), done };
    run_shared(plan, &listed, simulate, progress);
    let mut done = listed.done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_unstable_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, finished)| finished).collect()
}

/// Runs one run; a façade that is no wall, or a panic of the simulator, is a failure of this run, not of the study.
pub fn run_one(run: Run, simulate: &impl Simulate) -> Finished {
    if run.sequence.is_some() {
        return chain::run_part(&run, simulate);
    }
    let planned = Finished::planned(run);
    let outcome = catch_unwind(AssertUnwindSafe(|| match planned.run.growth() {
        None => single(planned.clone(), simulate),
        Some(&growth) => search_growing(planned.clone(), growth, |finished| single(finished, simulate)),
    }));
    outcome.unwrap_or_else(|panic| Finished { failure: Some(message_of(panic.as_ref())), ..planned })
}

/// Simulates a run at the factor it is at.
pub(super) fn single(finished: Finished, simulate: &impl Simulate) -> Finished {
    let run = &finished.run;
    let wall = match &run.wall {
        Ok(wall) => wall,
        Err(impossible) => return Finished { failure: Some(format!("no wall: {impossible}")), ..finished },
    };
    let response = simulate.one(wall, &run.shaking(), run.accuracy());
    answered(finished, response)
}

/// A run with its response.
pub(super) fn answered<R>(finished: Finished<R>, response: Response) -> Finished<R> {
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

pub(super) fn message_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("panicked: {}", text.unwrap_or("without a message"))
}

/// Searches from a run that is at no intensity yet; `simulate` runs it at the factor it is at.
fn search_growing(
    planned: Finished,
    growth: Growth,
    mut simulate: impl FnMut(Finished) -> Finished,
) -> Finished {
    let measures = planned.run.record().intensity;
    let mut simulations = 0;
    let mut at = |intensity: f64| {
        let mut trial = planned.clone();
        trial.run.factor = growth.measure.factor_to(&measures, intensity);
        trial.simulations = simulations;
        let finished = simulate(trial);
        simulations = finished.simulations;
        finished
    };
    let mut judged = |intensity: f64| {
        let trial = at(intensity);
        exceeds(growth.limit, &trial).map(|exceeded| (exceeded, trial))
    };
    let ended = ended(growth.ladder().first_exceeding(&mut judged));
    // All simulations count, those after the one that is kept too.
    Finished { simulations, ..ended }
}

/// A run that ends the search before a bracket is found: it failed.
type Failed = Box<Finished>;

/// The run at the lowest intensity found to exceed the limit, at the last one where none did, or one that failed.
fn ended(search: Result<Search<Finished>, Failed>) -> Finished {
    let found = |exceeded, stood_intensity| Some(Found { exceeded, stood_intensity });
    match search {
        Err(failed) => *failed,
        Ok(Search::Exceeded { below, trial, .. }) => Finished { found: found(true, below), ..trial },
        Ok(Search::Stood { at, trial }) => Finished { found: found(false, at), ..trial },
        Ok(Search::Always { trial }) => {
            let reason = "the limit is exceeded at however low an intensity".to_owned();
            Finished { failure: Some(reason), ..trial }
        }
    }
}

/// Whether a run exceeded the limit; a run that failed ends the search.
fn exceeds(limit: Limit, trial: &Finished) -> Result<bool, Failed> {
    let Some(response) = trial.usable() else { return Err(Box::new(trial.clone())) };
    Ok(limit.exceeded_by(response))
}

/// The motion of a run, told by where it comes from.
pub(super) struct MotionOf {
    variant: Arc<Variant>,
    record_index: usize,
    factor: f64,
}

impl MotionOf {
    fn run(run: &Run) -> Self {
        let (variant, record_index, factor) = (Arc::clone(&run.variant), run.record_index, run.factor);
        Self { variant, record_index, factor }
    }

    /// Whether a run has this motion: scaled samples, of a member too, need not be scaled again.
    fn shakes(&self, run: &Run) -> bool {
        Arc::ptr_eq(&self.variant, &run.variant)
            && (self.record_index, self.factor) == (run.record_index, run.factor)
    }
}

/// Makes a run of a plan ready; `motion` is that of the run before.
pub(super) fn prepare_run(run: &Run, motion: &mut Option<MotionOf>, ready: &mut Ready) -> Option<Prepared> {
    let (wall, accuracy) = (run.wall.as_ref().ok()?, run.accuracy());
    let shaking = match (&*motion, &*ready) {
        (Some(motion), Some((shaking, _))) if motion.shakes(run) => shaking.clone(),
        _ => run.shaking(),
    };
    *motion = Some(MotionOf::run(run));
    Some(prepare(wall, shaking, accuracy, ready))
}

/// A shaking that was made ready, with a wall.
pub(super) type Ready = Option<(Shaking, Simulator)>;

/// Makes a run ready; the samples of the run before serve again where the shaking is the same.
pub(super) fn prepare(wall: &Wall, shaking: Shaking, accuracy: Accuracy, ready: &mut Ready) -> Prepared {
    let simulator = match ready {
        Some((before, simulator)) if before.shares_samples_with(&shaking) => {
            simulator.with_wall(wall, accuracy)
        }
        _ => Simulator::new(wall, &shaking, accuracy),
    };
    let prepared = simulator.prepared();
    *ready = Some((shaking, simulator));
    prepared
}

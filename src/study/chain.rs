//! Runs of sequences: each part starts where the one before left the wall.
//!
//! The parts of a wall go one after another on one thread, alone. A part tells the same whatever else of its sequence
//! is asked for: the parts before it are run in any case.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::batch::{Finished, Simulate, answered, message_of, single};
use super::plan::{Plan, Run};
use indicatif::ProgressBar;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Response, Start, following};
use rayon::prelude::*;

/// Runs the runs at `positions` of a plan of sequences: one result a position, in order.
pub(super) fn run_chains(
    plan: &Plan,
    positions: &[u64],
    simulate: &(impl Simulate + Sync),
    progress: &ProgressBar,
) -> Vec<Finished> {
    let of_one_wall = |a: &u64, b: &u64| a / plan.rows() == b / plan.rows();
    let chains: Vec<&[u64]> = positions.chunk_by(of_one_wall).collect();
    let run = |positions: &&[u64]| {
        let mut chain = Chain { simulate, parts: Vec::new() };
        let one = |&position| {
            let finished = chain.finished(&plan.run(position));
            progress.inc(1);
            finished
        };
        positions.iter().map(one).collect::<Vec<_>>()
    };
    chains.par_iter().flat_map_iter(run).collect()
}

/// Runs one row of a sequence, and the parts before it.
pub(super) fn run_part(run: &Run, simulate: &impl Simulate) -> Finished {
    Chain { simulate, parts: Vec::new() }.finished(run)
}

/// The parts of a sequence on one wall, as far as they are run.
struct Chain<'a, S> {
    simulate: &'a S,
    parts: Vec<Finished>,
}

impl<S: Simulate> Chain<'_, S> {
    /// A row; a panic of the simulator is a failure of this row, and of the parts that follow it.
    fn finished(&mut self, run: &Run) -> Finished {
        if run.sequence.as_ref().is_some_and(|(_, place)| place.alone) {
            return self.guarded(run.clone(), |planned| single(planned, self.simulate));
        }
        for part in self.parts.len()..=run.parts_before() {
            let next = run.part_before(part);
            let before = self.parts.last();
            let finished = self.guarded(next, |planned| self.next(planned, before));
            self.parts.push(finished);
        }
        self.parts[run.parts_before()].clone()
    }

    fn guarded(&self, run: Run, simulate: impl FnOnce(Finished) -> Finished) -> Finished {
        let planned = Finished::planned(run);
        let done = catch_unwind(AssertUnwindSafe(|| simulate(planned.clone())));
        done.unwrap_or_else(|panic| Finished { failure: Some(message_of(panic.as_ref())), ..planned })
    }

    /// The part that follows another, or the first.
    fn next(&self, planned: Finished, before: Option<&Finished>) -> Finished {
        let Some(before) = before else { return single(planned, self.simulate) };
        let part = planned.run.parts_before();
        if let Some(reason) = &before.failure {
            let failure = Some(format!("part {part} failed: {reason}"));
            return Finished { failure, ..planned };
        }
        let left = before.usable().and_then(|response| Some((response, following(response)?)));
        match left {
            None => Finished { fell_in: before.fell_in.or(Some(part - 1)), ..planned },
            Some((response, start)) => self.from(planned, &before.run, response, &start),
        }
    }

    /// Runs a part on the wall that the one before left standing.
    fn from(&self, planned: Finished, before: &Run, response: &Response, start: &Start) -> Finished {
        let run = match left_standing(before, response) {
            Ok(wall) => Run { wall: Ok(wall), ..planned.run.clone() },
            Err(reason) => return Finished { failure: Some(reason), ..planned },
        };
        let Ok(wall) = &run.wall else { return planned };
        let response = self.simulate.from(wall, &run.shaking(), run.accuracy(), start);
        answered(Finished { run, ..planned }, response)
    }
}

/// The wall after a part: as it was, or with corners that stay crushed.
fn left_standing(before: &Run, response: &Response) -> Result<Wall, String> {
    let wall = before.wall.as_ref().map_err(|impossible| format!("no wall: {impossible}"))?;
    if !before.variant.assumptions.crushing_stays {
        return Ok(wall.clone());
    }
    let compression_n = response.demand.map(|demand| demand.compression_n);
    before.facade.crushed(wall, compression_n).map_err(|impossible| format!("no wall after it: {impossible}"))
}

//! Runs of a plan side by side: every thread takes the next run as soon as a lane is free.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::ProgressBar;

use super::{Finished, SideBySide, answered, run_one};
use crate::study::plan::Plan;
use mrbd_kernel::simulate::{Prepared, Shaking, Simulator, simulate_side_by_side};

/// As [`super::run_all`].
pub(super) fn run_all(plan: &Plan, positions: &[u64], progress: &ProgressBar) -> Vec<Finished> {
    let next = AtomicUsize::new(0);
    let done = rayon::broadcast(|_| {
        let lane = Thread { plan, positions, next: &next, progress, done: RefCell::default() };
        lane.run();
        lane.done.into_inner()
    });
    let mut done: Vec<(usize, Finished)> = done.into_iter().flatten().collect();
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, finished)| finished).collect()
}

/// What one thread does.
struct Thread<'a> {
    plan: &'a Plan,
    positions: &'a [u64],
    /// Index of the position that is next, of all threads.
    next: &'a AtomicUsize,
    progress: &'a ProgressBar,
    done: RefCell<Vec<(usize, Finished)>>,
}

impl Thread<'_> {
    fn run(&self) {
        loop {
            // Runs that have begun and not ended.
            let at_work = RefCell::new(BTreeSet::new());
            let all = catch_unwind(AssertUnwindSafe(|| self.run_side_by_side(&at_work)));
            if all.is_ok() {
                return;
            }
            // One of them panics: each once more, alone, to tell which; the thread then goes on.
            for index in at_work.into_inner() {
                self.finish(index, run_one(self.plan.run(self.positions[index]), &SideBySide));
            }
        }
    }

    fn run_side_by_side(&self, at_work: &RefCell<BTreeSet<usize>>) {
        let mut ready: Option<(Shaking, Simulator)> = None;
        let next = || {
            loop {
                let index = self.next.fetch_add(1, Ordering::Relaxed);
                let run = self.plan.run(*self.positions.get(index)?);
                at_work.borrow_mut().insert(index);
                if run.growth().is_some() || run.wall.is_err() {
                    // Searches go step by step; a façade that is no wall has nothing to run.
                    at_work.borrow_mut().remove(&index);
                    self.finish(index, run_one(run, &SideBySide));
                    continue;
                }
                let prepared = prepare(&run, &mut ready)?;
                return Some(((index, Finished::planned(run)), prepared));
            }
        };
        simulate_side_by_side(next, |(index, finished), response| {
            at_work.borrow_mut().remove(&index);
            self.finish(index, answered(finished, response));
        });
    }

    fn finish(&self, index: usize, finished: Finished) {
        self.done.borrow_mut().push((index, finished));
        self.progress.inc(1);
    }
}

/// Makes a run ready; the samples of the run before serve again where the shaking is the same.
fn prepare(run: &crate::study::plan::Run, ready: &mut Option<(Shaking, Simulator)>) -> Option<Prepared> {
    let (wall, shaking, accuracy) = (run.wall.as_ref().ok()?, run.shaking(), run.accuracy());
    let simulator = match ready {
        Some((before, simulator)) if before.shares_samples_with(&shaking) => {
            simulator.with_wall(wall, accuracy)
        }
        _ => Simulator::new(wall, &shaking, accuracy),
    };
    let prepared = simulator.prepared();
    *ready = Some((shaking, simulator));
    Some(prepared)
}

//! Runs that threads share: each takes the next as it comes free, and goes on with several side by side.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::batch::{Finished, Ready, SideBySide, Simulate, answered, prepare_run, run_one};
use super::plan::Plan;
use indicatif::ProgressBar;
use mrbd_kernel::simulate::simulate_side_by_side;

/// Runs that threads share: each takes the next as it comes free.
pub(super) trait Share: Sync {
    /// Number of the run that is next, and its position in the plan.
    fn next(&self) -> Option<(usize, u64)>;

    /// Takes what came of a run.
    fn done(&self, number: usize, finished: Finished);
}

/// Runs what the threads of the current pool share, of a plan without sequences, until there is no more.
pub(super) fn run_shared<S: Simulate + Sync>(
    plan: &Plan,
    share: &impl Share,
    simulate: &S,
    progress: &ProgressBar,
) {
    rayon::broadcast(|_| {
        let thread = Thread { plan, share, progress };
        match simulate.goes_side_by_side() {
            true => thread.run_side_by_side(),
            false => thread.run_one_by_one(simulate),
        }
    });
}

/// What one thread does.
struct Thread<'a, S> {
    plan: &'a Plan,
    share: &'a S,
    progress: &'a ProgressBar,
}

impl<S: Share> Thread<'_, S> {
    fn run_one_by_one(&self, simulate: &impl Simulate) {
        while let Some((number, position)) = self.share.next() {
            self.finish(number, run_one(self.plan.run(position), simulate));
        }
    }

    fn run_side_by_side(&self) {
        loop {
            // Runs that have begun and not ended, by their number.
            let at_work = RefCell::new(BTreeMap::new());
            let all = catch_unwind(AssertUnwindSafe(|| self.run_rows(&at_work)));
            if all.is_ok() {
                return;
            }
            // One of them panics: each once more, alone, to tell which; the thread then goes on.
            for (number, finished) in at_work.into_inner() {
                self.finish(number, run_one(finished.run, &SideBySide));
            }
        }
    }

    fn run_rows(&self, at_work: &RefCell<BTreeMap<usize, Finished>>) {
        let mut ready: Ready = None;
        let mut motion = None;
        let mut next = || {
            loop {
                let (number, position) = self.share.next()?;
                let run = self.plan.run(position);
                if run.growth().is_some() || run.wall.is_err() {
                    // Searches go step by step; a façade that is no wall has nothing to run.
                    self.finish(number, run_one(run, &SideBySide));
                    continue;
                }
                // Noted before it is made ready, which may panic.
                let mut at_work = at_work.borrow_mut();
                let planned = at_work.entry(number).or_insert(Finished::planned(run));
                return Some((number, prepare_run(&planned.run, &mut motion, &mut ready)?));
            }
        };
        simulate_side_by_side(&mut next, &mut |number, response| {
            if let Some(finished) = at_work.borrow_mut().remove(&number) {
                self.finish(number, answered(finished, response));
            }
        });
    }

    fn finish(&self, number: usize, finished: Finished) {
        self.share.done(number, finished);
        self.progress.inc(1);
    }
}

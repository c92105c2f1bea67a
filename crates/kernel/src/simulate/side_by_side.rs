//! Runs side by side: those that request a step of the same kind take it together, in vector lanes.
//!
//! The response of a run does not depend on those beside it. Every lane does the sums that the run would do
//! alone.

use fearless_simd::Level;

use super::history::Observer;
use super::lane_steps::steps;
use super::response::Response;
use super::run::Run;
use crate::model::{LANES, LaneKind, Reactions};

/// Runs in the pool at once: enough that mostly there are as many of a kind as lanes.
const AT_ONCE: usize = 6 * LANES;

/// A wall under a shaking, ready to run beside others from a time in seconds on.
pub struct Prepared<O = ()> {
    run: Run<O>,
    start_s: f64,
    /// Why it cannot start.
    refused: Option<String>,
}

impl<O: Observer> Prepared<O> {
    pub(super) fn new(run: Run<O>, start_s: f64, refused: Option<String>) -> Self {
        Self { run, start_s, refused }
    }

    fn begun(mut self) -> Run<O> {
        match self.refused {
            None => self.run.begin(self.start_s),
            Some(reason) => self.run.refuse(self.start_s, reason),
        }
        self.run
    }

    /// Runs it alone.
    pub(super) fn run_alone(self) -> Response {
        self.begun().into_response()
    }
}

/// Runs what `next` gives side by side until it gives no more. `done` gets each response with its number, as runs end.
///
/// A response is that of [`super::simulate`] to the bit, whatever runs beside it.
pub fn simulate_side_by_side(
    next: &mut dyn FnMut() -> Option<(usize, Prepared)>,
    done: &mut dyn FnMut(usize, Response),
) {
    simulate_side_by_side_at(Level::new(), next, done);
}

/// The same by given vector instructions, which change nothing but the time it takes.
pub fn simulate_side_by_side_at(
    level: Level,
    next: &mut dyn FnMut() -> Option<(usize, Prepared)>,
    done: &mut dyn FnMut(usize, Response),
) {
    Pool::new(level, next, done).all();
}

/// The same of runs that are watched.
pub fn simulate_watched_side_by_side<'o>(
    next: &mut dyn FnMut() -> Option<(usize, Prepared<&'o mut dyn Observer>)>,
    done: &mut dyn FnMut(usize, Response),
) {
    Pool::new(Level::new(), next, done).all();
}

/// Runs at work. Its loop is compiled here, in one unit with the motion, for watched runs and for others.
struct Pool<'w, O> {
    next: &'w mut dyn FnMut() -> Option<(usize, Prepared<O>)>,
    done: &'w mut dyn FnMut(usize, Response),
    slots: Vec<Option<(usize, Run<O>)>>,
    /// Slots that request a step, by its kind.
    queues: [Vec<usize>; LaneKind::ALL.len()],
    /// Vector instructions that this processor has.
    level: Level,
}

impl<'w, O: Observer> Pool<'w, O> {
    fn new(
        level: Level,
        next: &'w mut dyn FnMut() -> Option<(usize, Prepared<O>)>,
        done: &'w mut dyn FnMut(usize, Response),
    ) -> Self {
        let queues = LaneKind::ALL.map(|_| Vec::with_capacity(AT_ONCE));
        Self { next, done, slots: Vec::with_capacity(AT_ONCE), queues, level }
    }

    fn all(&mut self) {
        while self.slots.len() < AT_ONCE {
            let Some(run) = self.begin_next() else { break };
            self.slots.push(Some(run));
            self.queue_step(self.slots.len() - 1);
        }
        while self.step() {}
    }

    #[inline(never)]
    fn begin_next(&mut self) -> Option<(usize, Run<O>)> {
        let (number, prepared) = (self.next)()?;
        Some((number, prepared.begun()))
    }

    /// Brings the run in a slot, or the next one there, to a request that others may share.
    fn queue_step(&mut self, slot: usize) {
        while let Some((_, run)) = &mut self.slots[slot] {
            if !run.needs_step() {
                self.replace(slot);
                continue;
            }
            match run.step_request().motion.side_by_side() {
                Some(kind) => return self.queues[kind.index()].push(slot),
                None => {
                    let mut reactions = Reactions::default();
                    let step = run.step_request().take(&mut reactions);
                    run.finish_step(&step, &reactions);
                }
            }
        }
    }

    /// Ends the run in a slot and begins the next one there.
    #[inline(never)]
    fn replace(&mut self, slot: usize) {
        if let Some((number, run)) = self.slots[slot].take() {
            (self.done)(number, run.end());
        }
        self.slots[slot] = self.begin_next();
    }

    /// Takes the steps of the kind that most slots request; false when there is no request.
    fn step(&mut self) -> bool {
        let lengths = self.queues.each_ref().map(Vec::len);
        let longer = |most: LaneKind, kind: LaneKind| lengths[kind.index()] > lengths[most.index()];
        let kind =
            LaneKind::ALL.into_iter().reduce(|most, kind| if longer(most, kind) { kind } else { most });
        let Some(kind) = kind else { return false };
        let queue = &mut self.queues[kind.index()];
        let from = queue.len().saturating_sub(LANES);
        let Some(&last) = queue.last() else { return false };
        // A lane without a run does the work of another once more.
        let mut of = [last; LANES];
        let count = queue.len() - from;
        of[..count].copy_from_slice(&queue[from..]);
        queue.truncate(from);
        let requests = of.map(|slot| {
            let Some((_, run)) = &self.slots[slot] else { unreachable!("a slot that asks has a run") };
            run.step_request()
        });
        let taken = steps(self.level, kind, &requests);
        for (slot, (step, reactions)) in of.into_iter().zip(&taken).take(count) {
            if let Some((_, run)) = &mut self.slots[slot] {
                run.finish_step(step, reactions);
            }
            self.queue_step(slot);
        }
        true
    }
}

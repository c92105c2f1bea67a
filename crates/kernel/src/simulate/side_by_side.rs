//! Runs side by side: those that request a step of the same kind take it together, in vector lanes.
//!
//! The response of a run does not depend on those beside it. Every lane does the sums that the run would do
//! alone.

use fearless_simd::Level;

use super::alone::to_its_end;
use super::history::Observer;
use super::lane_steps::{advance, widest};
use super::response::Response;
use super::row::Row;
use super::run::Run;
use crate::instructions::lanes_pay;
use crate::lanes::LANES;
use crate::model::{Contact, LaneKind, Reactions, Regime};

/// Runs in the pool at once, beside each lane: enough that mostly there are as many of a kind as lanes.
const PER_LANE: usize = 6;

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
        to_its_end(self.begun())
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
    /// Slots that wait for a step, by its kind.
    queues: [Vec<usize>; LaneKind::ALL.len()],
    /// Walls that step together, by the kind of their step.
    rows: [Aboard; LaneKind::ALL.len()],
    /// Vector instructions that this processor has, and whether walls go side by side by them.
    level: Level,
    lanes_pay: bool,
    /// How many walls step side by side.
    lanes: usize,
}

/// A row and the slots of the runs in it, with the branch of the laws in which they boarded.
#[derive(Default)]
struct Aboard {
    row: Box<Row>,
    slots: [Option<usize>; LANES],
    /// Of those whose laws have branches.
    regimes: [Regime; LANES],
}

impl Aboard {
    fn count(&self) -> usize {
        self.row.taken.count_ones() as usize
    }

    fn board<O: Observer>(&mut self, i: usize, slot: usize, run: &Run<O>) {
        run.board(&mut self.row, i);
        self.take(i, slot, run);
    }

    /// A run that comes back to its lane, where all but its contact state and what moves is there already if its laws are as they
    /// were.
    fn board_again<O: Observer>(&mut self, i: usize, slot: usize, run: &Run<O>, before: Contact) {
        if run.regime().is_some_and(|regime| regime != self.regimes[i]) {
            return self.board(i, slot, run);
        }
        match run.contact() == before {
            true => run.board_again(&mut self.row, i),
            false => run.board_contact(&mut self.row, i),
        }
        self.take(i, slot, run);
    }

    fn take<O: Observer>(&mut self, i: usize, slot: usize, run: &Run<O>) {
        self.row.taken |= 1 << i;
        self.slots[i] = Some(slot);
        if let Some(regime) = run.regime() {
            self.regimes[i] = regime;
        }
    }
}

impl<'w, O: Observer> Pool<'w, O> {
    fn new(
        level: Level,
        next: &'w mut dyn FnMut() -> Option<(usize, Prepared<O>)>,
        done: &'w mut dyn FnMut(usize, Response),
    ) -> Self {
        let lanes_pay = lanes_pay(level);
        let lanes = if lanes_pay { widest(level) } else { 1 };
        let at_once = || Vec::with_capacity(PER_LANE * lanes);
        let (slots, queues) = (Vec::with_capacity(PER_LANE * lanes), LaneKind::ALL.map(|_| at_once()));
        Self { next, done, slots, queues, rows: Default::default(), level, lanes_pay, lanes }
    }

    fn all(&mut self) {
        while self.slots.len() < PER_LANE * self.lanes {
            let Some(run) = self.begin_next() else { break };
            self.slots.push(Some(run));
            self.queue_step(self.slots.len() - 1);
        }
        while let Some(kind) = self.most_wanted() {
            self.step_row(kind);
        }
    }

    #[inline(never)]
    fn begin_next(&mut self) -> Option<(usize, Run<O>)> {
        let (number, mut prepared) = (self.next)()?;
        if !self.lanes_pay {
            prepared.run.set_level(self.level);
        }
        Some((number, prepared.begun()))
    }

    fn queue_step(&mut self, slot: usize) {
        if let Some(kind) = self.next_kind(slot) {
            self.queues[kind.index()].push(slot);
        }
    }

    /// Brings the run in a slot, or the next one there, to a request that others may share: its kind. `None` where no run is left.
    fn next_kind(&mut self, slot: usize) -> Option<LaneKind> {
        while let Some((_, run)) = &mut self.slots[slot] {
            if !run.needs_step() {
                self.replace(slot);
                continue;
            }
            let kind = if self.lanes_pay { run.step_request().motion.side_by_side() } else { None };
            match kind {
                Some(kind) => return Some(kind),
                None => {
                    run.step_alone(&mut Reactions::default());
                }
            }
        }
        None
    }

    /// Ends the run in a slot and begins the next one there.
    #[inline(never)]
    fn replace(&mut self, slot: usize) {
        if let Some((number, run)) = self.slots[slot].take() {
            (self.done)(number, run.end());
        }
        self.slots[slot] = self.begin_next();
    }

    /// The kind of step that most runs wait for, those aboard counted; `None` when none does.
    fn most_wanted(&self) -> Option<LaneKind> {
        let wanted = |kind: &LaneKind| self.queues[kind.index()].len() + self.rows[kind.index()].count();
        LaneKind::ALL.into_iter().filter(|kind| wanted(kind) > 0).max_by_key(wanted)
    }

    /// Steps the row of a kind for as long as it is full, or once.
    fn step_row(&mut self, kind: LaneKind) {
        loop {
            self.fill(kind);
            let row = &mut self.rows[kind.index()].row;
            let left = advance(self.level, kind, row);
            let shown = std::mem::take(&mut row.shown);
            for i in 0..self.lanes {
                if left >> i & 1 == 1 {
                    self.attend(kind, i);
                } else if shown >> i & 1 == 1 {
                    self.show(kind, i);
                }
            }
            if self.rows[kind.index()].count() + self.queues[kind.index()].len() < self.lanes {
                return;
            }
        }
    }

    /// Lets runs that wait board the free lanes of a row.
    fn fill(&mut self, kind: LaneKind) {
        for i in 0..self.lanes {
            if self.rows[kind.index()].slots[i].is_some() {
                continue;
            }
            let Some(slot) = self.queues[kind.index()].pop() else { return };
            let Some((_, run)) = &self.slots[slot] else { unreachable!("a slot that asks has a run") };
            let aboard = &mut self.rows[kind.index()];
            aboard.row.watched = run.is_watched();
            aboard.board(i, slot, run);
        }
    }

    /// Shows a step that was kept in a lane to whoever watches the run.
    fn show(&mut self, kind: LaneKind, i: usize) {
        let Aboard { row, slots, .. } = &mut self.rows[kind.index()];
        let Some(slot) = slots[i] else { return };
        let Some((_, run)) = &mut self.slots[slot] else { return };
        if run.is_watched_on(row, i) {
            return;
        }
        slots[i] = None;
        row.taken &= !(1 << i);
        self.queue_step(slot);
    }

    /// Goes through what happened to the run in a lane, and lets it or another one board there.
    fn attend(&mut self, kind: LaneKind, i: usize) {
        let Aboard { row, slots, .. } = &mut self.rows[kind.index()];
        let Some(slot) = slots[i] else { return };
        let mut in_lane = Contact::REST;
        if let Some((_, run)) = &mut self.slots[slot] {
            let Some(contact) = run.goes_through(row, i) else { return };
            slots[i] = None;
            in_lane = contact;
        }
        let number = |pool: &Self| pool.slots[slot].as_ref().map(|(number, _)| *number);
        let before = number(self);
        let next = self.next_kind(slot);
        let same = number(self) == before;
        let aboard = &mut self.rows[kind.index()];
        aboard.row.taken &= !(1 << i);
        match (next, &self.slots[slot]) {
            (Some(next), Some((_, run))) if next == kind => match same {
                true => aboard.board_again(i, slot, run, in_lane),
                false => aboard.board(i, slot, run),
            },
            (Some(next), _) => self.queues[next.index()].push(slot),
            (None, _) => {}
        }
    }
}

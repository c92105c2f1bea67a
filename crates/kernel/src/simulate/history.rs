//! Watching a run: the rotations at every sample of the record.

use crate::model::{Contact, Pair};
use crate::solver::Quintic;

/// Receives every stretch of a run that it wants, in order.
pub trait Observer {
    /// The wall moved in a contact state from a time in seconds, along a quintic.
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic);
    /// The wall was at rest from one time to another, s.
    fn stood(&mut self, from_s: f64, to_s: f64);
    /// The run ended.
    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair);
    /// Whether it watches at all.
    fn watches(&self) -> bool {
        true
    }
    /// Stretches that end by this time, s, need not be shown; minus infinity: every one is. They may be shown all the same.
    fn wants_from_s(&self) -> f64 {
        f64::NEG_INFINITY
    }
    /// Whether the rest of the run is not worth its time; checked at every sample of the record. The response
    /// is then that of the part that was run.
    fn seen_enough(&self) -> bool {
        false
    }
}

impl<O: Observer + ?Sized> Observer for &mut O {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        (**self).moved(start_s, contact, motion);
    }

    fn stood(&mut self, from_s: f64, to_s: f64) {
        (**self).stood(from_s, to_s);
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        (**self).ended(time_s, contact, theta);
    }

    fn watches(&self) -> bool {
        (**self).watches()
    }

    fn wants_from_s(&self) -> f64 {
        (**self).wants_from_s()
    }

    fn seen_enough(&self) -> bool {
        (**self).seen_enough()
    }
}

/// Watches nothing.
impl Observer for () {
    fn moved(&mut self, _: f64, _: Contact, _: &Quintic) {}
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}

    fn watches(&self) -> bool {
        false
    }
}

/// One row of a history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryRow {
    /// Time, s.
    pub time_s: f64,
    /// Rotations θ_1, θ_2, rad.
    pub theta_rad: Pair,
    /// Contact state from this time on.
    pub contact: Contact,
}

/// Rotations and patterns at every sample, from the start to the end of the run or the collapse.
#[derive(Debug, Clone)]
pub struct History {
    start_s: f64,
    step_s: f64,
    /// The rows, one a sample.
    pub rows: Vec<HistoryRow>,
}

/// A sample within this share of the step of a run's end lies on it: times gather roundings.
const NEAR_END: f64 = 1e-6;

impl History {
    /// An empty history at a step in seconds.
    pub fn new(step_s: f64) -> Self {
        Self::starting(0.0, step_s)
    }

    /// An empty history of a window, its first row at a time, s.
    pub fn starting(start_s: f64, step_s: f64) -> Self {
        Self { start_s, step_s, rows: Vec::new() }
    }

    /// Time between rows, s.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    fn next_s(&self) -> f64 {
        self.start_s + self.rows.len() as f64 * self.step_s
    }

    fn push(&mut self, theta_rad: Pair, contact: Contact) {
        self.rows.push(HistoryRow { time_s: self.next_s(), theta_rad, contact });
    }

    fn samples_before(&self, end_s: f64) -> bool {
        self.next_s() < end_s - NEAR_END * self.step_s
    }
}

impl Observer for History {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        while self.samples_before(start_s + motion.h()) {
            let share = ((self.next_s() - start_s) / motion.h()).clamp(0.0, 1.0);
            self.push(motion.position(share), contact);
        }
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        while self.samples_before(to_s) {
            self.push([0.0, 0.0], Contact::REST);
        }
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        if self.next_s() <= time_s + NEAR_END * self.step_s {
            self.push(theta, contact);
        }
    }
}

//! The ground acceleration as the wall sees it: linear pieces, falling to zero within a step after the last sample.

use std::sync::Arc;

use super::Shaking;
use crate::model::{GroundChange, Vector};

/// Step of a free release, which has no record: its history is written at this step, s.
pub const FREE_RELEASE_STEP_S: f64 = 0.005;

/// A lag this near a whole number of steps, as a share of one, is that number. A quotient has roundings.
const NEAR_WHOLE: f64 = 1e-9;

/// What is left after the last whole step may be a rounding: a share of a step that is no piece of its own.
pub(super) const LEAST_PIECE: f64 = 1e-9;

/// Piecewise linear ground acceleration; cheap to clone, for the samples are shared.
#[derive(Debug, Clone)]
pub(crate) struct GroundPath {
    step_s: f64,
    /// Samples, one zero appended; empty for a free release.
    samples: Arc<[Vector]>,
    /// Time of the first sample, s: within a step before the start of the run.
    origin_s: f64,
    end_s: f64,
}

/// A piece of the path on which the ground acceleration is linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    pub start_s: f64,
    pub length_s: f64,
    pub(super) from: Vector,
    pub(super) slope: Vector,
}

impl Piece {
    /// Ground acceleration at a time after the start of the piece, m/s².
    #[inline(always)]
    pub fn at(&self, offset_s: f64) -> Vector {
        self.from + self.slope * offset_s
    }
}

impl GroundPath {
    pub fn new(shaking: &Shaking) -> Self {
        let Some(horizontal) = &shaking.horizontal else {
            let samples = Arc::new([]);
            return Self { step_s: FREE_RELEASE_STEP_S, samples, origin_s: 0.0, end_s: shaking.tail_s };
        };
        let x = horizontal.acceleration_m_s2();
        let y = shaking.vertical.as_ref().map_or(&[][..], |v| v.acceleration_m_s2());
        let count = x.len().max(y.len()) + 1;
        let sample = |of: &[f64], k: usize| of.get(k).copied().unwrap_or(0.0);
        let samples = (0..count).map(|k| Vector { x: sample(x, k), y: sample(y, k) }).collect();
        let end_s = horizontal.duration_s() + shaking.tail_s;
        Self { step_s: horizontal.step_s(), samples, origin_s: 0.0, end_s }
    }

    /// The ground motion that effects make of this record. A record that comes later makes the run end later,
    /// so that its free motion stays as long.
    #[must_use]
    pub fn changed(&self, change: &GroundChange) -> Self {
        if *change == GroundChange::NONE || self.samples.is_empty() {
            return self.clone();
        }
        let GroundChange { gain, lag_s, vertical_ratio } = *change;
        let shaken = |a: &Vector| Vector { x: gain * a.x, y: gain * (a.y + vertical_ratio * a.x) };
        // Whole steps of quiet before a record that comes later, and whole steps less of one that comes earlier.
        let steps = lag_s / self.step_s;
        let whole = (steps - steps.round()).abs() < NEAR_WHOLE;
        let steps = if whole { steps.round() } else { steps.ceil() };
        let quiet = std::iter::repeat_n(Vector::default(), steps.max(0.0) as usize);
        let passed = (-steps).max(0.0) as usize;
        let samples: Arc<[Vector]> = quiet.chain(self.samples.iter().skip(passed).map(shaken)).collect();
        let origin_s = if whole || samples.is_empty() { 0.0 } else { lag_s - steps * self.step_s };
        Self { samples, origin_s, end_s: self.end_s + lag_s.max(0.0), step_s: self.step_s }
    }

    /// The samples, one zero appended; none of a free release.
    #[inline]
    pub fn samples(&self) -> &[Vector] {
        &self.samples
    }

    /// Puts them where they are looked up. Threads wait for each other to count who has them: not where they are already.
    pub fn share_samples(&self, with: &mut Arc<[Vector]>) {
        if !Arc::ptr_eq(with, &self.samples) {
            *with = Arc::clone(&self.samples);
        }
    }

    /// Time of the first sample, s.
    pub fn origin_s(&self) -> f64 {
        self.origin_s
    }

    /// Time between samples, s.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// End of the run, s.
    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    /// The same path up to another end of the run.
    #[must_use]
    pub fn until(&self, end_s: f64) -> Self {
        Self { end_s, ..self.clone() }
    }

    /// The piece that a time lies in, and the offset in it, s.
    pub fn place(&self, time_s: f64) -> (usize, f64) {
        let last = self.samples.len().max(1) - 1;
        let mut k = (((time_s - self.origin_s) / self.step_s) as usize).min(last);
        // The quotient may round up to the next piece ...
        if self.start_s(k) > time_s {
            k -= 1;
        }
        // ... and what is left of this one may be a rounding.
        if k < last && self.start_s(k + 1) - time_s <= NEAR_WHOLE * self.step_s {
            return (k + 1, 0.0);
        }
        (k, time_s - self.start_s(k))
    }

    /// Ground acceleration at a time, m/s²; zero after the end.
    pub fn at(&self, time_s: f64) -> Vector {
        let (k, offset_s) = self.place(time_s);
        self.piece(k).map_or(Vector::default(), |piece| piece.at(offset_s))
    }

    /// Start of the `k`-th piece, s.
    #[inline]
    pub fn start_s(&self, k: usize) -> f64 {
        (self.origin_s + k as f64 * self.step_s).max(0.0)
    }

    /// How many pieces between samples lie wholly within the run.
    pub fn whole_pieces(&self) -> usize {
        let between_samples = self.samples.len().saturating_sub(1);
        between_samples.min(((self.end_s - self.origin_s) / self.step_s) as usize)
    }

    /// The `k`-th piece: one between samples, and one of no acceleration from the last to the end of the run.
    #[inline]
    pub fn piece(&self, k: usize) -> Option<Piece> {
        let start_s = self.start_s(k);
        let left_s = self.end_s - start_s;
        if left_s <= LEAST_PIECE * self.step_s {
            return None;
        }
        let zero = Vector::default();
        match (self.samples.get(k), self.samples.get(k + 1)) {
            (Some(&from), Some(&to)) => {
                let slope = (to - from) * (1.0 / self.step_s);
                // The first piece may have begun before the run.
                let passed_s = if k == 0 { -self.origin_s } else { 0.0 };
                let length_s = (self.step_s - passed_s).min(left_s);
                Some(Piece { start_s, length_s, from: from + slope * passed_s, slope })
            }
            _ if k + 1 == self.samples.len().max(1) => {
                Some(Piece { start_s, length_s: left_s, from: zero, slope: zero })
            }
            _ => None,
        }
    }

    /// First piece from the `k`-th on whose end does not satisfy `holds`, of the pieces between samples. The
    /// number of these pieces if all ends do.
    #[inline]
    pub fn first_end_against(&self, k: usize, mut holds: impl FnMut(Vector) -> bool) -> usize {
        let ends = self.samples.get(k + 1..).unwrap_or(&[]);
        k + ends.iter().position(|&a| !holds(a)).unwrap_or(ends.len())
    }
}

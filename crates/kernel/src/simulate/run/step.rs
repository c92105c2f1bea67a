//! The step that a run asks for, and how it is taken alone; [`super::super::side_by_side`] takes several.

use fearless_simd::dispatch;
use wide::f64x2;

use super::super::ground_path::Piece;
use crate::model::{Aftermath, Motion, Pair, RatePair, Turned};
use crate::solver::{Field, Nystrom, Point, Rate, Step};

/// A step that a run asks for.
pub(in super::super) struct Asked<'a> {
    pub law: &'a Motion,
    pub piece: &'a Piece,
    pub from_s: f64,
    pub h: f64,
    pub now: &'a Point,
    pub quadrature_rate: Pair,
}

impl Asked<'_> {
    /// Takes the step; tells the joint forces at its end.
    #[inline]
    pub fn take(&self, after: &mut Aftermath) -> Step {
        dispatch!(self.law.level, _ => self.step(after))
    }

    #[inline(always)]
    fn step(&self, after: &mut Aftermath) -> Step {
        let (law, piece, from_s) = (self.law, self.piece, self.from_s);
        let mut shaken = Shaken { law, piece, from_s, posture: Turned::default(), after };
        Nystrom::step(self.now, self.quadrature_rate, self.h, &mut shaken)
    }
}

/// The motion of a contact state under a piece of the record, and what its last landing told.
///
/// Both of the latter where they are: to copy what was just written, wider than it was written, would wait for the writing.
struct Shaken<'a, 'b> {
    law: &'a Motion,
    from_s: f64,
    posture: Turned,
    piece: &'a Piece,
    after: &'b mut Aftermath,
}

impl Field for Shaken<'_, '_> {
    #[inline(always)]
    fn rate(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        let ground = self.piece.at(self.from_s + after_s);
        if self.law.turns_as_one() {
            return as_rate(self.law.monolithic_rate(theta.to_array()[0], omega.to_array()[0], ground));
        }
        self.posture = self.law.turned(theta);
        as_rate(self.law.rate_at(&self.posture, omega, ground))
    }

    #[inline(always)]
    fn land(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        // The posture of the last stage serves again, for the joint forces too.
        if self.law.turns_as_one() {
            self.posture = self.law.turned(theta);
        }
        let (rate, after) = self.law.arrival(&self.posture, omega, self.piece.at(self.from_s + after_s));
        *self.after = after;
        as_rate(rate)
    }
}

#[inline(always)]
fn as_rate(rate: RatePair) -> Rate {
    Rate { acceleration: rate.theta_dd, quadrature: rate.powers_w }
}

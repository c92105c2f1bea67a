//! The step that a run requests, and how it is taken alone; [`super::super::side_by_side`] takes several.

use wide::f64x2;

use super::super::ground_path::Piece;
use crate::instructions::dispatch;
use crate::model::{BeddedMotion, Configuration, Motion, MotionRate, Pair, Pose, RatePair, Reactions};
use crate::solver::{Field, Nystrom, Point, Rate, Step};

/// A step that a run requests.
pub(in super::super) struct StepRequest<'a> {
    pub motion: &'a Motion,
    pub piece: &'a Piece,
    pub from_s: f64,
    pub h: f64,
    pub now: &'a Point,
    pub quadrature_rate: Pair,
}

impl StepRequest<'_> {
    /// Takes the step, and writes the reactions at its end.
    #[inline]
    pub fn take(&self, reactions: &mut Reactions) -> Step {
        if let Some(bedded) = self.motion.on_beds() {
            return dispatch!(self.motion.level, _ => self.step_on_beds(bedded, reactions));
        }
        dispatch!(self.motion.level, _ => self.step(reactions))
    }

    #[inline(always)]
    fn step_on_beds(&self, bedded: &BeddedMotion, reactions: &mut Reactions) -> Step {
        let (motion, piece, from_s) = (self.motion, self.piece, self.from_s);
        let mut shaken = BeddedField { motion, bedded, from_s, piece, pose: None, reactions };
        Nystrom::step(self.now, self.quadrature_rate, self.h, &mut shaken)
    }

    #[inline(always)]
    fn step(&self, reactions: &mut Reactions) -> Step {
        let (motion, piece, from_s) = (self.motion, self.piece, self.from_s);
        let mut shaken =
            ShakenMotion { motion, piece, from_s, configuration: Configuration::default(), reactions };
        Nystrom::step(self.now, self.quadrature_rate, self.h, &mut shaken)
    }
}

/// The motion of a contact state under a piece of the record, and the reactions at the step's end.
///
/// Both of the latter stay where they are. A copy of what was just written, wider than it was written, would
/// wait for the writing.
struct ShakenMotion<'a, 'b> {
    motion: &'a Motion,
    from_s: f64,
    configuration: Configuration,
    piece: &'a Piece,
    reactions: &'b mut Reactions,
}

impl Field for ShakenMotion<'_, '_> {
    #[inline(always)]
    fn rate(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        let ground = self.piece.at(self.from_s + after_s);
        if self.motion.turns_as_one() {
            return as_rate(self.motion.monolithic_rate(theta.to_array()[0], omega.to_array()[0], ground));
        }
        self.configuration = self.motion.configuration(theta);
        as_rate(self.motion.rate_at(&self.configuration, omega, ground))
    }

    #[inline(always)]
    fn land(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        // The configuration of the last stage serves again, for the joint forces too.
        if self.motion.turns_as_one() {
            self.configuration = self.motion.configuration(theta);
        }
        let (rate, reactions) =
            self.motion.rate_and_reactions(&self.configuration, omega, self.piece.at(self.from_s + after_s));
        *self.reactions = reactions;
        as_rate(rate)
    }
}

/// The motion of a wall whose joints give.
struct BeddedField<'a, 'b> {
    motion: &'a Motion,
    bedded: &'a BeddedMotion,
    from_s: f64,
    piece: &'a Piece,
    /// That of the last stage, whose positions are those of the end.
    pose: Option<Pose>,
    reactions: &'b mut Reactions,
}

impl Field for BeddedField<'_, '_> {
    #[inline(always)]
    fn rate(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        let ground = self.piece.at(self.from_s + after_s);
        let moving = [theta.to_array(), omega.to_array()];
        from_motion(self.bedded.rate(self.motion, moving, ground, &mut self.pose).into())
    }

    fn land(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        let ground = self.piece.at(self.from_s + after_s);
        let moving = [theta.to_array(), omega.to_array()];
        let (rate, reactions) = self.bedded.rate_and_reactions(self.motion, moving, ground, &mut self.pose);
        *self.reactions = reactions;
        from_motion(rate.into())
    }
}

fn from_motion(rate: MotionRate) -> Rate {
    let powers = [rate.ground_power_w, rate.loss_power_w];
    Rate { acceleration: f64x2::new(rate.theta_dd), quadrature: f64x2::new(powers) }
}

#[inline(always)]
fn as_rate(rate: RatePair) -> Rate {
    Rate { acceleration: rate.theta_dd, quadrature: rate.powers_w }
}

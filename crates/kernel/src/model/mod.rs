//! The mechanics of a wall of one or two rocking bodies; knows no files and no integrator.
//!
//! A [`Wall`] is geometry, masses, restraint and impact law, checked once. A [`RockingWall`] is a wall ready to move:
//! for each [`Contact`] state its equations of motion ([`RockingWall::rate`]), the forces through its joints
//! ([`RockingWall::joint_forces`]), where it goes when a joint opens ([`RockingWall::settle`]) and what an impact does
//! ([`RockingWall::impact`]). Axes: x out of the wall's plane, y up; rotations are absolute, clockwise positive, zero at rest.

mod balance;
mod contact;
mod crushing;
mod effect;
mod held_top;
mod impact;
mod joint;
mod laws;
mod mass_matrix;
mod motion;
mod pace;
mod posture;
mod pushed;
mod restrained;
mod restraint;
mod rocking;
mod side_by_side;
mod vector;
mod wall;

pub(crate) use balance::Aftermath;
pub use contact::{Contact, Joint, PATTERN_NAMES, Pivot, Touching};
pub use crushing::crushed_widths_m;
pub(crate) use effect::GroundChange;
pub use effect::{
    Effect, EffectChoice, EffectEntry, EffectError, EffectKind, EffectParameter, EffectVariant, Lanes, Place,
    Quantity, Reading, Role,
};
pub use impact::Impact;
pub use joint::{JointForce, JointForces};
pub use motion::MotionRate;
pub(crate) use motion::{Motion, RatePair, Turned};
pub use posture::Pair;
pub(crate) use restraint::Kink;
pub use restraint::{Regime, Side};
pub(crate) use rocking::opening;
pub use rocking::{RockingWall, State};
pub(crate) use side_by_side::{AftermathLanes, LANES, Motions, TurnedLanes, lanes};
pub use vector::Vector;
pub use wall::{G_M_S2, ImpactLaw, ImpossibleWall, Restitution, Wall, WallParameters};

/// A rule of the mechanics was broken: a defect of the program, to report and not to hide.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MechanicsError {
    /// No contact state, or more than one, is admissible after an impact.
    #[error(
        "{count} admissible outcomes of an impact in pattern {from}, where there must be exactly one \
         (ground {}, crack {}, θ {:?} rad, θ' {:?} rad/s)",
        touching.told(touching.ground), touching.told(touching.crack), state.theta, state.omega
    )]
    ImpactOutcomes {
        /// Pattern before the impact.
        from: &'static str,
        /// Joints that touch.
        touching: Touching,
        /// Rotations and velocities before.
        state: State,
        /// How many were admissible.
        count: usize,
    },
    /// No contact state carries the joint forces.
    #[error("no contact state carries the joint forces in pattern {from}")]
    NoContactState {
        /// Pattern before.
        from: &'static str,
    },
}

/// A change of pattern of Table 2, by the number of its coefficient; mirrored changes count as the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table2Change(u8);

impl Table2Change {
    /// Position of C_l in the list of coefficients, 0 to 7.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

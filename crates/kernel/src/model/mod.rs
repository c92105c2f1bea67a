//! The mechanics of a wall of one or two rocking bodies; knows no files and no integrator.
//!
//! A [`Wall`] is geometry, masses, restraint and impact law, checked once. A [`RockingWall`] is a wall ready
//! to move. For each [`Contact`] state it has the equations of motion ([`RockingWall::rate`]) and the forces
//! through the joints ([`RockingWall::joint_forces`]). It gives the contact state after an opening
//! ([`RockingWall::next_contact`]) and after an impact ([`RockingWall::impact`]). Axes: x out of the wall's
//! plane, y up; rotations are absolute, clockwise positive, zero at rest.

mod bed;
mod bedded_lanes;
mod contact;
mod crack_impact;
mod effect;
mod formula;
mod geometry;
mod impact;
mod impact_lanes;
mod joint_forces;
mod lane_laws;
mod laws;
mod mass_matrix;
mod motion;
mod motion_energy;
mod motion_row;
mod next_contact;
pub(crate) mod number;
mod parameters;
mod regime;
mod rocking;
mod sharp;
mod side_by_side;
mod strike_row;
mod top;
mod vector;
mod wall;
mod whole_impact;

pub use bed::{Bed, CrushingJoint, JointLaw, RoundedEdges, TrilinearJoint};
pub(crate) use bed::{BeddedMotion, Branch, Pose};
pub(crate) use bedded_lanes::BeddedMotions;
pub use contact::{Contact, Joint, PATTERN_NAMES, Pivot, Touching};
pub(crate) use crack_impact::CrackRow;
pub(crate) use effect::GroundChange;
pub use effect::{
    Effect, EffectChoice, EffectEntry, EffectError, EffectKind, EffectParameter, EffectVariant, FurtherLaw,
    Lanes, Place, Quantity, Reading, Role,
};
pub use formula::{CarriedStates, MOST_CARRIED, TopMove};
pub(crate) use formula::{Path, TopSides, Turn};
pub use geometry::Pair;
pub use impact::Impact;
pub(crate) use joint_forces::Reactions;
pub use joint_forces::{JointForce, JointForces};
pub(crate) use lane_laws::LaneKind;
pub(crate) use mass_matrix::Freedom;
pub use motion::MotionRate;
pub(crate) use motion::{Motion, RatePair};
pub(crate) use motion_row::{MotionRow, PivotRow};
pub(crate) use next_contact::Carried;
pub use parameters::{ImpactLaw, Restitution, WallParameters};
pub(crate) use regime::Kink;
pub use regime::{Regime, Side, TopMemory};
pub(crate) use rocking::opening;
pub use rocking::{RockingWall, State};
pub(crate) use sharp::Configuration;
pub(crate) use sharp::SharpMotion;
pub(crate) use side_by_side::{Motions, RateLanes, ReactionLanes, sin_cos_lanes};
pub(crate) use strike_row::StrikeRow;
pub use vector::Vector;
pub use wall::{G_M_S2, ImpossibleWall, Wall, crushed_widths_m};

/// A rule of the mechanics was broken: a defect of the program, to report and not to hide.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MechanicsError {
    /// No contact state, or more than one, is admissible after an impact.
    #[error(
        "{count} admissible outcomes of an impact in pattern {from}, where there must be exactly one \
         (ground {}, crack {}, θ {:?} rad, θ' {:?} rad/s)",
        touching.word(touching.ground), touching.word(touching.crack), state.theta, state.omega
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

//! The equations of motion of the walls on beds of a row, with the laws at the top, in vector lanes.

use super::bed::{BeddedMotion, JointLanes, Pose};
use super::lane_laws::LawLanes;
use super::mass_matrix::Freedom;
use super::motion_row::MotionRow;
use super::side_by_side::{RateLanes, ReactionLanes};
use super::vector::Vector;
use crate::lanes::Wide;

/// The motions of several walls on beds side by side, all with the same rotations free.
pub(crate) struct BeddedMotions<F: Wide> {
    equations: BeddedMotion<F, JointLanes<F>>,
    laws: LawLanes<F, true>,
}

impl<F: Wide> BeddedMotions<F> {
    #[inline(always)]
    pub fn new(simd: F::Token, row: &mut MotionRow, freedom: Freedom) -> Self {
        Self {
            equations: BeddedMotion::of_row(simd, &row.beds, freedom),
            laws: LawLanes::new(simd, &mut row.laws),
        }
    }

    /// Puts back what [`BeddedMotions::new`] took out of the row.
    #[inline(always)]
    pub fn put_back(self, row: &mut MotionRow) {
        self.laws.put_back(&mut row.laws);
    }

    #[inline(always)]
    pub fn pose(&self, theta: [F; 2]) -> Pose<F> {
        self.equations.pose(theta)
    }

    /// Displacement of the top in a pose, m.
    #[inline(always)]
    pub fn top_displacement_m(&self, pose: &Pose<F>) -> F {
        self.equations.top_of(pose)
    }

    /// The rate in a pose at rotations and velocities.
    #[inline(always)]
    pub fn rate(&self, pose: &Pose<F>, moving: [[F; 2]; 2], [x, y]: [F; 2]) -> RateLanes<F> {
        let balance = self.equations.balance_in(pose, &self.laws, false, moving, Vector { x, y });
        RateLanes { theta_dd: balance.theta_dd, powers_w: balance.powers_w }
    }

    /// The same with the reactions.
    #[inline(always)]
    pub fn rate_and_reactions(
        &self,
        pose: &Pose<F>,
        moving: [[F; 2]; 2],
        [x, y]: [F; 2],
    ) -> (RateLanes<F>, ReactionLanes<F>) {
        let balance = self.equations.balance_in(pose, &self.laws, false, moving, Vector { x, y });
        let reactions = ReactionLanes::of(&self.equations.reactions_by(pose, &balance, balance.theta_dd));
        (RateLanes { theta_dd: balance.theta_dd, powers_w: balance.powers_w }, reactions)
    }
}

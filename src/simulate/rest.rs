//! Rest: the ground acceleration at which a wall that stands still starts to move.
//!
//! At rest every corner force is linear in the ground acceleration, so the record can be searched sample by sample
//! without integrating, and the instant inside a sample is exact.

use super::ground_path::Piece;
use crate::model::{Contact, RockingWall, State, Vector};

/// Corner forces at rest over the wall's weight: `x` times a_x plus `y` times a_y plus `standing`.
#[derive(Debug, Clone, Copy)]
struct CornerForce {
    x: f64,
    y: f64,
    standing: f64,
}

impl CornerForce {
    #[inline]
    fn at(&self, ground: Vector) -> f64 {
        self.x * ground.x + self.y * ground.y + self.standing
    }
}

/// When a wall at rest moves, and what it asks of friction while it stands.
#[derive(Debug, Clone)]
pub(crate) struct RestLimits {
    /// At the ground, left and right, then at the crack; a crack that is not there never lifts.
    corners: [CornerForce; 4],
    /// Mass that pushes sideways over mass that presses down, at the ground and at the crack.
    sideways_over_down: [f64; 2],
}

impl RestLimits {
    pub fn new(wall: &RockingWall) -> Self {
        let forces_under =
            |ground: Vector| wall.joint_forces(Contact::REST, &State::default(), [0.0, 0.0], ground);
        let [still, pushed, pulled, lifted] =
            [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)].map(|(x, y)| forces_under(Vector { x, y }));
        let mut corners = [CornerForce { x: 0.0, y: 0.0, standing: 1.0 }; 4];
        for joint in wall.joints() {
            let of = |f: &crate::model::JointForces| f.at(joint).corners(wall.width_m(joint));
            let (still, pushed, pulled, lifted) = (of(&still), of(&pushed), of(&pulled), of(&lifted));
            for side in 0..2 {
                corners[2 * joint as usize + side] = CornerForce {
                    // Both ways, so that the mirrored wall gets the mirrored number to the bit.
                    x: 0.5 * (pushed[side] - pulled[side]),
                    y: lifted[side] - still[side],
                    standing: still[side],
                };
            }
        }
        let mut sideways_over_down = [0.0; 2];
        for joint in wall.joints() {
            let force = pushed.at(joint);
            sideways_over_down[joint as usize] = force.shear / force.normal * crate::model::G_M_S2;
        }
        Self { corners, sideways_over_down }
    }

    /// Whether every corner stays pressed under a ground acceleration.
    #[inline]
    pub fn holds(&self, ground: Vector) -> bool {
        self.corners.iter().all(|corner| corner.at(ground) >= 0.0)
    }

    /// Offset in a piece, not before `from_s`, at which the first corner lifts; none if all are pressed at its end,
    /// for between two such ends a linear force cannot vanish.
    #[inline]
    pub fn lift_off_s(&self, piece: &Piece, from_s: f64) -> Option<f64> {
        let (start, end) = (piece.at(from_s), piece.at(piece.length_s));
        if self.holds(end) {
            return None;
        }
        let root = |corner: &CornerForce| {
            let (f0, f1) = (corner.at(start), corner.at(end));
            (f1 < 0.0).then(|| if f0 > 0.0 { f0 / (f0 - f1) } else { 0.0 })
        };
        let first = self.corners.iter().filter_map(root).fold(1.0, f64::min);
        Some(from_s + first * (piece.length_s - from_s))
    }

    /// |H|/N at the ground and at the crack while the wall stands under a ground acceleration.
    #[inline]
    pub fn friction(&self, ground: Vector) -> f64 {
        ground.x.abs() / (crate::model::G_M_S2 + ground.y)
    }

    /// Factors from [`RestLimits::friction`] to the demand at each joint.
    pub fn friction_factors(&self) -> [f64; 2] {
        self.sideways_over_down
    }
}

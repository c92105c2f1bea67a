//! Rest: the ground acceleration at which a wall at rest starts to move.
//!
//! At rest every corner force is linear in the ground acceleration. So the record is searched sample by
//! sample without integrating, and the instant inside a sample is exact.
//!
//! Friction at the top can take any force λ within ±F_c. A corner force c + D λ stays positive above or below
//! some λ. A λ that suits all corners exists while every bound from below lies below every bound from above.
//! These conditions are linear in the ground acceleration again.

use fearless_simd::{Level, SimdMask, f64x4};

use super::ground_path::Piece;
use crate::instructions::dispatch;
use crate::lanes::Wide;
use crate::model::{Contact, G_M_S2, RockingWall, State, Vector};

/// Corner forces at rest: `x` times a_x plus `y` times a_y plus `constant`.
#[derive(Debug, Clone, Copy, Default)]
struct CornerForce {
    x: f64,
    y: f64,
    constant: f64,
}

impl CornerForce {
    /// The same force over a positive number.
    fn over(&self, divisor: f64) -> Self {
        Self { x: self.x / divisor, y: self.y / divisor, constant: self.constant / divisor }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, constant: self.constant + other.constant }
    }

    #[inline]
    fn at(&self, ground: Vector) -> f64 {
        self.x * ground.x + self.y * ground.y + self.constant
    }
}

/// When a wall at rest starts to move, and its friction demand until then.
#[derive(Debug, Clone)]
pub(crate) struct RestLimits {
    /// At the ground, left and right, then at the crack; a crack that is not there never lifts.
    corners: [CornerForce; 4],
    /// Mass that pushes sideways over mass that presses down, at the ground and at the crack.
    sideways_over_down: [f64; 2],
    /// In place of the corners: what must not be negative for friction to hold the wall. Empty without
    /// friction.
    with_friction: Vec<CornerForce>,
}

/// A corner that never lifts.
const PRESSED: CornerForce = CornerForce { x: 0.0, y: 0.0, constant: 1.0 };

impl RestLimits {
    pub fn new(wall: &RockingWall) -> Self {
        let mut limits = Self::of_corners(wall);
        if let Some(piecewise_laws) = wall.piecewise_laws().filter(|piecewise_laws| piecewise_laws.rubs()) {
            let holds_n = wall.holds_n(piecewise_laws.friction_n(), 0.0);
            limits.with_friction = with_friction(wall, &limits.corners, holds_n);
            limits.corners = [PRESSED; 4];
        }
        limits
    }

    fn of_corners(wall: &RockingWall) -> Self {
        let forces_under =
            |ground: Vector| wall.joint_forces(Contact::REST, &State::default(), [0.0, 0.0], ground);
        let [still, pushed, pulled, lifted] =
            [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)].map(|(x, y)| forces_under(Vector { x, y }));
        let mut corners = [PRESSED; 4];
        for joint in wall.joints() {
            let of = |f: &crate::model::JointForces| f.at(joint).corners(wall.width_m(joint));
            let (still, pushed, pulled, lifted) = (of(&still), of(&pushed), of(&pulled), of(&lifted));
            for side in 0..2 {
                corners[2 * joint as usize + side] = CornerForce {
                    // Both ways, so that the mirrored wall gets the mirrored number to the bit.
                    x: 0.5 * (pushed[side] - pulled[side]),
                    y: lifted[side] - still[side],
                    constant: still[side],
                };
            }
        }
        let mut sideways_over_down = [0.0; 2];
        for joint in wall.joints() {
            let force = pushed.at(joint);
            sideways_over_down[joint as usize] = force.shear / force.normal * G_M_S2;
        }
        Self { corners, sideways_over_down, with_friction: Vec::new() }
    }

    /// Whether every corner stays pressed under a ground acceleration.
    #[inline]
    pub fn holds(&self, ground: Vector) -> bool {
        self.corners.iter().all(|corner| corner.at(ground) >= 0.0) && self.friction_holds(ground)
    }

    /// Over how many of the first samples every corner stays pressed, and the largest friction over them. Four samples
    /// at a time; what the last ones are is for [`RestLimits::holds`] to say.
    pub fn holds_over(&self, level: Level, samples: &[Vector]) -> (usize, f64) {
        if !self.with_friction.is_empty() {
            return (0, 0.0);
        }
        dispatch!(level, simd => self.lanes_hold_over::<f64x4<_>>(simd, samples))
    }

    #[inline(always)]
    fn lanes_hold_over<F: Wide>(&self, simd: F::Token, samples: &[Vector]) -> (usize, f64) {
        let constant = |value: f64| F::splat(simd, value);
        let corners = self.corners.map(|corner| [corner.x, corner.y, corner.constant].map(constant));
        let (mut count, mut friction) = (0, constant(0.0));
        for four in samples.chunks_exact(F::LEN) {
            let (x, y) = (F::of_each(simd, |i| four[i].x), F::of_each(simd, |i| four[i].y));
            let at = |[per_x, per_y, still]: [F; 3]| (per_x * x + per_y * y + still).simd_ge(0.0);
            if !(at(corners[0]) & at(corners[1]) & at(corners[2]) & at(corners[3])).all_true() {
                break;
            }
            friction = friction.max_precise(x.abs() / (y + G_M_S2));
            count += F::LEN;
        }
        (count, friction.as_slice().iter().copied().fold(0.0, f64::max))
    }

    #[inline]
    fn friction_holds(&self, ground: Vector) -> bool {
        self.with_friction.iter().all(|condition| condition.at(ground) >= 0.0)
    }

    /// The least of what holds the wall at rest; it moves when this is negative.
    pub fn reserve(&self, ground: Vector) -> f64 {
        self.conditions().map(|condition| condition.at(ground)).fold(f64::INFINITY, f64::min)
    }

    /// The same where friction has a part in it, without the corners that it holds.
    pub fn reserve_by_friction(&self, ground: Vector) -> f64 {
        let conditions = self.with_friction.iter().map(|condition| condition.at(ground));
        conditions.reduce(f64::min).unwrap_or_else(|| self.reserve(ground))
    }

    fn conditions(&self) -> impl Iterator<Item = &CornerForce> {
        self.corners.iter().chain(&self.with_friction)
    }

    /// Offset in a piece, not before `from_s`, at which the first corner lifts. `None` if all are pressed at
    /// its end: between two such ends a linear force cannot vanish.
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
        let first = self.conditions().filter_map(root).fold(1.0, f64::min);
        Some(from_s + first * (piece.length_s - from_s))
    }

    /// Share |a_x| / (g + a_y) of a ground acceleration; times its factor it is |H|/N at a joint at rest.
    #[inline]
    pub fn friction(&self, ground: Vector) -> f64 {
        ground.x.abs() / (G_M_S2 + ground.y)
    }

    /// Factors from [`RestLimits::friction`] to the demand at each joint.
    pub fn friction_factors(&self) -> [f64; 2] {
        self.sideways_over_down
    }
}

/// What must not be negative for a force at the top from the least to the most to press all corners.
fn with_friction(wall: &RockingWall, corners: &[CornerForce; 4], holds_n: [f64; 2]) -> Vec<CornerForce> {
    let [least_n, most_n] = holds_n;
    let bound = |constant: f64| CornerForce { constant, ..CornerForce::default() };
    let (mut from_below, mut from_above) = (vec![bound(-least_n)], vec![bound(most_n)]);
    let mut conditions = Vec::new();
    // As large as the friction, so that it exceeds the roundings; both ways, for the mirror's sake.
    let friction_n = most_n.max(-least_n);
    if friction_n == 0.0 {
        return corners.to_vec();
    }
    let [pushed, pulled] = [friction_n, -friction_n].map(|force_n| {
        wall.with_top_force(force_n).joint_forces(
            Contact::REST,
            &State::default(),
            [0.0; 2],
            Vector::default(),
        )
    });
    for joint in wall.joints() {
        let width_m = wall.width_m(joint);
        let [pushed, pulled] = [pushed, pulled].map(|forces| forces.at(joint).corners(width_m));
        for side in 0..2 {
            let corner = &corners[2 * joint as usize + side];
            let per_force = (pushed[side] - pulled[side]) / (2.0 * friction_n);
            if per_force > 0.0 {
                from_below.push(corner.over(per_force));
            } else if per_force < 0.0 {
                from_above.push(corner.over(-per_force));
            } else {
                conditions.push(*corner);
            }
        }
    }
    let pairs = from_below.iter().flat_map(|low| from_above.iter().map(move |high| low.plus(high)));
    // The first pair is the friction's own two bounds.
    conditions.extend(pairs.skip(1));
    conditions
}

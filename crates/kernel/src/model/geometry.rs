//! Where everything is: arms between corners, centres of mass and the top, turned by the rotations.

use super::contact::Contact;
use super::number::Number;
use super::vector::{Vector, sin_cos};
use super::wall::Wall;

/// Two numbers, one for each body.
pub type Pair = [f64; 2];

/// Arms of one contact state in the axes of the bodies, at zero rotation, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arms<N = f64> {
    /// Pivot at the ground, x of O.
    pub o_x: N,
    /// G1 - O.
    pub g1: Vector<N>,
    /// Q - O, with Q the pivot at the crack.
    pub q: Vector<N>,
    /// G2 - Q.
    pub g2: Vector<N>,
    /// C - Q.
    pub c: Vector<N>,
    /// Pivot at the crack, from the middle of the joint along the joint: s_2 b_2/2.
    pub q_x: N,
}

impl Arms {
    /// Arms of the reference positions of model section 1 about the pivots of `contact`.
    pub fn new(wall: &Wall, contact: Contact) -> Self {
        let crack = if wall.is_cracked() { contact.crack.sign() } else { 0.0 };
        Self::about(wall, [contact.ground.sign(), crack])
    }
}

impl<N: Number> Arms<N> {
    /// About the corners on these sides of the ground and the crack, ±1, or 0 where a joint is closed.
    #[inline(always)]
    pub fn about(wall: &Wall, [ground, crack]: [N; 2]) -> Self {
        let [h1, h2] = wall.height_m;
        let all = |value: f64| ground.constant(value);
        let o_x = ground * all(wall.width_m[0]) / all(2.0);
        let q_x = crack * all(wall.width_m[1]) / all(2.0);
        Self {
            o_x,
            g1: Vector::new(-o_x, all(h1 / 2.0)),
            q: Vector::new(q_x - o_x, all(h1)),
            g2: Vector::new(-q_x, all(h2 / 2.0)),
            c: Vector::new(all(wall.parameters().eccentricity_m) - q_x, all(h2)),
            q_x,
        }
    }
}

/// The arms turned by the rotations: r_1, r_Q, r_2, r_C of model section 3, in the world's axes, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TurnedArms<N = f64> {
    pub o_x: N,
    pub r_1: Vector<N>,
    pub r_q: Vector<N>,
    pub r_2: Vector<N>,
    pub r_c: Vector<N>,
    /// Q seen from the middle of the crack.
    pub q_from_middle: Vector<N>,
    /// Sine and cosine of θ_1.
    pub turn_1: (N, N),
}

/// Both rotations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rotations {
    /// Their sines and cosines.
    pub turns: [(f64, f64); 2],
    /// The angles of these, where they are known.
    angles: Option<Pair>,
}

impl Rotations {
    /// None of the bodies.
    pub const NONE: Self = Self { turns: [(0.0, 1.0); 2], angles: None };

    #[inline(always)]
    pub fn new(theta: Pair) -> Self {
        Self { turns: theta.map(sin_cos), angles: None }
    }

    /// The same, whose angles are asked for more than once.
    pub fn with_angles(self) -> Self {
        Self { angles: Some(self.angles()), ..self }
    }

    /// The rotations themselves, rad.
    pub fn angles(&self) -> Pair {
        self.angles.unwrap_or_else(|| self.turns.map(|(sin, cos)| sin.atan2(cos)))
    }
}

impl<N: Number> TurnedArms<N> {
    /// By the sines and cosines of both rotations.
    #[inline(always)]
    pub fn new(arms: &Arms<N>, [turn_1, turn_2]: [(N, N); 2]) -> Self {
        Self {
            o_x: arms.o_x,
            r_1: arms.g1.rotated(turn_1),
            r_q: arms.q.rotated(turn_1),
            r_2: arms.g2.rotated(turn_2),
            r_c: arms.c.rotated(turn_2),
            q_from_middle: Vector::new(arms.q_x, arms.q_x.constant(0.0)).rotated(turn_1),
            turn_1,
        }
    }

    /// Velocities J θ' of the mass points.
    #[inline(always)]
    pub fn velocities(&self, omega: [N; 2]) -> PointVelocities<N> {
        let q = self.r_q.perpendicular() * omega[0];
        PointVelocities {
            g1: self.r_1.perpendicular() * omega[0],
            g2: q + self.r_2.perpendicular() * omega[1],
            c: q + self.r_c.perpendicular() * omega[1],
            theta: omega,
        }
    }
}

/// Velocities of the mass points, or their jumps: (x1, y1, θ1, x2, y2, θ2, xC, yC) of model section 3.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointVelocities<N = f64> {
    pub g1: Vector<N>,
    pub g2: Vector<N>,
    pub c: Vector<N>,
    pub theta: [N; 2],
}

impl<N: Number> PointVelocities<N> {
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        Self {
            g1: self.g1 - other.g1,
            g2: self.g2 - other.g2,
            c: self.c - other.c,
            theta: [self.theta[0] - other.theta[0], self.theta[1] - other.theta[1]],
        }
    }
}

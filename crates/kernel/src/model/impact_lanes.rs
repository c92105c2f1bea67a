//! The contact states that may follow an impact side by side, in the lanes of vector registers.
//!
//! The same sums in the same order as in [`super::impact`], state by state.

use fearless_simd::Select;

use super::contact::{Contact, Joint};
use super::geometry::{Arms, Pair, PointVelocities, TurnedArms};
use super::impact::{BESIDE, Collision, ROUNDING};
use super::joint_forces::{JointForce, Masses};
use super::mass_matrix::{Freedom, MassMatrix};
use super::rocking::RockingWall;
use super::vector::Vector;
use crate::lanes::Wide;

/// Contact states of a wall on sharp edges.
struct Candidates<'a, F: Wide> {
    simd: F::Token,
    wall: &'a RockingWall,
    /// Sides on which the joint at the ground and that at the crack are open.
    sides: [F; 2],
}

impl<'a, F: Wide> Candidates<'a, F> {
    #[inline(always)]
    fn new(simd: F::Token, wall: &'a RockingWall, to: &[Contact; BESIDE]) -> Self {
        let sides = [F::of_each(simd, |i| to[i].ground.sign()), F::of_each(simd, |i| to[i].crack.sign())];
        Self { simd, wall, sides }
    }

    #[inline(always)]
    fn all(&self, value: f64) -> F {
        F::splat(self.simd, value)
    }

    #[inline(always)]
    fn vector(&self, of: Vector) -> Vector<F> {
        Vector::new(self.all(of.x), self.all(of.y))
    }

    /// The lanes in which a joint is closed.
    #[inline(always)]
    fn closed(&self, joint: Joint) -> F::Mask {
        self.sides[joint as usize].simd_eq(0.0)
    }

    #[inline(always)]
    fn masses(&self) -> Masses<F> {
        let Masses { m, i, m_d, m_dp } = self.wall.masses;
        Masses {
            m: [self.all(m[0]), self.all(m[1])],
            i: [self.all(i[0]), self.all(i[1])],
            m_d: self.all(m_d),
            m_dp: self.all(m_dp),
        }
    }

    #[inline(always)]
    fn velocities(&self, v: &PointVelocities) -> PointVelocities<F> {
        PointVelocities {
            g1: self.vector(v.g1),
            g2: self.vector(v.g2),
            c: self.vector(v.c),
            theta: [self.all(v.theta[0]), self.all(v.theta[1])],
        }
    }

    /// As [`super::motion::Motion::mass_matrix`].
    #[inline(always)]
    fn mass_matrix(
        &self,
        masses: &Masses<F>,
        arms: &Arms<F>,
        turned: &TurnedArms<F>,
        turn_2: (F, F),
    ) -> MassMatrix<F> {
        let (_, inertias, u) = masses.about_pivots(arms);
        let (u, m_dp) = (u.rotated(turn_2), masses.m_dp);
        let (q, c) = (turned.r_q, turned.r_c);
        MassMatrix {
            m11: inertias[0] + q.y * q.y * m_dp,
            m12: (q.x * u.x + q.y * u.y) + m_dp * q.y * c.y,
            m22: inertias[1] + c.y * c.y * m_dp,
        }
    }

    /// As [`MassMatrix::solve`] in the rotations that each state leaves free.
    #[inline(always)]
    fn solved(&self, mass: &MassMatrix<F>, momenta: [F; 2]) -> [F; 2] {
        let whole = mass.solve(Freedom::Monolithic, momenta);
        let upper = mass.solve(Freedom::Upper, momenta);
        let both = mass.solve(Freedom::Both, momenta);
        let (ground, crack) = (self.closed(Joint::Ground), self.closed(Joint::Crack));
        let still = self.all(0.0);
        [
            ground.select(still, crack.select(whole[0], both[0])),
            ground.select(crack.select(still, upper[1]), crack.select(whole[1], both[1])),
        ]
    }

    /// Smallest separation of the joints that touched and are open now; infinite where none is.
    #[inline(always)]
    fn separation(&self, collision: &Collision, [w1, w2]: [F; 2]) -> F {
        let mut least = self.all(f64::INFINITY);
        for (joint, opening) in [(Joint::Ground, w1), (Joint::Crack, w2 - w1)] {
            if collision.touching.at(joint) {
                let open = self.sides[joint as usize] * opening;
                let separates = self.closed(joint).select(self.all(f64::INFINITY), open);
                least = least.min_precise(separates);
            }
        }
        least
    }

    /// Smallest corner impulse of the joints that are closed; infinite where none is.
    #[inline(always)]
    fn impulse(&self, through: [&JointForce<F>; 2]) -> F {
        let mut least = self.all(f64::INFINITY);
        for joint in self.wall.joints() {
            let JointForce { normal, moment, .. } = through[joint as usize];
            let (half, lever) = (*normal / 2.0, *moment / self.wall.width_m(joint));
            let corners = [half + lever, half - lever];
            let smallest = least.min_precise(corners[0]).min_precise(corners[1]);
            least = self.closed(joint).select(smallest, least);
        }
        least
    }
}

impl RockingWall {
    /// As [`RockingWall::margin`] of as many contact states of a wall on sharp edges as there are numbers.
    #[inline(always)]
    pub(super) fn margins_on_edges<F: Wide>(
        &self,
        simd: F::Token,
        to: &[Contact; BESIDE],
        collision: &Collision,
    ) -> [(f64, Pair); BESIDE] {
        let candidates = Candidates::<F>::new(simd, self, to);
        let turns = collision.rotations.turns.map(|(sin, cos)| (candidates.all(sin), candidates.all(cos)));
        let still = Arms::about(self.wall(), candidates.sides);
        let arms = TurnedArms::new(&still, turns);
        let (masses, before) = (candidates.masses(), candidates.velocities(&collision.v_before));
        let mass = candidates.mass_matrix(&masses, &still, &arms, turns[1]);
        let omega = candidates.solved(&mass, masses.momenta(&arms, &before));
        let separation = candidates.separation(collision, omega) / collision.speed;
        let jump = arms.velocities(omega).minus(before);
        let through = masses.through_joints(&arms, &jump, candidates.all(0.0));
        let impulse = candidates.impulse([&through.ground, &through.crack]) / collision.impulse_size;
        let smaller = separation.min_precise(impulse);
        let margin = separation.simd_lt(-ROUNDING).select(separation, smaller);
        std::array::from_fn(|i| (margin[i], [omega[0][i], omega[1][i]]))
    }
}

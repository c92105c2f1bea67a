//! Impacts at the cracks of walls side by side whose bodies turn on apart, about the same corners at the ground and the other ones
//! at the crack.
//!
//! The same sums in the same order as in [`super::impact`], for walls on sharp edges under the law of impacts
//! [`super::ImpactLaw::Whole`].

use super::geometry::{Arms, TurnedArms};
use super::impact::ROUNDING;
use super::joint_forces::Masses;
use super::mass_matrix::Freedom;
use super::rocking::RockingWall;
use super::sharp::SharpMotion;
use super::side_by_side::sin_cos_lanes;
use super::vector::Vector;
use crate::lanes::{Numbers, Wide};

/// Masses of the walls of a row, and where these are.
#[derive(Debug, Default)]
pub(crate) struct CrackRow {
    masses_kg: [Numbers; 2],
    inertias_kg_m2: [Numbers; 2],
    diaphragm_kg: Numbers,
    /// Halves of the heights of both bodies, m.
    halves_m: [Numbers; 2],
    slimness: Numbers,
}

/// What an impact leaves: velocities and the loss of energy.
pub(crate) struct CrackImpact<F: Wide> {
    pub omega: [F; 2],
    pub loss_j: F,
}

impl CrackRow {
    /// Puts a wall in a lane.
    pub fn put(&mut self, i: usize, wall: &RockingWall) {
        let Masses { m, i: inertia, m_d, .. } = wall.masses;
        for body in 0..2 {
            self.masses_kg[body][i] = m[body];
            self.inertias_kg_m2[body][i] = inertia[body];
            self.halves_m[body][i] = wall.wall().height_m[body] / 2.0;
        }
        self.diaphragm_kg[i] = m_d;
        self.slimness[i] = wall.slimness;
    }

    #[inline(always)]
    fn masses<F: Wide>(&self, m_dp: F) -> Masses<F> {
        let of = |numbers: &Numbers| F::of_row(m_dp.token(), numbers);
        Masses {
            m: [of(&self.masses_kg[0]), of(&self.masses_kg[1])],
            i: [of(&self.inertias_kg_m2[0]), of(&self.inertias_kg_m2[1])],
            m_d: of(&self.diaphragm_kg),
            m_dp,
        }
    }

    /// As [`Arms::new`] has them of the contact states of these motions.
    #[inline(always)]
    fn arms<F: Wide>(&self, motion: &SharpMotion<F>) -> Arms<F> {
        let SharpMotion { o_x, q_x, q, c, .. } = *motion;
        let half = |body: usize| F::of_row(o_x.token(), &self.halves_m[body]);
        Arms { o_x, g1: Vector::new(-o_x, half(0)), q, g2: Vector::new(-q_x, half(1)), c, q_x }
    }

    /// What impacts of walls that turn by θ leave of the velocities, whose cracks open on these sides after, and which of them are
    /// surely so. As [`RockingWall::impact`] where the outcome is struck through.
    #[inline(always)]
    pub fn strike<F: Wide>(
        &self,
        [from, to]: [&SharpMotion<F>; 2],
        (theta, omega): (F, [F; 2]),
        side: F,
        [coefficient, capture_rad_s]: [F; 2],
    ) -> (CrackImpact<F>, F::Mask) {
        let all = |value: f64| F::splat(theta.token(), value);
        let (turns, masses) = ([sin_cos_lanes(theta); 2], self.masses(from.m_dp));
        let before = TurnedArms::new(&self.arms(from), turns).velocities(omega);
        let least = all(f64::MIN_POSITIVE);
        let speed = omega[0].abs().max_precise(least).max_precise(omega[1].abs().max_precise(least));
        let size =
            (masses.momentum_size(&before) * F::of_row(theta.token(), &self.slimness)).max_precise(least);
        let arms = TurnedArms::new(&self.arms(to), turns);
        let mass = to.mass_matrix(&to.turned(turns));
        let plastic = mass.solve(Freedom::Both, masses.momenta(&arms, &before));
        let opening = plastic[1] - plastic[0];
        let separates = (side * opening / speed).simd_gt(ROUNDING);
        let impulses = masses.through_joints(&arms, &arms.velocities(plastic).minus(before), all(0.0));
        let pushed = |normal: F| normal.simd_gt(size * ROUNDING);
        let sure = separates & pushed(impulses.ground.normal) & pushed(impulses.crack.normal);
        let turns_on = sure & opening.abs().simd_ge(capture_rad_s);
        // From what the law cannot see: nothing.
        let scaled = |plastic: F| all(0.0) + coefficient * (plastic - all(0.0));
        let after = [scaled(plastic[0]), scaled(plastic[1])];
        let before_j = from.mass_matrix(&from.turned(turns)).quadratic(omega) * 0.5;
        (CrackImpact { omega: after, loss_j: before_j - mass.quadratic(after) * 0.5 }, turns_on)
    }
}

//! The equations of motion of several walls side by side, in the lanes of vector registers.
//!
//! The equations are those of one wall ([`super::sharp`], [`super::bed`]), over several numbers at once ([`super::number`]). A wall
//! moves the same to the bit alone and beside others. Only for walls whose effects the lanes know, as the
//! catalogue says; the others move alone.
//!
//! What works on lanes is `#[inline(always)]`, and closures are avoided. Only so does all of it become part
//! of the one function compiled for the vector instructions of a processor.

use std::f64::consts::FRAC_PI_4;

use fearless_simd::{Select, SimdMask};

use super::joint_forces::{JointForces, Reactions};
use super::lane_laws::LawLanes;
use super::mass_matrix::Freedom;
use super::motion_row::MotionRow;
use super::sharp::{Configuration, Equations, SharpMotion};
use super::vector::{COS, SIN, Vector};
use crate::fused::fused_lanes as fused;
use crate::lanes::Wide;

/// The motions of several contact states side by side, all of one [`LaneKind`].
pub(crate) struct Motions<F: Wide, const AS_ONE: bool, const FURTHER: bool> {
    upper: F::Mask,
    any_upper: bool,
    pub(crate) sharp: SharpMotion<F>,
    laws: LawLanes<F, FURTHER>,
}

/// Angular accelerations of both bodies, the power of the ground and that of losses.
#[derive(Clone, Copy)]
pub(crate) struct RateLanes<F: Wide> {
    pub theta_dd: [F; 2],
    pub powers_w: [F; 2],
}

/// [`Reactions`] of every lane.
#[derive(Clone, Copy)]
pub(crate) struct ReactionLanes<F: Wide> {
    /// Shear, normal force and moment of both joints.
    pub ground: [F; 3],
    pub crack: [F; 3],
    /// Displacement, velocity and acceleration.
    pub top: [F; 3],
}

#[inline(always)]
pub(crate) fn sin_cos_lanes<F: Wide>(theta: F) -> (F, F) {
    let z = theta * theta;
    let zz = z * z;
    let [one, minus_half] = [F::splat(theta.token(), 1.0), F::splat(theta.token(), -0.5)];
    let sin = fused(theta * z, polynomial(&SIN, z, zz), theta);
    let cos = fused(zz, polynomial(&COS, z, zz), fused(z, minus_half, one));
    let beyond = theta.abs().simd_gt(FRAC_PI_4);
    if beyond.any_true() {
        return with_those_of_library(beyond.to_bitmask(), theta, (sin, cos));
    }
    (sin, cos)
}

/// In the order of [`super::vector::sin_cos`].
#[inline(always)]
fn polynomial<F: Wide>(c: &[f64; 6], z: F, zz: F) -> F {
    fused(zz, fused(zz, pair(c, 4, z), pair(c, 2, z)), pair(c, 0, z))
}

/// Two neighbours of a polynomial.
#[inline(always)]
fn pair<F: Wide>(c: &[f64; 6], n: usize, z: F) -> F {
    fused(z, F::splat(z.token(), c[n + 1]), F::splat(z.token(), c[n]))
}

/// Sines and cosines, in some lanes those of the library.
#[cold]
fn with_those_of_library<F: Wide>(lanes: u64, theta: F, (mut sin, mut cos): (F, F)) -> (F, F) {
    for i in (0..F::LEN).filter(|i| lanes >> i & 1 == 1) {
        (sin[i], cos[i]) = theta[i].sin_cos();
    }
    (sin, cos)
}

impl<F: Wide, const AS_ONE: bool, const FURTHER: bool> Motions<F, AS_ONE, FURTHER> {
    #[inline(always)]
    pub fn new(simd: F::Token, row: &mut MotionRow) -> Self {
        let upper = F::of_row(simd, &row.upper).simd_eq(1.0);
        Self {
            upper,
            any_upper: upper.any_true(),
            sharp: row.sharp(simd),
            laws: LawLanes::new(simd, &mut row.laws),
        }
    }

    /// The lanes with formulas; `None` where none has any.
    #[inline(always)]
    pub fn written(&self) -> Option<F::Mask> {
        self.laws.written()
    }

    /// Turns about the corners that are in the row now.
    #[inline(always)]
    pub fn follow(&mut self, simd: F::Token, row: &MotionRow) {
        self.sharp = row.sharp(simd);
    }

    /// Puts back what [`Motions::new`] took out of the row.
    #[inline(always)]
    pub fn put_back(self, row: &mut MotionRow) {
        self.laws.put_back(&mut row.laws);
    }

    #[inline(always)]
    pub fn configuration(&self, theta: [F; 2]) -> Configuration<F> {
        self.turned(Self::turns(theta))
    }

    /// Sines and cosines of both rotations.
    #[inline(always)]
    pub fn turns(theta: [F; 2]) -> [(F, F); 2] {
        let turn_1 = sin_cos_lanes(theta[0]);
        [turn_1, if AS_ONE { turn_1 } else { sin_cos_lanes(theta[1]) }]
    }

    /// The same by the sines and cosines of both rotations.
    #[inline(always)]
    pub fn turned(&self, turns: [(F, F); 2]) -> Configuration<F> {
        self.sharp.turned(turns)
    }

    /// Displacement of the top, m.
    #[inline(always)]
    pub fn top_displacement_m(&self, t: &Configuration<F>) -> F {
        self.sharp.top_displacement_m(t)
    }

    /// θ'' and the powers of walls that turn as one, at a rotation with this sine and cosine.
    #[inline(always)]
    pub fn monolithic_rate(&self, theta: F, turn: (F, F), omega: F, [x, y]: [F; 2]) -> (F, [F; 2]) {
        self.sharp.monolithic_rate(&self.laws, (theta, turn), omega, Vector { x, y })
    }

    #[inline(always)]
    pub fn rate(&self, t: &Configuration<F>, omega: [F; 2], [x, y]: [F; 2]) -> RateLanes<F> {
        let ground = Vector { x, y };
        let equations = self.sharp.equations(&self.laws, t, omega, ground);
        self.rate_by(&self.sharp, &equations, t, omega, ground)
    }

    #[inline(always)]
    fn rate_by(
        &self,
        sharp: &SharpMotion<F>,
        equations: &Equations<F>,
        t: &Configuration<F>,
        omega: [F; 2],
        ground: Vector<F>,
    ) -> RateLanes<F> {
        let powers_w = sharp.powers_w(&self.laws, equations, t, omega, ground);
        RateLanes { theta_dd: self.solve(equations), powers_w }
    }

    /// As [`super::mass_matrix::MassMatrix::solve`].
    #[inline(always)]
    fn solve(&self, equations: &Equations<F>) -> [F; 2] {
        let (mass, f) = (&equations.mass, equations.f);
        if AS_ONE {
            return mass.solve(Freedom::Monolithic, f);
        }
        let both = mass.solve(Freedom::Both, f);
        if !self.any_upper {
            return both;
        }
        let upper = mass.solve(Freedom::Upper, f);
        [self.upper.select(upper[0], both[0]), self.upper.select(upper[1], both[1])]
    }

    /// The rate and the reactions in a configuration.
    #[inline(always)]
    pub fn rate_and_reactions(
        &self,
        t: &Configuration<F>,
        omega: [F; 2],
        ground: [F; 2],
    ) -> (RateLanes<F>, ReactionLanes<F>) {
        self.rate_and_reactions_about(&self.sharp, t, omega, ground)
    }

    /// The same about other corners.
    #[inline(always)]
    pub fn rate_and_reactions_about(
        &self,
        sharp: &SharpMotion<F>,
        t: &Configuration<F>,
        omega: [F; 2],
        [x, y]: [F; 2],
    ) -> (RateLanes<F>, ReactionLanes<F>) {
        let ground = Vector { x, y };
        let equations = sharp.equations(&self.laws, t, omega, ground);
        let rate = self.rate_by(sharp, &equations, t, omega, ground);
        (rate, ReactionLanes::by(sharp, &equations, t, rate.theta_dd, ground))
    }

    /// The reactions of a motion with these angular accelerations.
    #[inline(always)]
    pub fn reactions(
        &self,
        t: &Configuration<F>,
        omega: [F; 2],
        theta_dd: [F; 2],
        [x, y]: [F; 2],
    ) -> ReactionLanes<F> {
        let ground = Vector { x, y };
        let equations = self.sharp.equations(&self.laws, t, omega, ground);
        ReactionLanes::by(&self.sharp, &equations, t, theta_dd, ground)
    }
}

impl<F: Wide> ReactionLanes<F> {
    /// Those of walls on sharp edges by their equations.
    #[inline(always)]
    fn by(
        sharp: &SharpMotion<F>,
        equations: &Equations<F>,
        t: &Configuration<F>,
        theta_dd: [F; 2],
        ground: Vector<F>,
    ) -> Self {
        let at_top = [equations.spring_and_damping, F::splat(ground.x.token(), 0.0)];
        Self::of(&sharp.reactions(equations, t, theta_dd, ground, at_top))
    }

    /// Those of walls that nothing holds at the top.
    #[inline(always)]
    pub fn of(reactions: &Reactions<F>) -> Self {
        let JointForces { ground, crack } = reactions.forces;
        Self {
            ground: [ground.shear, ground.normal, ground.moment],
            crack: [crack.shear, crack.normal, crack.moment],
            top: [reactions.top_displacement_m, reactions.top_velocity_m_s, reactions.top_acceleration_m_s2],
        }
    }
}

//! The equations of motion of several walls side by side, in the lanes of vector registers.
//!
//! The same sums in the same order as in [`super::motion`] and [`super::joint_forces`], lane by lane. A wall
//! moves the same to the bit alone and beside others. Only for walls whose effects the lanes know, as the
//! catalogue says; the others move alone. The equations of walls on beds are written once for both
//! ([`super::bed`], [`super::number`]).
//!
//! What works on lanes is `#[inline(always)]`, and closures are avoided. Only so does all of it become part
//! of the one function compiled for the vector instructions of a processor.

use std::f64::consts::FRAC_PI_4;

use fearless_simd::{Select, SimdMask};

use super::formula::angles;
use super::joint_forces::{JointForces, Reactions};
use super::lane_laws::{FurtherLanes, SpringLanes};
use super::mass_matrix::MassMatrix;
use super::motion_row::MotionRow;
use super::vector::{COS, SIN};
use super::wall::G_M_S2;
use crate::fused::fused_lanes as fused;
use crate::lanes::{Numbers, Wide};

/// The motions of several contact states side by side, all of one [`LaneKind`].
pub(crate) struct Motions<F: Wide, const AS_ONE: bool, const FURTHER: bool> {
    upper: F::Mask,
    any_upper: bool,
    pub(super) o_x: F,
    o_c: F,
    pub(super) q_x: F,
    pub(super) q: [F; 2],
    pub(super) c: [F; 2],
    v: [F; 2],
    u: [F; 2],
    whole_arm: [F; 2],
    whole_moment: [F; 2],
    whole_inertia: F,
    pub(super) inertias: [F; 2],
    lower_mass: F,
    upper_mass: F,
    lower_inertia: F,
    pub(super) m_dp: F,
    spring: SpringLanes<F>,
    further: Option<FurtherLanes<F>>,
}

/// Arms and static moments turned by the rotations.
#[derive(Clone, Copy)]
pub(crate) struct ConfigurationLanes<F: Wide> {
    sin_1: F,
    cos_1: F,
    sin_2: F,
    cos_2: F,
    /// r_Q, r_C, V, U.
    pub(super) q: [F; 2],
    pub(super) c: [F; 2],
    v: [F; 2],
    pub(super) u: [F; 2],
}

impl<F: Wide> ConfigurationLanes<F> {
    /// θ_1 and θ_2, to a rounding.
    fn theta(&self) -> [F; 2] {
        [angles(self.sin_1, self.cos_1), angles(self.sin_2, self.cos_2)]
    }
}

/// Angular accelerations of both bodies, the power of the ground and that of losses.
#[derive(Clone, Copy)]
pub(crate) struct RateLanes<F: Wide> {
    pub theta_dd: [F; 2],
    pub powers_w: [F; 2],
}

struct Equations<F: Wide> {
    mass: MassMatrix<F>,
    f: [F; 2],
    squares: [F; 2],
    x_c: F,
    v_c: F,
    /// Of dampers and drag at the top, and with that of the spring.
    damping: F,
    spring_and_damping: F,
    joint_moments: [F; 2],
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

/// As [`super::vector::Vector::moment_of`].
#[inline(always)]
fn moment<F: Wide>(arm: [F; 2], force: [F; 2]) -> F {
    arm[1] * force[0] - arm[0] * force[1]
}

#[inline(always)]
fn rotated<F: Wide>([x, y]: [F; 2], sin: F, cos: F) -> [F; 2] {
    [x * cos + y * sin, y * cos - x * sin]
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
        let further = if FURTHER { Some(FurtherLanes::new(simd, &mut row.laws)) } else { None };
        let one = |of: &Numbers| F::of_row(simd, of);
        let two = |of: &[Numbers; 2]| [F::of_row(simd, &of[0]), F::of_row(simd, &of[1])];
        let upper = one(&row.upper).simd_eq(1.0);
        Self {
            upper,
            any_upper: upper.any_true(),
            o_x: one(&row.pivots.o_x),
            o_c: one(&row.pivots.o_c),
            q_x: one(&row.pivots.q_x),
            q: two(&row.pivots.q),
            c: two(&row.pivots.c),
            v: two(&row.pivots.v),
            u: two(&row.pivots.u),
            whole_arm: two(&row.pivots.whole_arm),
            whole_moment: two(&row.pivots.whole_moment),
            whole_inertia: one(&row.pivots.whole_inertia),
            inertias: two(&row.pivots.inertias),
            lower_mass: one(&row.lower_mass),
            upper_mass: one(&row.upper_mass),
            lower_inertia: one(&row.pivots.lower_inertia),
            m_dp: one(&row.laws.m_dp),
            spring: SpringLanes::new(simd, &row.laws),
            further,
        }
    }

    /// Puts back what [`Motions::new`] took out of the row.
    #[inline(always)]
    pub fn put_back(self, row: &mut MotionRow) {
        if let Some(further) = self.further {
            further.put_back(&mut row.laws);
        }
    }

    #[inline(always)]
    pub fn configuration(&self, theta: [F; 2]) -> ConfigurationLanes<F> {
        let turn_1 = sin_cos_lanes(theta[0]);
        self.turned([turn_1, if AS_ONE { turn_1 } else { sin_cos_lanes(theta[1]) }])
    }

    /// The same by the sines and cosines of both rotations.
    #[inline(always)]
    pub fn turned(&self, [(sin_1, cos_1), (sin_2, cos_2)]: [(F, F); 2]) -> ConfigurationLanes<F> {
        ConfigurationLanes {
            sin_1,
            cos_1,
            sin_2,
            cos_2,
            q: rotated(self.q, sin_1, cos_1),
            c: rotated(self.c, sin_2, cos_2),
            v: rotated(self.v, sin_1, cos_1),
            u: rotated(self.u, sin_2, cos_2),
        }
    }

    /// As [`Motion::top_displacement_m`].
    #[inline(always)]
    pub fn top_displacement_m(&self, t: &ConfigurationLanes<F>) -> F {
        (t.q[0] + t.c[0]) + self.o_c
    }

    /// As [`Laws::spring_force_n`].
    #[inline(always)]
    fn spring_force_n(&self, x_c: F) -> F {
        match &self.further {
            Some(further) => further.spring_force_n(&self.spring, x_c),
            None => self.spring.force_n(x_c),
        }
    }

    /// As [`Motion::monolithic_rate`], θ'' and the powers, at a rotation with this sine and cosine.
    #[inline(always)]
    pub fn monolithic_rate(&self, theta: F, (sin, cos): (F, F), omega: F, [g_x, g_y]: [F; 2]) -> (F, [F; 2]) {
        let r = rotated(self.whole_arm, sin, cos);
        let w = rotated(self.whole_moment, sin, cos);
        let (a_x, a_y) = (g_x, g_y + G_M_S2);
        let v_c = r[1] * omega;
        let carriage_acceleration = fused(-r[0], omega * omega, a_x);
        let x_c = r[0] + self.o_c;
        let mut top = self.spring_force_n(x_c) - self.m_dp * carriage_acceleration;
        let mut weight_and_ground = fused(w[0], a_y, -w[1] * a_x);
        let mut loss = F::splat(theta.token(), 0.0);
        if let Some(further) = &self.further {
            let damping = further.damping_force_n(x_c, v_c);
            let [joint, _] = further.joint_moments_n_m(|| [theta; 2], [omega; 2]);
            top = further.with(top, damping);
            weight_and_ground = further.with(weight_and_ground, joint);
            loss = further.where_damped(-fused(damping, v_c, joint * omega));
        }
        let inverse = F::splat(theta.token(), 1.0) / fused(self.m_dp * r[1], r[1], self.whole_inertia);
        let theta_dd = fused(r[1], top, weight_and_ground) * inverse;
        let momentum_x = fused(w[1], omega, self.m_dp * v_c);
        let power = fused(g_y * w[0], omega, -g_x * momentum_x);
        (theta_dd, [power, loss])
    }

    #[inline(always)]
    pub fn rate(&self, t: &ConfigurationLanes<F>, omega: [F; 2], ground: [F; 2]) -> RateLanes<F> {
        self.rate_by(&self.equations(t, omega, ground), t, omega, ground)
    }

    #[inline(always)]
    fn equations(&self, t: &ConfigurationLanes<F>, [w1, w2]: [F; 2], [g_x, g_y]: [F; 2]) -> Equations<F> {
        let (a_x, a_y) = (g_x, g_y + G_M_S2);
        let squares = [w1 * w1, w2 * w2];
        let x_c = self.top_displacement_m(t);
        let v_c = t.q[1] * w1 + t.c[1] * w2;
        let spring = self.spring_force_n(x_c);
        let none = F::splat(x_c.token(), 0.0);
        let (mut damping, mut spring_and_damping, mut joint_moments) = (none, spring, [none; 2]);
        if let Some(further) = &self.further {
            damping = further.where_damped(further.damping_force_n(x_c, v_c));
            spring_and_damping = further.with(spring, damping);
            joint_moments = further.joint_moments_n_m(|| t.theta(), [w1, w2]);
        }
        let carriage_acceleration = a_x - t.q[0] * squares[0] - t.c[0] * squares[1];
        let kappa = t.q[1] * t.u[0] - t.q[0] * t.u[1];
        let forces = [
            fused(kappa, squares[1], fused(t.v[0], a_y, -t.v[1] * a_x)),
            fused(kappa, -squares[0], fused(t.u[0], a_y, -t.u[1] * a_x)),
        ];
        let top = spring_and_damping - self.m_dp * carriage_acceleration;
        let mut f = [fused(t.q[1], top, forces[0]), fused(t.c[1], top, forces[1])];
        if let Some(further) = &self.further {
            f = [further.with(f[0], joint_moments[0]), further.with(f[1], joint_moments[1])];
        }
        Equations {
            mass: self.mass_matrix(t),
            f,
            squares,
            x_c,
            v_c,
            damping,
            spring_and_damping,
            joint_moments,
        }
    }

    #[inline(always)]
    fn rate_by(
        &self,
        equations: &Equations<F>,
        t: &ConfigurationLanes<F>,
        [w1, w2]: [F; 2],
        [g_x, g_y]: [F; 2],
    ) -> RateLanes<F> {
        let momentum_x = fused(self.m_dp, equations.v_c, t.v[1] * w1 + t.u[1] * w2);
        let ground_power_w = fused(g_y, t.v[0] * w1 + t.u[0] * w2, -g_x * momentum_x);
        let mut loss_power_w = F::splat(w1.token(), 0.0);
        if let Some(further) = &self.further {
            let [j_1, j_2] = equations.joint_moments;
            let loss = -fused(equations.damping, equations.v_c, j_1 * w1 + j_2 * w2);
            loss_power_w = further.where_damped(loss);
        }
        RateLanes { theta_dd: self.solve(equations), powers_w: [ground_power_w, loss_power_w] }
    }

    /// As [`super::mass_matrix::MassMatrix::solve`].
    #[inline(always)]
    fn solve(&self, equations: &Equations<F>) -> [F; 2] {
        let (MassMatrix { m11, m12, m22 }, [f1, f2]) = (equations.mass, equations.f);
        if AS_ONE {
            let x = (f1 + f2) / (m11 + m12 * 2.0 + m22);
            return [x, x];
        }
        let inverse = F::splat(f1.token(), 1.0) / fused(-m12, m12, m11 * m22);
        let both = [fused(m22, f1, -m12 * f2) * inverse, fused(m11, f2, -m12 * f1) * inverse];
        if !self.any_upper {
            return both;
        }
        let still = F::splat(f1.token(), 0.0);
        [self.upper.select(still, both[0]), self.upper.select(f2 / m22, both[1])]
    }

    /// As [`Motion::rate_and_reactions`].
    #[inline(always)]
    pub fn rate_and_reactions(
        &self,
        t: &ConfigurationLanes<F>,
        omega: [F; 2],
        ground: [F; 2],
    ) -> (RateLanes<F>, ReactionLanes<F>) {
        let equations = self.equations(t, omega, ground);
        let rate = self.rate_by(&equations, t, omega, ground);
        (rate, self.reactions(&equations, t, rate.theta_dd, ground))
    }

    #[inline(always)]
    fn reactions(
        &self,
        equations: &Equations<F>,
        t: &ConfigurationLanes<F>,
        [dd_1, dd_2]: [F; 2],
        [g_x, g_y]: [F; 2],
    ) -> ReactionLanes<F> {
        let (a_x, a_y) = (g_x, g_y + G_M_S2);
        let [w1, w2] = equations.squares;
        let q_x = fused(t.q[1], dd_1, -t.q[0] * w1);
        let c_x = fused(t.c[1], dd_2, -t.c[0] * w2);
        let q_y = fused(t.q[0], dd_1, t.q[1] * w1);
        let u_x = fused(t.u[1], dd_2, -t.u[0] * w2);
        let u_y = fused(t.u[0], dd_2, t.u[1] * w2);
        let top = fused(self.m_dp, a_x + q_x + c_x, -equations.spring_and_damping);
        let at_q = [a_x + q_x, a_y - q_y];
        let crack = [fused(self.upper_mass, at_q[0], u_x) + top, fused(self.upper_mass, at_q[1], -u_y)];
        let about_q = fused(t.c[1], top, fused(self.inertias[1], dd_2, moment(t.u, at_q)));
        let w = [fused(-self.upper_mass, t.q[0], t.v[0]), fused(-self.upper_mass, t.q[1], t.v[1])];
        let lower = [
            fused(a_x, self.lower_mass, fused(w[1], dd_1, w[0] * -w1)),
            fused(a_y, self.lower_mass, fused(-w[0], dd_1, w[1] * -w1)),
        ];
        let through_ground = [lower[0] + crack[0], lower[1] + crack[1]];
        let about_o = fused(self.lower_inertia, dd_1, moment(w, [a_x, a_y])) + about_q + moment(t.q, crack);
        let in_crack = [crack[0] * t.cos_1 - crack[1] * t.sin_1, crack[1] * t.cos_1 + crack[0] * t.sin_1];
        ReactionLanes {
            ground: [through_ground[0], through_ground[1], fused(-self.o_x, through_ground[1], about_o)],
            crack: [in_crack[0], in_crack[1], fused(-self.q_x, in_crack[1], about_q)],
            top: [equations.x_c, equations.v_c, q_x + c_x],
        }
    }
}

impl<F: Wide> ReactionLanes<F> {
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

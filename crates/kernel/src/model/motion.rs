//! The equations of motion of one contact state (model section 3), in the scalar form that runs.
//!
//! The static moments are V = m_1 r_1 + (m_2 + m_d) r_Q and U = m_2 r_2 + m_d r_C. With X, Y the components
//! of an arm, Jᵀ M (J θ'' + centripetal + ground) = Jᵀ F becomes:
//!
//! - M_11 = I_1O + m_dp Y_Q²,  M_22 = I_2Q + m_dp Y_C²,  M_12 = r_Q·U + m_dp Y_Q Y_C
//! - f_1 = -(V_y a_x - V_x a_y) + κ ω_2² + Y_Q (F - m_dp a_dp),
//! - f_2 = -(U_y a_x - U_x a_y) - κ ω_1² + Y_C (F - m_dp a_dp),
//!
//! Here κ = Y_Q U_x - X_Q U_y and a_dp = a_x - X_Q ω_1² - X_C ω_2². The latter is the part of the carriage's
//! acceleration that is known before θ''.

use fearless_simd::Level;

use wide::f64x2;

use super::bed::{Acting, BeddedMotion, BeddedRate, JointShape};
use super::contact::{Contact, Joint};
use super::formula::FormulaLaws;
use super::geometry::{Arms, Pair, Rotations};
use super::joint_forces::Masses;
use super::laws::Laws;
use super::mass_matrix::{Freedom, MassMatrix};
use super::vector::{Vector, sin_cos, sin_cos_pair};
use super::wall::{G_M_S2, Wall};
use crate::fused::{fused, fused_pair};
use crate::instructions::dispatch;

/// What the equations of motion give at a state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionRate {
    /// Angular accelerations, rad/s².
    pub theta_dd: Pair,
    /// Work of the ground motion on the wall per time, W.
    pub ground_power_w: f64,
    /// Energy lost in dampers per time, W.
    pub loss_power_w: f64,
}

/// [`MotionRate`] side by side: θ_1'' and θ_2'', the power of the ground and that of losses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RatePair {
    pub theta_dd: f64x2,
    pub powers_w: f64x2,
}

impl From<BeddedRate> for MotionRate {
    fn from(rate: BeddedRate) -> Self {
        let [ground_power_w, loss_power_w] = rate.powers_w;
        Self { theta_dd: rate.theta_dd, ground_power_w, loss_power_w }
    }
}

impl From<RatePair> for MotionRate {
    #[inline]
    fn from(rate: RatePair) -> Self {
        let [ground_power_w, loss_power_w] = rate.powers_w.to_array();
        Self { theta_dd: rate.theta_dd.to_array(), ground_power_w, loss_power_w }
    }
}

/// The equations of motion of one contact state, with everything that does not change in time worked out.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    pub freedom: Freedom,
    /// Whether friction holds the top in place.
    pub(super) held: bool,
    pub(super) o_x: f64,
    /// O less e_C: where the top is at rest, seen from C - O, m.
    pub(super) o_c: f64,
    pub(super) q: Vector,
    pub(super) c: Vector,
    /// V and U at zero rotation, kg m.
    pub(super) v: Vector,
    pub(super) u: Vector,
    pub(super) laws: Laws,
    /// The laws written as formulas.
    pub(super) formulas: FormulaLaws,
    /// Whether the laws have dampers, or formulas.
    pub(super) damped: bool,
    /// x and y of (q, c) and of (V, U) side by side.
    pub(super) lanes: [f64x2; 4],
    /// I_1O and I_2Q: moments of inertia of everything but the carriage, kg m².
    pub(super) inertias: f64x2,
    /// m_1 and m_2 + m_d, kg.
    pub(super) lower_mass: f64,
    pub(super) upper_mass: f64,
    /// Moment of inertia of the lower body about O, kg m².
    pub(super) lower_inertia: f64,
    /// Of a wall that turns as one: C - O and V + U at zero rotation, and the moment of inertia about O.
    pub(super) whole_arm: Vector,
    pub(super) whole_moment: Vector,
    pub(super) whole_inertia: f64,
    /// s_2 b_2/2.
    pub(super) q_x: f64,
    /// The equations in place of these, where joints give.
    pub(super) bedded: Option<Box<BeddedMotion>>,
    /// Instructions that this processor has, which change nothing but the time it takes.
    pub level: Level,
}

/// Arms and static moments turned by the rotations. The first lane is the lower body (r_Q, V), the second the
/// upper (r_C, U). Every term of the equations is made of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Configuration {
    pub(super) sin: f64x2,
    pub(super) cos: f64x2,
    /// X and Y of the arms r_Q and r_C, m.
    pub(super) x: f64x2,
    pub(super) y: f64x2,
    /// x and y of the static moments V and U, kg m.
    pub(super) s_x: f64x2,
    pub(super) s_y: f64x2,
}

/// The equations M θ'' = f in a configuration at given velocities, and what their terms are made of.
pub(super) struct Equations {
    pub(super) mass: MassMatrix,
    pub(super) f: f64x2,
    /// Squares of the angular velocities.
    pub(super) squares: f64x2,
    /// Displacement (m) and velocity (m/s) of the top.
    pub(super) x_c: f64,
    pub(super) v_c: f64,
    /// Force of the damper and of formulas at the top, and with that of the spring, N.
    pub(super) damping: f64,
    pub(super) spring_and_damping: f64,
    /// Moments of dampers and formulas at the joints, on θ_1 and θ_2, N m.
    pub(super) joint_moments: f64x2,
}

impl Configuration {
    /// θ_1 and θ_2, to a rounding.
    fn theta(&self) -> Pair {
        let (sin, cos) = (self.sin.to_array(), self.cos.to_array());
        [0, 1].map(|i| sin[i].atan2(cos[i]))
    }
}

impl Motion {
    pub fn new(wall: &Wall, contact: Contact, laws: Laws) -> Self {
        let arms = Arms::new(wall, contact);
        let [m1, m2] = wall.mass_kg;
        let m_d = wall.parameters().diaphragm_mass_kg;
        let upper_mass = m2 + m_d;
        let masses = Masses::new(wall, laws.carriage_mass_kg);
        let (lower_inertia, [inertia_1, inertia_2], u) = masses.about_pivots(&arms);
        let v = arms.g1 * m1 + arms.q * upper_mass;
        let bedded = wall.rolls().then(|| Box::new(BeddedMotion::new(wall, contact, laws.carriage_mass_kg)));
        Self {
            freedom: bedded.as_ref().map_or(Freedom::of(contact), |bedded| bedded.freedom()),
            held: false,
            o_x: arms.o_x,
            o_c: arms.o_x - wall.parameters().eccentricity_m,
            q: arms.q,
            c: arms.c,
            v,
            u,
            damped: laws.is_damped() || !wall.formulas.is_empty(),
            laws,
            formulas: FormulaLaws::new(wall.formulas.clone()),
            lanes: [[arms.q.x, arms.c.x], [arms.q.y, arms.c.y], [v.x, u.x], [v.y, u.y]].map(f64x2::new),
            inertias: f64x2::new([inertia_1, inertia_2]),
            lower_mass: m1,
            upper_mass,
            lower_inertia,
            whole_arm: arms.q + arms.c,
            whole_moment: v + u,
            whole_inertia: inertia_1 + 2.0 * arms.q.dot(u) + inertia_2,
            q_x: arms.q_x,
            bedded,
            level: Level::new(),
        }
    }

    /// The laws beyond weight and inertia.
    pub fn laws(&self) -> &Laws {
        &self.laws
    }

    /// Puts other laws at the top, and holds it in place or lets it go.
    pub fn set_laws(&mut self, laws: Laws, held: bool) {
        self.damped = laws.is_damped() || !self.formulas.is_empty();
        self.laws = laws;
        self.held = held && self.freedom != Freedom::None;
    }

    /// Whether [`Motion::monolithic_rate`] gives the rate.
    #[inline(always)]
    pub fn turns_as_one(&self) -> bool {
        self.freedom == Freedom::Monolithic && !self.held && self.bedded.is_none()
    }

    /// Everything turned by the rotations, outside of a step.
    pub fn configuration_at(&self, theta: Pair) -> Configuration {
        dispatch!(self.level, _ => self.configuration(f64x2::new(theta)))
    }

    /// Rotations everything by the rotations.
    #[inline(always)]
    pub fn configuration(&self, theta: f64x2) -> Configuration {
        let (sin, cos) = sin_cos_pair(theta);
        self.configuration_from(sin, cos)
    }

    #[inline(always)]
    fn configuration_from(&self, sin: f64x2, cos: f64x2) -> Configuration {
        let [arm_x, arm_y, moment_x, moment_y] = self.lanes;
        Configuration {
            sin,
            cos,
            x: arm_x * cos + arm_y * sin,
            y: arm_y * cos - arm_x * sin,
            s_x: moment_x * cos + moment_y * sin,
            s_y: moment_y * cos - moment_x * sin,
        }
    }

    #[inline(always)]
    pub(super) fn mass_matrix_of(&self, t: &Configuration) -> MassMatrix {
        let m_dp = self.laws.carriage_mass_kg;
        let ([x_q, _], [y_q, y_c]) = (t.x.to_array(), t.y.to_array());
        let ([_, u_x], [_, u_y]) = (t.s_x.to_array(), t.s_y.to_array());
        let [m11, m22] = (self.inertias + t.y * t.y * m_dp).to_array();
        MassMatrix { m11, m12: (x_q * u_x + y_q * u_y) + m_dp * y_q * y_c, m22 }
    }

    /// Mass matrix Jᵀ M J at these rotations, whether they are free or not.
    #[inline(always)]
    pub fn mass_matrix(&self, rotations: Rotations) -> MassMatrix {
        if let Some(bedded) = &self.bedded {
            return bedded.mass_matrix(rotations);
        }
        let Rotations([(sin_1, cos_1), (sin_2, cos_2)]) = rotations;
        self.mass_matrix_of(&self.configuration_from(f64x2::new([sin_1, sin_2]), f64x2::new([cos_1, cos_2])))
    }

    /// Angular accelerations and powers at a state, under a ground acceleration in m/s² (y without gravity).
    pub fn rate(&self, theta: Pair, omega: Pair, ground: Vector) -> MotionRate {
        if let Some(bedded) = &self.bedded {
            return bedded.rate(self, [theta, omega], ground, &mut None).into();
        }
        let (theta, omega) = (f64x2::new(theta), f64x2::new(omega));
        dispatch!(self.level, _ => self.rate_at(&self.configuration(theta), omega, ground)).into()
    }

    /// Whether a joint gives.
    #[inline]
    pub fn is_bedded(&self) -> bool {
        self.bedded.is_some()
    }

    /// Gives a joint of a wall whose joints give another shape.
    pub fn reshape(&mut self, joint: Joint, shape: JointShape) {
        if let Some(bedded) = &mut self.bedded {
            bedded.reshape(joint, shape);
        }
    }

    /// The equations of a wall whose joints give.
    #[inline]
    pub fn on_beds(&self) -> Option<&BeddedMotion> {
        self.bedded.as_deref()
    }

    /// The same in a configuration that is known.
    #[inline(always)]
    pub fn rate_at(&self, t: &Configuration, omega: f64x2, ground: Vector) -> RatePair {
        self.rate_by(&self.equations(t, omega, ground), t, omega, ground)
    }

    /// The rate of a wall that turns as one: pattern 3 and the uncracked wall. Most of the time is spent
    /// there. It has one arm r = r_Q + r_C and one static moment W = V + U.
    #[inline(always)]
    pub fn monolithic_rate(&self, theta: f64, omega: f64, ground: Vector) -> RatePair {
        let turn = sin_cos(theta);
        let r = self.whole_arm.rotated(turn);
        let w = self.whole_moment.rotated(turn);
        let m_dp = self.laws.carriage_mass_kg;
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let v_c = r.y * omega;
        let carriage_acceleration = fused(-r.x, omega * omega, a_x);
        let x_c_m = r.x + self.o_c;
        let mut top = self.laws.spring_force_n(x_c_m) - m_dp * carriage_acceleration;
        let mut weight_and_ground = fused(w.x, a_y, -w.y * a_x);
        let mut loss_power_w = 0.0;
        if self.damped {
            let damping = self.damping_force_n(x_c_m, v_c);
            let [joint, _] = self.joint_moments_n_m(|| [theta; 2], f64x2::splat(omega)).to_array();
            top += damping;
            weight_and_ground += joint;
            loss_power_w = -fused(damping, v_c, joint * omega);
        }
        // The inverse is ready before the forces are.
        let inverse = 1.0 / fused(m_dp * r.y, r.y, self.whole_inertia);
        let theta_dd = fused(r.y, top, weight_and_ground) * inverse;
        let momentum_x = fused(w.y, omega, m_dp * v_c);
        let ground_power_w = fused(ground.y * w.x, omega, -ground.x * momentum_x);
        RatePair { theta_dd: f64x2::splat(theta_dd), powers_w: f64x2::new([ground_power_w, loss_power_w]) }
    }

    #[inline(always)]
    pub(super) fn equations(&self, t: &Configuration, omega: f64x2, ground: Vector) -> Equations {
        let ([x_q, x_c], [y_q, _]) = (t.x.to_array(), t.y.to_array());
        let ([_, u_x], [_, u_y]) = (t.s_x.to_array(), t.s_y.to_array());
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let squares = omega * omega;
        let [w1, w2] = squares.to_array();
        let x_c_m = (x_q + x_c) + self.o_c;
        let [v_q, v_qc] = (t.y * omega).to_array();
        let v_c = v_q + v_qc;
        let [c_q, c_qc] = (t.x * squares).to_array();
        let spring = self.laws.spring_force_n(x_c_m);
        let m_dp = self.laws.carriage_mass_kg;
        let carriage_acceleration = a_x - c_q - c_qc;
        let kappa = y_q * u_x - x_q * u_y;
        let weight_and_ground = fused_pair(t.s_x, f64x2::splat(a_y), -t.s_y * a_x);
        let forces = fused_pair(f64x2::splat(kappa), f64x2::new([w2, -w1]), weight_and_ground);
        let mass = self.mass_matrix_of(t);
        let equations = Equations {
            mass,
            f: forces,
            squares,
            x_c: x_c_m,
            v_c,
            damping: 0.0,
            spring_and_damping: spring,
            joint_moments: f64x2::ZERO,
        };
        if !self.damped {
            let top = spring - m_dp * carriage_acceleration;
            return Equations { f: fused_pair(t.y, f64x2::splat(top), forces), ..equations };
        }
        let damping = self.damping_force_n(x_c_m, v_c);
        let top = spring + damping - m_dp * carriage_acceleration;
        let joint_moments = self.joint_moments_n_m(|| t.theta(), omega);
        let f = fused_pair(t.y, f64x2::splat(top), forces) + joint_moments;
        Equations { f, damping, spring_and_damping: spring + damping, joint_moments, ..equations }
    }

    /// Force at the top against its velocity, N, and that of formulas.
    #[inline(always)]
    fn damping_force_n(&self, x_c_m: f64, v_c_m_s: f64) -> f64 {
        let damping = self.laws.damping_force_n(v_c_m_s);
        if self.formulas.is_empty() { damping } else { damping + self.formulas.top_force_n(x_c_m, v_c_m_s) }
    }

    /// Moments of the joint dampers on θ_1 and θ_2, N m, and those of formulas.
    #[inline(always)]
    fn joint_moments_n_m(&self, theta: impl Fn() -> Pair, omega: f64x2) -> f64x2 {
        let damping = self.laws.joint_moments_n_m(omega);
        if self.formulas.is_empty() {
            return damping;
        }
        damping + f64x2::new(self.formulas.joint_moments_n_m(theta, omega.to_array()))
    }

    #[inline(always)]
    pub(super) fn rate_by(
        &self,
        equations: &Equations,
        t: &Configuration,
        omega: f64x2,
        ground: Vector,
    ) -> RatePair {
        let [p_1, p_2] = (t.s_y * omega).to_array();
        let [l_1, l_2] = (t.s_x * omega).to_array();
        let momentum_x = fused(self.laws.carriage_mass_kg, equations.v_c, p_1 + p_2);
        let ground_power_w = fused(ground.y, l_1 + l_2, -ground.x * momentum_x);
        let loss_power_w = if self.damped {
            let [j_1, j_2] = (equations.joint_moments * omega).to_array();
            -fused(equations.damping, equations.v_c, j_1 + j_2)
        } else {
            0.0
        };
        let mut theta_dd = equations.mass.solve(self.freedom, equations.f.to_array());
        if self.held {
            theta_dd = self.with_held_top(equations, t, theta_dd).0;
        }
        RatePair { theta_dd: f64x2::new(theta_dd), powers_w: f64x2::new([ground_power_w, loss_power_w]) }
    }
}

impl Acting<f64> for Motion {
    #[inline(always)]
    fn spring_force_n(&self, x_c_m: f64) -> f64 {
        self.laws.spring_force_n(x_c_m)
    }

    #[inline(always)]
    fn damping_force_n(&self, x_c_m: f64, v_c_m_s: f64) -> f64 {
        Motion::damping_force_n(self, x_c_m, v_c_m_s)
    }

    #[inline(always)]
    fn joint_moments_n_m(&self, theta: Pair, omega: Pair) -> Pair {
        Motion::joint_moments_n_m(self, || theta, f64x2::new(omega)).to_array()
    }
}

//! The motion of one contact state of one wall: on sharp edges by the equations of [`super::sharp`], on beds by those of
//! [`super::bed`].

use fearless_simd::Level;

use wide::f64x2;

use super::bed::{Acting, BeddedMotion, BeddedRate, JointShape};
use super::contact::{Contact, Joint};
use super::formula::FormulaLaws;
use super::geometry::{Arms, Pair, Rotations, TurnedArms};
use super::joint_forces::{Masses, Reactions};
use super::laws::Laws;
use super::mass_matrix::{Freedom, MassMatrix};
use super::sharp::{Configuration, Equations, SharpMotion, TopLaws};
use super::vector::{Vector, sin_cos, sin_cos_pair};
use super::wall::Wall;
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
    /// The equations on sharp edges.
    pub sharp: SharpMotion,
    pub(super) laws: Laws,
    /// The laws written as formulas.
    pub(super) formulas: FormulaLaws,
    /// Whether the laws have dampers, or formulas.
    pub(super) damped: bool,
    /// The equations in place of these, where joints give.
    pub(super) bedded: Option<Box<BeddedMotion>>,
    /// Instructions that this processor has, which change nothing but the time it takes.
    pub level: Level,
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
        let sharp = SharpMotion {
            o_x: arms.o_x,
            o_c: arms.o_x - wall.parameters().eccentricity_m,
            q_x: arms.q_x,
            q: arms.q,
            c: arms.c,
            v,
            u,
            inertias: [inertia_1, inertia_2],
            lower_mass: m1,
            upper_mass,
            lower_inertia,
            whole_arm: arms.q + arms.c,
            whole_moment: v + u,
            whole_inertia: inertia_1 + 2.0 * arms.q.dot(u) + inertia_2,
            m_dp: laws.carriage_mass_kg,
        };
        Self {
            freedom: bedded.as_ref().map_or(Freedom::of(contact), |bedded| bedded.freedom()),
            held: false,
            sharp,
            damped: laws.is_damped() || !wall.formulas.is_empty(),
            laws,
            formulas: FormulaLaws::new(wall.formulas.clone()),
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
        self.sharp.m_dp = laws.carriage_mass_kg;
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

    /// Everything turned by the rotations.
    #[inline(always)]
    pub fn configuration(&self, theta: f64x2) -> Configuration {
        let (sin, cos) = sin_cos_pair(theta);
        let ([sin_1, sin_2], [cos_1, cos_2]) = (sin.to_array(), cos.to_array());
        self.sharp.turned([(sin_1, cos_1), (sin_2, cos_2)])
    }

    /// Mass matrix Jᵀ M J at these rotations, whether they are free or not.
    #[inline(always)]
    pub fn mass_matrix(&self, rotations: Rotations) -> MassMatrix {
        if let Some(bedded) = &self.bedded {
            return bedded.mass_of(&bedded.turned_arms(self, rotations));
        }
        self.sharp.mass_matrix(&self.sharp.turned(rotations.turns))
    }

    /// The same by the arms turned by these rotations, of which that on beds is made.
    #[inline(always)]
    pub fn mass_matrix_by(&self, arms: &TurnedArms, rotations: Rotations) -> MassMatrix {
        match &self.bedded {
            Some(bedded) => bedded.mass_of(arms),
            None => self.mass_matrix(rotations),
        }
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
        let equations = self.sharp.equations(self, t, omega.to_array(), ground);
        self.rate_by(&equations, t, omega.to_array(), ground)
    }

    /// The rate of a wall that turns as one.
    #[inline(always)]
    pub fn monolithic_rate(&self, theta: f64, omega: f64, ground: Vector) -> RatePair {
        let (theta_dd, powers_w) = self.sharp.monolithic_rate(self, (theta, sin_cos(theta)), omega, ground);
        RatePair { theta_dd: f64x2::splat(theta_dd), powers_w: f64x2::new(powers_w) }
    }

    /// The rate and the reactions in a configuration, as a run needs them after every step.
    #[inline(always)]
    pub fn rate_and_reactions(
        &self,
        t: &Configuration,
        omega: f64x2,
        ground: Vector,
    ) -> (RatePair, Reactions) {
        let equations = self.sharp.equations(self, t, omega.to_array(), ground);
        let rate = self.rate_by(&equations, t, omega.to_array(), ground);
        (rate, self.reactions_by(&equations, t, rate.theta_dd.to_array(), ground))
    }

    /// The same at a state.
    #[inline(always)]
    pub fn rate_and_reactions_at(&self, theta: Pair, omega: Pair, ground: Vector) -> (MotionRate, Reactions) {
        if let Some(bedded) = &self.bedded {
            let (rate, reactions) = bedded.rate_and_reactions(self, [theta, omega], ground, &mut None);
            return (rate.into(), reactions);
        }
        let (theta, omega) = (f64x2::new(theta), f64x2::new(omega));
        let (rate, reactions) =
            dispatch!(self.level, _ => self.rate_and_reactions(&self.configuration(theta), omega, ground));
        (rate.into(), reactions)
    }

    /// Joint forces and motion of the top at a state with these angular accelerations.
    pub fn reactions(&self, theta: Pair, omega: Pair, theta_dd: Pair, ground: Vector) -> Reactions {
        if let Some(bedded) = &self.bedded {
            return bedded.reactions(self, [theta, omega], theta_dd, ground);
        }
        dispatch!(self.level, _ => {
            let t = self.configuration(f64x2::new(theta));
            self.reactions_by(&self.sharp.equations(self, &t, omega, ground), &t, theta_dd, ground)
        })
    }

    #[inline(always)]
    fn rate_by(
        &self,
        equations: &Equations<f64>,
        t: &Configuration,
        omega: Pair,
        ground: Vector,
    ) -> RatePair {
        let powers_w = self.sharp.powers_w(self, equations, t, omega, ground);
        let mut theta_dd = equations.mass.solve(self.freedom, equations.f);
        if self.held {
            theta_dd = self.with_held_top(equations, t, theta_dd).0;
        }
        RatePair { theta_dd: f64x2::new(theta_dd), powers_w: f64x2::new(powers_w) }
    }

    #[inline(always)]
    fn reactions_by(
        &self,
        equations: &Equations<f64>,
        t: &Configuration,
        theta_dd: Pair,
        ground: Vector,
    ) -> Reactions {
        let holding_n = match self.held {
            true => self.with_held_top(equations, t, equations.mass.solve(self.freedom, equations.f)).1,
            false => 0.0,
        };
        let at_top = [equations.spring_and_damping + holding_n, holding_n];
        self.sharp.reactions(equations, t, theta_dd, ground, at_top)
    }
}

impl Acting<f64> for Motion {
    #[inline(always)]
    fn spring_force_n(&self, x_c_m: f64) -> f64 {
        self.laws.spring_force_n(x_c_m)
    }

    #[inline(always)]
    fn damping_force_n(&self, x_c_m: f64, v_c_m_s: f64) -> f64 {
        let damping = self.laws.damping_force_n(v_c_m_s);
        if self.formulas.is_empty() { damping } else { damping + self.formulas.top_force_n(x_c_m, v_c_m_s) }
    }

    #[inline(always)]
    fn joint_moments_n_m(&self, theta: impl Fn() -> Pair, omega: Pair) -> Pair {
        let [lower, upper] = self.laws.joint_moments_n_m(omega);
        if self.formulas.is_empty() {
            return [lower, upper];
        }
        let [further_lower, further_upper] = self.formulas.joint_moments_n_m(theta, omega);
        [lower + further_lower, upper + further_upper]
    }
}

impl TopLaws<f64> for Motion {
    #[inline(always)]
    fn has_dampers(&self) -> bool {
        self.damped
    }

    #[inline(always)]
    fn with(&self, number: f64, further: f64) -> f64 {
        if self.damped { number + further } else { number }
    }

    #[inline(always)]
    fn where_damped(&self, number: f64) -> f64 {
        if self.damped { number } else { 0.0 }
    }
}

//! Forces and impulses through the joints by d'Alembert's balance of everything above (model section 4).
//!
//! Impulses are balanced over the mass points. Forces, which a run needs after every step, are balanced in
//! the static moments of [`super::motion`].

use wide::f64x2;

use super::contact::Joint;
use super::geometry::{Arms, Pair, PointVelocities, TurnedArms};
use super::motion::{Configuration, Equations, Motion, MotionRate, RatePair};
use super::number::Number;
use super::vector::Vector;
use super::wall::{G_M_S2, Wall};
use crate::fused::{fused, fused_pair};
use crate::instructions::dispatch;

/// Force through a joint and its moment about the joint's middle: newtons and newton metres,
/// or their impulses.
///
/// `normal` and `shear` are taken in the axes of the joint, which turns with the body below it. Only so does
/// a corner force vanish exactly when the joint starts to open about the other corner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForce<N = f64> {
    /// Along the joint, towards +x.
    pub shear: N,
    /// Across the joint, compression positive.
    pub normal: N,
    /// Clockwise moment about the middle of the joint.
    pub moment: N,
}

impl JointForce {
    /// Forces at the left and right corners of a joint of width b: N/2 ± M_c/b.
    #[inline]
    pub fn corners(&self, width_m: f64) -> [f64; 2] {
        let half = self.normal / 2.0;
        let lever = self.moment / width_m;
        [half + lever, half - lever]
    }
}

/// Forces through both joints.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointForces<N = f64> {
    /// Through the ground.
    pub ground: JointForce<N>,
    /// Through the crack.
    pub crack: JointForce<N>,
}

impl JointForces {
    pub(crate) fn at(&self, joint: Joint) -> &JointForce {
        match joint {
            Joint::Ground => &self.ground,
            Joint::Crack => &self.crack,
        }
    }
}

/// Masses as they enter the balance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Masses<N = f64> {
    pub m: [N; 2],
    pub i: [N; 2],
    pub m_d: N,
    pub m_dp: N,
}

impl Masses {
    pub fn new(wall: &Wall, carriage_mass_kg: f64) -> Self {
        let m_d = wall.parameters().diaphragm_mass_kg;
        Self { m: wall.mass_kg, i: wall.inertia_kg_m2, m_d, m_dp: carriage_mass_kg }
    }

    /// Impulses through the joints that make the mass points' velocities jump so.
    #[inline(always)]
    pub fn impulses(&self, arms: &TurnedArms, jump: &PointVelocities) -> JointForces {
        self.through_joints(arms, jump, 0.0)
    }
}

impl<N: Number> Masses<N> {
    /// I_1O and I_2Q, the moments of inertia of everything but the carriage about the pivots, kg m², and U at zero
    /// rotation, kg m. I_1O is that of the lower body about O, which is given too, and of what it carries.
    #[inline(always)]
    pub fn about_pivots(&self, arms: &Arms<N>) -> (N, [N; 2], Vector<N>) {
        let Self { m: [m1, m2], i: [i1, i2], m_d, .. } = *self;
        let lower = i1 + m1 * arms.g1.dot(arms.g1);
        let first = lower + (m2 + m_d) * arms.q.dot(arms.q);
        let second = i2 + m2 * arms.g2.dot(arms.g2) + m_d * arms.c.dot(arms.c);
        (lower, [first, second], arms.g2 * m2 + arms.c * m_d)
    }

    /// Forces through the joints at these accelerations of the mass points, gravity's in them, m/s², beside a
    /// horizontal force at the top, N. Or impulses by jumps of their velocities.
    #[inline(always)]
    pub fn through_joints(
        &self,
        arms: &TurnedArms<N>,
        jump: &PointVelocities<N>,
        at_top: N,
    ) -> JointForces<N> {
        let p = arms;
        let lower = jump.g1 * self.m[0];
        let upper = jump.g2 * self.m[1];
        // The carriage counts in x only.
        let top = Vector::new((self.m_d + self.m_dp) * jump.c.x - at_top, self.m_d * jump.c.y);
        let through_crack = upper + top;
        let about_q = p.r_2.moment_of(upper) + self.i[1] * jump.theta[1] + p.r_c.moment_of(top);
        let about_middle = about_q + p.q_from_middle.moment_of(through_crack);
        let through_ground = lower + through_crack;
        let about_o =
            p.r_1.moment_of(lower) + self.i[0] * jump.theta[0] + about_q + p.r_q.moment_of(through_crack);
        let about_origin = about_o + Vector::new(p.o_x, p.o_x.constant(0.0)).moment_of(through_ground);
        let in_crack = through_crack.rotated_back(p.turn_1);
        JointForces {
            ground: JointForce { shear: through_ground.x, normal: through_ground.y, moment: about_origin },
            crack: JointForce { shear: in_crack.x, normal: in_crack.y, moment: about_middle },
        }
    }

    /// Sum of the masses times the magnitudes of their velocities, N s.
    #[inline(always)]
    pub fn momentum_size(&self, v: &PointVelocities<N>) -> N {
        let speed = |v: Vector<N>| v.x.magnitude() + v.y.magnitude();
        self.m[0] * speed(v.g1) + self.m[1] * speed(v.g2) + (self.m_d + self.m_dp) * speed(v.c)
    }

    /// Power of a uniform acceleration on the masses, W: Σ m v · a, of the carriage in x only.
    #[inline(always)]
    pub fn power(&self, v: &PointVelocities<N>, a: Vector<N>) -> N {
        let momentum = v.g1 * self.m[0] + v.g2 * self.m[1] + v.c * self.m_d;
        momentum.dot(a) + self.m_dp * v.c.x * a.x
    }

    /// Generalised momenta Jᵀ M v in a contact state, for velocities of the mass points before the impact.
    #[inline(always)]
    pub fn momenta(&self, arms: &TurnedArms<N>, v: &PointVelocities<N>) -> [N; 2] {
        let p = arms;
        let lower = v.g1 * self.m[0];
        let upper = v.g2 * self.m[1];
        let top = Vector::new((self.m_d + self.m_dp) * v.c.x, self.m_d * v.c.y);
        [
            p.r_1.moment_of(lower) + self.i[0] * v.theta[0] + p.r_q.moment_of(upper + top),
            p.r_2.moment_of(upper) + self.i[1] * v.theta[1] + p.r_c.moment_of(top),
        ]
    }
}

/// Joint forces and motion of the top at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reactions<N = f64> {
    pub forces: JointForces<N>,
    pub top_displacement_m: N,
    pub top_velocity_m_s: N,
    /// Relative to the ground, m/s².
    pub top_acceleration_m_s2: N,
    /// Force by which friction holds the top in place, N; 0 where it does not.
    pub holding_n: N,
}

impl Motion {
    /// The rate and the reactions in a configuration, as a run needs them after every step.
    #[inline(always)]
    pub fn rate_and_reactions(
        &self,
        t: &Configuration,
        omega: f64x2,
        ground: Vector,
    ) -> (RatePair, Reactions) {
        let equations = self.equations(t, omega, ground);
        let rate = self.rate_by(&equations, t, omega, ground);
        (rate, self.reactions_by(&equations, t, rate.theta_dd, ground))
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
        let [theta, omega, theta_dd] = [theta, omega, theta_dd].map(f64x2::new);
        dispatch!(self.level, _ => {
            let t = self.configuration(theta);
            self.reactions_by(&self.equations(&t, omega, ground), &t, theta_dd, ground)
        })
    }

    /// The balance of [`super::joint`], in the static moments of this file.
    #[inline(always)]
    fn reactions_by(
        &self,
        equations: &Equations,
        t: &Configuration,
        theta_dd: f64x2,
        ground: Vector,
    ) -> Reactions {
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let m_dp = self.laws.carriage_mass_kg;
        let pair = |v: f64x2| v.to_array();
        let along =
            |arm: f64x2, towards: f64x2| fused_pair(arm, theta_dd, towards * equations.squares).to_array();
        // J θ'' and centripetal: accelerations of the ends of the arms, forces of inertia of U.
        let ([q_x, c_x], [q_y, _]) = (along(t.y, -t.x), along(t.x, t.y));
        let ([_, u_x], [_, u_y]) = (along(t.s_y, -t.s_x), along(t.s_x, t.s_y));
        let holding_n = match self.held {
            true => {
                self.with_held_top(equations, t, equations.mass.solve(self.freedom, equations.f.to_array())).1
            }
            false => 0.0,
        };
        let top = fused(m_dp, a_x + q_x + c_x, -(equations.spring_and_damping + holding_n));
        let at_q = Vector::new(a_x + q_x, a_y - q_y);
        let through_crack =
            Vector::new(fused(self.upper_mass, at_q.x, u_x) + top, fused(self.upper_mass, at_q.y, -u_y));
        let ([x_q, _], [y_q, y_c]) = (pair(t.x), pair(t.y));
        let ([v_x, u_0x], [v_y, u_0y]) = (pair(t.s_x), pair(t.s_y));
        let [dd_1, dd_2] = pair(theta_dd);
        let [_, inertia_2] = pair(self.inertias);
        let about_q = fused(y_c, top, fused(inertia_2, dd_2, Vector::new(u_0x, u_0y).moment_of(at_q)));
        // The static moment of the lower body alone.
        let w = Vector::new(fused(-self.upper_mass, x_q, v_x), fused(-self.upper_mass, y_q, v_y));
        let with_gravity = Vector::new(a_x, a_y);
        let [w1, _] = pair(equations.squares);
        let turning = w.perpendicular().times_plus(dd_1, w * -w1);
        let lower = with_gravity.times_plus(self.lower_mass, turning);
        let through_ground = lower + through_crack;
        let about_o = fused(self.lower_inertia, dd_1, w.moment_of(with_gravity))
            + about_q
            + Vector::new(x_q, y_q).moment_of(through_crack);
        let in_crack = through_crack.rotated_back((t.sin.to_array()[0], t.cos.to_array()[0]));
        let forces = JointForces {
            ground: JointForce {
                shear: through_ground.x,
                normal: through_ground.y,
                moment: fused(-self.o_x, through_ground.y, about_o),
            },
            crack: JointForce {
                shear: in_crack.x,
                normal: in_crack.y,
                moment: fused(-self.q_x, in_crack.y, about_q),
            },
        };
        Reactions {
            forces,
            top_displacement_m: equations.x_c,
            top_velocity_m_s: equations.v_c,
            top_acceleration_m_s2: q_x + c_x,
            holding_n,
        }
    }
}

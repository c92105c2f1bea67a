//! The forces through the joints at a state of motion, in the static moments of [`super::motion`]: what a run asks for after
//! every step.

use fearless_simd::dispatch;
use wide::f64x2;

use super::joint::{JointForce, JointForces};
use super::motion::{Law, Motion, MotionRate, RatePair, Turned};
use super::posture::Pair;
use super::vector::Vector;
use super::wall::G_M_S2;
use crate::fused::{fused, fused_pair};

/// Joint forces and motion of the top at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Aftermath {
    pub forces: JointForces,
    pub top_displacement_m: f64,
    pub top_velocity_m_s: f64,
    /// Relative to the ground, m/s².
    pub top_acceleration_m_s2: f64,
    /// Force by which friction holds the top in place, N; 0 where it does not.
    pub holding_n: f64,
}

impl Motion {
    /// The rate at a posture and what comes of it: what a run asks for after every step.
    #[inline(always)]
    pub fn arrival(&self, t: &Turned, omega: f64x2, ground: Vector) -> (RatePair, Aftermath) {
        let law = self.law(t, omega, ground);
        let rate = self.rate_by(&law, t, omega, ground);
        (rate, self.aftermath_by(&law, t, rate.theta_dd, ground))
    }

    /// The same at a state.
    pub fn arrival_at(&self, theta: Pair, omega: Pair, ground: Vector) -> (MotionRate, Aftermath) {
        let (theta, omega) = (f64x2::new(theta), f64x2::new(omega));
        let (rate, after) = dispatch!(self.level, _ => self.arrival(&self.turned(theta), omega, ground));
        (rate.into(), after)
    }

    /// Joint forces and motion of the top at a state with these angular accelerations.
    pub fn aftermath(&self, theta: Pair, omega: Pair, theta_dd: Pair, ground: Vector) -> Aftermath {
        let [theta, omega, theta_dd] = [theta, omega, theta_dd].map(f64x2::new);
        dispatch!(self.level, _ => {
            let t = self.turned(theta);
            self.aftermath_by(&self.law(&t, omega, ground), &t, theta_dd, ground)
        })
    }

    /// The balance of [`super::joint`], in the static moments of this file.
    #[inline(always)]
    fn aftermath_by(&self, law: &Law, t: &Turned, theta_dd: f64x2, ground: Vector) -> Aftermath {
        let (a_x, a_y) = (ground.x, ground.y + G_M_S2);
        let m_dp = self.laws.carriage_mass_kg;
        let pair = |v: f64x2| v.to_array();
        let along = |arm: f64x2, towards: f64x2| fused_pair(arm, theta_dd, towards * law.squares).to_array();
        // J θ'' and centripetal: accelerations of the ends of the arms, forces of inertia of U.
        let ([q_x, c_x], [q_y, _]) = (along(t.y, -t.x), along(t.x, t.y));
        let ([_, u_x], [_, u_y]) = (along(t.s_y, -t.s_x), along(t.s_x, t.s_y));
        let holding_n = match self.held {
            true => self.held(law, t, law.mass.solve(self.freedom, law.f.to_array())).1,
            false => 0.0,
        };
        let top = fused(m_dp, a_x + q_x + c_x, -(law.spring_and_damping + holding_n));
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
        let [w1, _] = pair(law.squares);
        let turning = w.turned().times_plus(dd_1, w * -w1);
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
        Aftermath {
            forces,
            top_displacement_m: law.x_c,
            top_velocity_m_s: law.v_c,
            top_acceleration_m_s2: q_x + c_x,
            holding_n,
        }
    }
}

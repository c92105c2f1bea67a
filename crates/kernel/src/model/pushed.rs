//! What a force at the top, or a pair of angular accelerations, comes to in the equations of motion of a contact state.

use super::contact::Contact;
use super::posture::{Pair, Turns};
use super::rocking::RockingWall;

impl RockingWall {
    /// J_x = ∂x_C/∂θ: how far the top moves sideways as each body turns, m; a horizontal force there times it is its
    /// moment pair.
    pub fn top_arms_m(&self, contact: Contact, theta: Pair) -> Pair {
        let motion = self.motion(contact);
        [[1.0, 0.0], [0.0, 1.0]].map(|omega| motion.top(theta, omega, [0.0; 2])[1])
    }

    /// Angular accelerations of the free bodies by a horizontal force of 1 N at the top, M⁻¹ J_x, rad/s².
    pub fn accelerations_by_force(&self, contact: Contact, theta: Pair) -> Pair {
        let motion = self.motion(contact);
        motion.mass_matrix(Turns::new(theta)).solve(motion.freedom, self.top_arms_m(contact, theta))
    }

    /// The pair of moments M θ'' that angular accelerations ask for, N m.
    pub fn moments_n_m(&self, contact: Contact, theta: Pair, theta_dd: Pair) -> Pair {
        let m = self.motion(contact).mass_matrix(Turns::new(theta));
        let [a1, a2] = theta_dd;
        [m.m11 * a1 + m.m12 * a2, m.m12 * a1 + m.m22 * a2]
    }
}

impl RockingWall {
    /// Force of everything at the top that acts by its displacement (m) and velocity (m/s), N; a spring that yields has
    /// this plastic displacement, m, before.
    pub fn top_force_n(&self, x_c_m: f64, v_c_m_s: f64, plastic_m: f64) -> f64 {
        let laws = match &self.restraint {
            Some(restraint) => restraint.laws(&restraint.regime_at(x_c_m, v_c_m_s, plastic_m)),
            None => *self.motions[0].laws(),
        };
        laws.spring_force_n(x_c_m) + laws.damping_force_n(v_c_m_s)
    }

    /// m_dp with what effects add to it, kg.
    pub fn carriage_mass_kg(&self) -> f64 {
        self.motions[0].laws().carriage_mass_kg
    }
}

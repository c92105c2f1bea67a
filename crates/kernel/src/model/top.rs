//! The top C: its displacement and velocity, what a force there does, and the motion while friction holds it.

use super::contact::Contact;
use super::geometry::{Pair, Rotations};
use super::mass_matrix::Freedom;
use super::motion::Motion;
use super::regime::TopMemory;
use super::rocking::RockingWall;
use super::sharp::{Configuration, Equations};

impl Motion {
    /// The motion with the top held in place, a_C = 0, and the force by which friction holds it, N.
    ///
    /// The force λ makes θ'' = θ''_0 + M⁻¹ Jᵀ λ of the accelerations θ''_0 without it, with J = (Y_Q, Y_C).
    /// So λ = -a_C0 / (J M⁻¹ Jᵀ). What can move in one way only does not move.
    #[cold]
    #[inline(never)]
    pub(super) fn with_held_top(
        &self,
        equations: &Equations<f64>,
        t: &Configuration,
        theta_dd: Pair,
    ) -> (Pair, f64) {
        let [w1, w2] = equations.squares;
        let free = (t.q.y * theta_dd[0] - t.q.x * w1) + (t.c.y * theta_dd[1] - t.c.x * w2);
        let push = [t.q.y, t.c.y];
        let per_force = equations.mass.solve(self.freedom, push);
        let holding_n = -free / (push[0] * per_force[0] + push[1] * per_force[1]);
        let theta_dd = match self.freedom {
            Freedom::Both => [0, 1].map(|i| theta_dd[i] + per_force[i] * holding_n),
            _ => [0.0; 2],
        };
        (theta_dd, holding_n)
    }

    /// Displacement (m), velocity (m/s) and acceleration (m/s²) of the top, all relative to the ground.
    pub fn top(&self, theta: Pair, omega: Pair, theta_dd: Pair) -> [f64; 3] {
        if let Some(bedded) = &self.bedded {
            return bedded.top(theta, omega, theta_dd);
        }
        let t = self.configuration_at(theta);
        let ([w1, w2], [dd_1, dd_2]) = (omega, theta_dd);
        let acceleration = (t.q.y * dd_1 - t.q.x * (w1 * w1)) + (t.c.y * dd_2 - t.c.x * (w2 * w2));
        [self.sharp.top_displacement_m(&t), t.q.y * w1 + t.c.y * w2, acceleration]
    }

    /// The velocities without those of the top: what can move in one way only stops.
    pub fn with_top_stopped(&self, theta: Pair, omega: Pair) -> Pair {
        if self.freedom != Freedom::Both {
            return [0.0; 2];
        }
        let [y_q, y_c] = match &self.bedded {
            Some(bedded) => bedded.top_levers_m(theta),
            None => {
                let t = self.configuration_at(theta);
                [t.q.y, t.c.y]
            }
        };
        let share = (y_q * omega[0] + y_c * omega[1]) / (y_q * y_q + y_c * y_c);
        [omega[0] - share * y_q, omega[1] - share * y_c]
    }

    /// Largest speed the top could have at velocities of these sizes, m/s: what its roundings are relative
    /// to.
    pub fn top_speed_size(&self, omega: Pair) -> f64 {
        self.sharp.q.y * omega[0].abs() + self.sharp.c.y * omega[1].abs()
    }
}

impl RockingWall {
    /// J_x = ∂x_C/∂θ, m: how far the top moves sideways as each body turns. A horizontal force there times
    /// J_x is its pair of moments.
    pub fn top_arms_m(&self, contact: Contact, theta: Pair) -> Pair {
        let motion = self.motion(contact);
        [[1.0, 0.0], [0.0, 1.0]].map(|omega| motion.top(theta, omega, [0.0; 2])[1])
    }

    /// Angular accelerations of the free bodies by a horizontal force of 1 N at the top, M⁻¹ J_x, rad/s².
    pub fn accelerations_by_force(&self, contact: Contact, theta: Pair) -> Pair {
        self.accelerations_by_moments(contact, theta, self.top_arms_m(contact, theta))
    }

    /// Angular accelerations of the free bodies by a pair of moments, N m: M⁻¹ of them, rad/s².
    pub fn accelerations_by_moments(&self, contact: Contact, theta: Pair, moments_n_m: Pair) -> Pair {
        let motion = self.motion(contact);
        motion.mass_matrix(Rotations::new(theta)).solve(motion.freedom, moments_n_m)
    }

    /// The pair of moments M θ'' that these angular accelerations need, N m.
    pub fn moments_n_m(&self, contact: Contact, theta: Pair, theta_dd: Pair) -> Pair {
        let m = self.motion(contact).mass_matrix(Rotations::new(theta));
        let [a1, a2] = theta_dd;
        [m.m11 * a1 + m.m12 * a2, m.m12 * a1 + m.m22 * a2]
    }

    /// Force of everything at the top that acts by its displacement (m) and velocity (m/s), N. A yielding
    /// spring starts from this plastic displacement, m. To formulas the top was never farther out.
    pub fn top_force_n(&self, x_c_m: f64, v_c_m_s: f64, plastic_m: f64) -> f64 {
        let laws = match &self.piecewise_laws {
            Some(piecewise_laws) => {
                let memory = TopMemory { plastic_m, ..TopMemory::default() };
                piecewise_laws.laws(&piecewise_laws.regime_at(x_c_m, v_c_m_s, memory))
            }
            None => *self.motion(Contact::REST).laws(),
        };
        let named_n = laws.spring_force_n(x_c_m) + laws.damping_force_n(v_c_m_s);
        match self.formulas.is_empty() {
            true => named_n,
            false => named_n + self.formulas.top_force_as_written_n(x_c_m, v_c_m_s),
        }
    }

    /// m_dp with what effects add to it, kg.
    pub fn carriage_mass_kg(&self) -> f64 {
        self.motion(Contact::REST).laws().carriage_mass_kg
    }
}

//! The top itself: where it is and how fast, and the motion of a wall whose top friction holds in place.

use wide::f64x2;

use super::mass_matrix::Freedom;
use super::motion::{Law, Motion, Turned};
use super::posture::Pair;

impl Motion {
    /// The motion with the top held in place, a_C = 0, and the force by which friction holds it, N.
    ///
    /// Of the accelerations without it, θ''_0, the force λ makes θ'' = θ''_0 + M⁻¹ Jᵀ λ with J = (Y_Q, Y_C), so that
    /// λ = -a_C0 / (J M⁻¹ Jᵀ). What can move in one way only stands still.
    #[cold]
    #[inline(never)]
    pub(super) fn held(&self, law: &Law, t: &Turned, theta_dd: Pair) -> (Pair, f64) {
        let free: f64 = (t.y * f64x2::new(theta_dd) - t.x * law.squares).to_array().iter().sum();
        let push = t.y.to_array();
        let per_force = law.mass.solve(self.freedom, push);
        let holding_n = -free / (push[0] * per_force[0] + push[1] * per_force[1]);
        let theta_dd = match self.freedom {
            Freedom::Both => [0, 1].map(|i| theta_dd[i] + per_force[i] * holding_n),
            _ => [0.0; 2],
        };
        (theta_dd, holding_n)
    }

    /// Displacement (m), velocity (m/s) and acceleration (m/s²) of the top, all relative to the ground.
    pub fn top(&self, theta: Pair, omega: Pair, theta_dd: Pair) -> [f64; 3] {
        let t = self.posture(theta);
        let omega = f64x2::new(omega);
        let sum = |pair: f64x2| pair.to_array().iter().sum::<f64>();
        let acceleration = sum(t.y * f64x2::new(theta_dd) - t.x * (omega * omega));
        [sum(t.x) + self.o_c, sum(t.y * omega), acceleration]
    }

    /// The velocities without those of the top: what can move in one way only stops.
    pub fn stopped(&self, theta: Pair, omega: Pair) -> Pair {
        if self.freedom != Freedom::Both {
            return [0.0; 2];
        }
        let [y_q, y_c] = self.posture(theta).y.to_array();
        let share = (y_q * omega[0] + y_c * omega[1]) / (y_q * y_q + y_c * y_c);
        [omega[0] - share * y_q, omega[1] - share * y_c]
    }

    /// Largest speed (m/s) the top could have at these velocities if none cancelled: what its roundings are of.
    pub fn top_speed_size(&self, omega: Pair) -> f64 {
        self.q.y * omega[0].abs() + self.c.y * omega[1].abs()
    }
}

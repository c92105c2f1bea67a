//! The energy of a motion, and where the top is: what is told of a state, and no step needs.

use super::geometry::{Pair, Rotations};
use super::motion::Motion;
use super::wall::G_M_S2;

impl Motion {
    /// Kinetic, gravity and spring energy at a state, J; gravity is zero at rest.
    pub fn energy_j(&self, theta: Pair, omega: Pair) -> f64 {
        if let Some(bedded) = &self.bedded {
            let at_top = self.laws.spring_energy_j(self.top_displacement_m(theta));
            return bedded.energy_j(theta, omega) + at_top;
        }
        let t = self.configuration_at(theta);
        let kinetic = 0.5 * self.sharp.mass_matrix(&t).quadratic(omega);
        let lifted = (t.v.y - self.sharp.v.y) + (t.u.y - self.sharp.u.y);
        kinetic + G_M_S2 * lifted + self.laws.spring_energy_j(self.top_displacement_m(theta))
    }

    /// Kinetic energy at a state, J.
    #[inline(always)]
    pub fn kinetic_energy_j(&self, rotations: Rotations, omega: Pair) -> f64 {
        0.5 * self.mass_matrix(rotations).quadratic(omega)
    }

    /// Horizontal displacement s_Cx of the top, m.
    pub fn top_displacement_m(&self, theta: Pair) -> f64 {
        if let Some(bedded) = &self.bedded {
            let [x_c, _, _] = bedded.top(theta, [0.0; 2], [0.0; 2]);
            return x_c;
        }
        self.sharp.top_displacement_m(&self.configuration_at(theta))
    }
}

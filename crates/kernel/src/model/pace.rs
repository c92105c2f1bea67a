//! How fast a wall can change its motion.

use super::mass_matrix::MassMatrix;
use super::motion::Motion;
use super::posture::Turns;
use super::wall::G_M_S2;

impl Motion {
    /// Rate at which small motions about zero rotation can change under springs at the top of a stiffness in N/m, 1/s:
    /// with M θ'' + D θ' + K θ = 0, no frequency squared is above the trace of M⁻¹ K and no damping rate above that of
    /// M⁻¹ D, because both have no negative eigenvalue; gravity counts as if it restored.
    pub fn fastest_rate_per_s(&self, stiffness_n_per_m: f64) -> f64 {
        let laws = &self.laws;
        let top = |factor: f64| {
            let (y_q, y_c) = (self.q.y, self.c.y);
            MassMatrix { m11: factor * y_q * y_q, m12: factor * y_q * y_c, m22: factor * y_c * y_c }
        };
        // A cubic spring as it is at half the wall's thickness.
        let cubic = (3.0 * laws.cubic_n_per_m3 * self.o_x * self.o_x).max(0.0);
        let mut stiffness = top(stiffness_n_per_m + cubic);
        stiffness.m11 += G_M_S2 * self.v.y;
        stiffness.m22 += G_M_S2 * self.u.y;
        let mut damping = top(laws.viscous_n_s_per_m);
        let [c_ground, c_crack] = laws.joint_damping_n_m_s;
        damping.m11 += c_ground + c_crack;
        damping.m12 -= c_crack;
        damping.m22 += c_crack;
        let mass = self.mass_matrix(Turns::new([0.0; 2]));
        mass.trace_of_inverse_times(self.freedom, &stiffness).sqrt()
            + mass.trace_of_inverse_times(self.freedom, &damping)
    }
}

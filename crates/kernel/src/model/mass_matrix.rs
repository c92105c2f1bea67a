//! The mass matrix of the two rotations, which of them are free, and how fast small motions change.

use super::contact::Contact;
use super::formula::Slopes;
use super::geometry::{Pair, Rotations};
use super::motion::Motion;
use super::number::Number;
use super::wall::G_M_S2;

/// Which rotations a contact state leaves free.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// None: rest.
    None,
    /// θ_1 = θ_2: pattern 3, and the uncracked wall.
    Monolithic,
    /// θ_2 alone: pattern 4.
    Upper,
    /// Both: patterns 1 and 2.
    Both,
}

impl Freedom {
    pub fn of(contact: Contact) -> Self {
        match (contact.ground.is_open(), contact.crack.is_open()) {
            (false, false) => Freedom::None,
            (true, false) => Freedom::Monolithic,
            (false, true) => Freedom::Upper,
            (true, true) => Freedom::Both,
        }
    }
}

/// Symmetric 2 × 2 mass matrix of the two rotations, kg m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MassMatrix<N = f64> {
    pub m11: N,
    pub m12: N,
    pub m22: N,
}

impl<N: Number> MassMatrix<N> {
    /// Solves M x = f in the rotations that are free; the others follow or stay.
    #[inline(always)]
    pub fn solve(&self, freedom: Freedom, f: [N; 2]) -> [N; 2] {
        let Self { m11, m12, m22 } = *self;
        let constant = |value: f64| m11.constant(value);
        match freedom {
            Freedom::None => [constant(0.0); 2],
            Freedom::Monolithic => {
                let x = (f[0] + f[1]) / (m11 + constant(2.0) * m12 + m22);
                [x, x]
            }
            Freedom::Upper => [constant(0.0), f[1] / m22],
            Freedom::Both => {
                let inverse = constant(1.0) / (-m12).fused(m12, m11 * m22);
                let cross = [-m12 * f[1], -m12 * f[0]];
                [m22.fused(f[0], cross[0]) * inverse, m11.fused(f[1], cross[1]) * inverse]
            }
        }
    }

    /// Twice the kinetic energy, ωᵀ M ω, J.
    #[inline(always)]
    pub fn quadratic(&self, omega: [N; 2]) -> N {
        let two = self.m12.constant(2.0);
        self.m11 * omega[0] * omega[0] + two * self.m12 * omega[0] * omega[1] + self.m22 * omega[1] * omega[1]
    }
}

impl MassMatrix {
    fn plus(&self, other: &Self) -> Self {
        Self { m11: self.m11 + other.m11, m12: self.m12 + other.m12, m22: self.m22 + other.m22 }
    }

    /// Trace of M⁻¹ S in the rotations that are free.
    pub fn trace_of_inverse_times(&self, freedom: Freedom, s: &Self) -> f64 {
        match freedom {
            Freedom::None => 0.0,
            Freedom::Monolithic => s.quadratic([1.0, 1.0]) / self.quadratic([1.0, 1.0]),
            Freedom::Upper => s.m22 / self.m22,
            Freedom::Both => {
                let determinant = self.m11 * self.m22 - self.m12 * self.m12;
                (self.m22 * s.m11 - 2.0 * self.m12 * s.m12 + self.m11 * s.m22) / determinant
            }
        }
    }

    /// aᵀ M b.
    pub fn product(&self, a: Pair, b: Pair) -> f64 {
        a[0] * (self.m11 * b[0] + self.m12 * b[1]) + a[1] * (self.m12 * b[0] + self.m22 * b[1])
    }
}

/// A stiffness or damping at the ground and at the crack, on θ_1 and θ_2.
fn at_joints(ground: f64, crack: f64) -> MassMatrix {
    MassMatrix { m11: ground + crack, m12: -crack, m22: crack }
}

impl Motion {
    /// Rate at which small motions about zero rotation can change, 1/s, under a stiffness at the top in N/m.
    /// With M θ'' + D θ' + K θ = 0, no frequency squared is above the trace of M⁻¹ K. No damping rate is
    /// above the trace of M⁻¹ D: neither matrix has a negative eigenvalue. Gravity counts as if it restored.
    /// Formulas count by their largest slopes.
    pub fn fastest_rate_per_s(&self, stiffness_n_per_m: f64, of_formulas: &Slopes) -> f64 {
        let laws = &self.laws;
        let top = |factor: f64| {
            let (y_q, y_c) = (self.sharp.q.y, self.sharp.c.y);
            MassMatrix { m11: factor * y_q * y_q, m12: factor * y_q * y_c, m22: factor * y_c * y_c }
        };
        // A cubic spring as it is at half the wall's thickness.
        let cubic = (3.0 * laws.cubic_n_per_m3 * self.sharp.o_x * self.sharp.o_x).max(0.0);
        let Slopes { top: [further_k, further_c], joints: [at_ground, at_crack], .. } = *of_formulas;
        let mut stiffness = top(stiffness_n_per_m + cubic + further_k);
        stiffness.m11 += G_M_S2 * self.sharp.v.y;
        stiffness.m22 += G_M_S2 * self.sharp.u.y;
        stiffness = stiffness.plus(&at_joints(at_ground[0], at_crack[0]));
        let [c_ground, c_crack] = laws.joint_damping_n_m_s;
        let damping = top(laws.viscous_n_s_per_m + further_c);
        let mut damping = damping.plus(&at_joints(c_ground + at_ground[1], c_crack + at_crack[1]));
        if let Some(bedded) = &self.bedded {
            let [of_beds, of_dampers] = bedded.stiffness_and_damping();
            stiffness = stiffness.plus(&of_beds);
            damping = damping.plus(&of_dampers);
        }
        let mass = self.mass_matrix(Rotations::new([0.0; 2]));
        mass.trace_of_inverse_times(self.freedom, &stiffness).sqrt()
            + mass.trace_of_inverse_times(self.freedom, &damping)
    }
}

//! The mass matrix of the two rotations, and which of them a contact state leaves free.

use super::contact::Contact;
use super::posture::Pair;
use crate::fused::fused;

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
pub(crate) struct MassMatrix {
    pub m11: f64,
    pub m12: f64,
    pub m22: f64,
}

impl MassMatrix {
    /// Solves M x = f in the rotations that are free; the others follow or stay.
    #[inline(always)]
    pub fn solve(&self, freedom: Freedom, f: Pair) -> Pair {
        match freedom {
            Freedom::None => [0.0, 0.0],
            Freedom::Monolithic => {
                let x = (f[0] + f[1]) / (self.m11 + 2.0 * self.m12 + self.m22);
                [x, x]
            }
            Freedom::Upper => [0.0, f[1] / self.m22],
            Freedom::Both => {
                let inverse = 1.0 / fused(-self.m12, self.m12, self.m11 * self.m22);
                let cross = [-self.m12 * f[1], -self.m12 * f[0]];
                [fused(self.m22, f[0], cross[0]) * inverse, fused(self.m11, f[1], cross[1]) * inverse]
            }
        }
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

    /// Twice the kinetic energy, ωᵀ M ω, J.
    pub fn quadratic(&self, omega: Pair) -> f64 {
        self.m11 * omega[0] * omega[0] + 2.0 * self.m12 * omega[0] * omega[1] + self.m22 * omega[1] * omega[1]
    }
}

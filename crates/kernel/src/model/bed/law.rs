//! The static law of a bed: contact, moment, energy.

use super::super::contact::Pivot;

/// A bed of linear springs without tension in a joint, under a constant load.
///
/// With φ the rotation across the joint, b its width, L its length, k the stiffness per area and N the load:
///
/// | | where | contact c | moment about the middle | energy |
/// | --- | --- | --- | --- | --- |
/// | whole contact | abs(φ) ≤ φ_c = 2 N/(k L b²) | b | k L b³ φ/12 | N²/(2 k b L) + k L b³ φ²/24 |
/// | in part | abs(φ) > φ_c | sqrt(2 N/(k L abs(φ))) | N (b/2 - c/3) sign φ | N c abs(φ)/3 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bed {
    /// k, Pa/m.
    pub stiffness_pa_per_m: f64,
    /// Time ζ of the dampers beside the springs, s: a pressure k (δ + ζ δ').
    pub damping_s: f64,
    /// b, m.
    pub width_m: f64,
    /// L, m.
    pub length_m: f64,
    /// N, N.
    pub load_n: f64,
}

impl Bed {
    /// φ_c = 2 N/(k L b²), rad: beyond it a part of the joint is open.
    pub fn full_contact_rad(&self) -> f64 {
        2.0 * self.load_n / (self.stiffness_pa_per_m * self.length_m * self.width_m * self.width_m)
    }

    /// Whether the joint is in whole contact, or open towards a side.
    pub fn pivot(&self, phi: f64) -> Pivot {
        if phi.abs() <= self.full_contact_rad() { Pivot::Closed } else { Pivot::of_angle(phi) }
    }

    /// Width c of the zone of contact at a rotation in rad, m.
    pub fn contact_m(&self, phi: f64) -> f64 {
        let phi_c = self.full_contact_rad();
        if phi.abs() <= phi_c { self.width_m } else { self.partial_contact_m(phi.abs()) }
    }

    /// c = sqrt(2 N/(k L φ)) = b sqrt(φ_c/φ).
    fn partial_contact_m(&self, phi: f64) -> f64 {
        self.width_m * (self.full_contact_rad() / phi).sqrt()
    }

    /// Moment about the middle of the joint at a rotation in rad, N m: what the load and the bed do together.
    pub fn moment_n_m(&self, phi: f64) -> f64 {
        if phi.abs() <= self.full_contact_rad() {
            return self.rotational_stiffness_n_m() * phi;
        }
        self.load_n * (self.width_m / 2.0 - self.contact_m(phi) / 3.0) * phi.signum()
    }

    /// Energy in the bed at a rotation in rad, J.
    pub fn energy_j(&self, phi: f64) -> f64 {
        if phi.abs() <= self.full_contact_rad() {
            self.full_energy_j(phi)
        } else {
            self.partial_energy_j(phi.abs())
        }
    }

    /// k L b³/12, N m: the moment per rotation in whole contact.
    pub fn rotational_stiffness_n_m(&self) -> f64 {
        self.stiffness_pa_per_m * self.length_m * self.width_m.powi(3) / 12.0
    }

    fn full_energy_j(&self, phi: f64) -> f64 {
        let area_m2 = self.width_m * self.length_m;
        let pressed = self.load_n * self.load_n / (2.0 * self.stiffness_pa_per_m * area_m2);
        pressed + 0.5 * self.rotational_stiffness_n_m() * phi * phi
    }

    fn partial_energy_j(&self, phi: f64) -> f64 {
        self.load_n * self.partial_contact_m(phi) * phi / 3.0
    }

    /// Energy beyond that at rest, J, in whole contact (side 0) or in part towards a side.
    pub(crate) fn stored_j(&self, side: f64, phi: f64) -> f64 {
        let stored = if side == 0.0 { self.full_energy_j(phi) } else { self.partial_energy_j(side * phi) };
        stored - self.full_energy_j(0.0)
    }

    /// How long a joint that turns at a rate (rad/s) is in whole contact on one side of the middle, as a share
    /// of the time 1/ω_z in which the weight bounces on the bed: φ_c ω_z/abs(φ'), ω_z = sqrt(k b L g/N).
    pub(crate) fn passage_over_bounce(&self, phi_rate: f64) -> f64 {
        let stiffness = self.stiffness_pa_per_m * self.width_m * self.length_m;
        let bounce_per_s = (stiffness * super::super::wall::G_M_S2 / self.load_n).sqrt();
        self.full_contact_rad() * bounce_per_s / phi_rate.abs()
    }
}

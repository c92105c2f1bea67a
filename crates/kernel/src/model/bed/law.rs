//! The static law of a bed: contact, moment, energy, and the point about which the body turns.

use std::f64::consts::FRAC_PI_2;

use super::super::contact::Pivot;
use super::super::geometry::Pair;
use super::super::vector::Vector;

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

/// Below this share of φ_c the law of contact in part is not followed any further. A step may try a state
/// there before the change of contact is found.
const LEAST_PARTIAL: f64 = 0.25;

/// How the middle of the upper face moves as a joint turns by φ, in the axes of the body below; and what the
/// joint does beyond that. A sharp edge has the same, without moment and energy.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Roll {
    /// Where the middle is, from where it is at rest, m.
    pub place: Vector,
    /// d/dφ of the place, m.
    pub slope: Vector,
    /// d²/dφ² of the place, m.
    pub bend: Vector,
    /// Moment against the rotation by which the bed stores energy, N m.
    pub moment_n_m: f64,
    /// Moment against the rotation per rate of rotation, N m s.
    pub damping_n_m_s: f64,
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

    /// The joint in whole contact: the body turns about the middle, which stays.
    pub(crate) fn roll_in_full_contact(&self, phi: f64) -> Roll {
        let stiffness = self.rotational_stiffness_n_m();
        Roll { moment_n_m: stiffness * phi, damping_n_m_s: self.damping_s * stiffness, ..Roll::default() }
    }

    /// The joint in contact in part, open towards a side.
    ///
    /// The body turns about the middle of the zone of contact, z = (b - c)/2 from that of the joint. With
    /// u = sin φ and v = 1 - cos φ, z cos φ integrates in closed form for c = b sqrt(u_c/u), and z sin φ for
    /// c = b (v_c/v)^¼. Both are b at φ_c, and differ from b sqrt(φ_c/φ) by a share of φ²/12 at most:
    ///
    /// - y = b/2 (sqrt(u) - sqrt(u_c))²
    /// - x = b/2 (v - 4/3 v_c^¼ v^¾ + v_c/3)
    ///
    /// For k without bound this is the sharp edge: y = b/2 sin φ, x = b/2 (1 - cos φ).
    pub(crate) fn roll_in_part(&self, side: f64, phi: f64) -> Roll {
        let phi_c = self.full_contact_rad();
        let phi = (side * phi).max(LEAST_PARTIAL * phi_c);
        let half_m = self.width_m / 2.0;
        let [(u, cos, v), (u_c, _, v_c)] = [phi, phi_c].map(turned);
        // Beyond a quarter turn, where u falls again, the zone stays as wide as it was there.
        let (open_y, risen, narrows) = if phi <= FRAC_PI_2 {
            let part_y = (u_c / u).sqrt();
            (1.0 - part_y, u * (1.0 - part_y).powi(2), 0.5 * part_y * cos * cos / u)
        } else {
            let open_y = 1.0 - u_c.sqrt();
            (open_y, open_y * (u - u_c.sqrt()), 0.0)
        };
        let part_x = (v_c / v).sqrt().sqrt();
        let c = self.partial_contact_m(phi);
        let place =
            Vector { x: side * half_m * (v * (1.0 - 4.0 / 3.0 * part_x) + v_c / 3.0), y: half_m * risen };
        let slope = Vector { x: half_m * (1.0 - part_x) * u, y: side * half_m * open_y * cos };
        let bend = Vector {
            x: side * half_m * ((1.0 - part_x) * cos + part_x * (1.0 + cos) / 4.0),
            y: half_m * (narrows - open_y * u),
        };
        let zone = self.stiffness_pa_per_m * self.length_m * c * c * c / 12.0;
        Roll {
            place,
            slope,
            bend,
            moment_n_m: side * self.load_n * c / 6.0,
            damping_n_m_s: self.damping_s * zone,
        }
    }

    /// How long a joint that turns at a rate (rad/s) is in whole contact on one side of the middle, as a share
    /// of the time 1/ω_z in which the weight bounces on the bed: φ_c ω_z/abs(φ'), ω_z = sqrt(k b L g/N).
    pub(crate) fn passage_over_bounce(&self, phi_rate: f64) -> f64 {
        let stiffness = self.stiffness_pa_per_m * self.width_m * self.length_m;
        let bounce_per_s = (stiffness * super::super::wall::G_M_S2 / self.load_n).sqrt();
        self.full_contact_rad() * bounce_per_s / phi_rate.abs()
    }
}

/// Sine, cosine, and one less the cosine without cancellation.
fn turned(phi: f64) -> (f64, f64, f64) {
    let (sin, cos) = phi.sin_cos();
    (sin, cos, sin * sin / (1.0 + cos))
}

/// A sharp edge at ± half the width: the middle is lifted as the body turns about it. Half a width of zero is a
/// joint that stays closed.
pub(crate) fn roll_about_edge(half_m: f64, phi: f64) -> Roll {
    let (sin, cos, less) = turned(phi);
    Roll {
        place: Vector { x: half_m * less, y: half_m * sin },
        slope: Vector { x: half_m * sin, y: half_m * cos },
        bend: Vector { x: half_m * cos, y: -half_m * sin },
        ..Roll::default()
    }
}

/// The rotations across the ground and across the crack of a pair of body rotations.
pub(crate) fn across([lower, upper]: Pair) -> Pair {
    [lower, upper - lower]
}

//! How a body rolls over the joint below it: on a bed, whose zone of contact moves, or about a sharp edge.

use std::f64::consts::FRAC_PI_2;

use super::super::geometry::Pair;
use super::super::vector::Vector;
use super::law::Bed;

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

/// A bed, and what of its law does not change as the joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RollingBed {
    pub bed: Bed,
    full_contact_rad: f64,
    /// u_c = sin φ_c, its root, and v_c = 1 - cos φ_c.
    u_c: f64,
    root_u_c: f64,
    v_c: f64,
    rotational_stiffness_n_m: f64,
}

impl RollingBed {
    pub fn new(bed: Bed) -> Self {
        let full_contact_rad = bed.full_contact_rad();
        let (u_c, _, v_c) = turned(full_contact_rad);
        let rotational_stiffness_n_m = bed.rotational_stiffness_n_m();
        Self { bed, full_contact_rad, u_c, root_u_c: u_c.sqrt(), v_c, rotational_stiffness_n_m }
    }

    /// The joint in whole contact: the body turns about the middle, which stays.
    #[inline(always)]
    pub fn in_full_contact(&self, phi: f64) -> Roll {
        let stiffness = self.rotational_stiffness_n_m;
        Roll { moment_n_m: stiffness * phi, damping_n_m_s: self.bed.damping_s * stiffness, ..Roll::default() }
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
    #[inline(always)]
    pub fn in_part(&self, side: f64, phi: f64) -> Roll {
        let Self { bed, full_contact_rad: phi_c, u_c, root_u_c, v_c, .. } = *self;
        let phi = (side * phi).max(LEAST_PARTIAL * phi_c);
        let half_m = bed.width_m / 2.0;
        let (u, cos, v) = turned(phi);
        // Beyond a quarter turn, where u falls again, the zone stays as wide as it was there.
        let (open_y, risen, narrows) = if phi <= FRAC_PI_2 {
            let part_y = (u_c / u).sqrt();
            (1.0 - part_y, u * (1.0 - part_y).powi(2), 0.5 * part_y * cos * cos / u)
        } else {
            let open_y = 1.0 - root_u_c;
            (open_y, open_y * (u - root_u_c), 0.0)
        };
        let part_x = (v_c / v).sqrt().sqrt();
        // c = b sqrt(φ_c/φ)
        let c = bed.width_m * (phi_c / phi).sqrt();
        let place =
            Vector { x: side * half_m * (v * (1.0 - 4.0 / 3.0 * part_x) + v_c / 3.0), y: half_m * risen };
        let slope = Vector { x: half_m * (1.0 - part_x) * u, y: side * half_m * open_y * cos };
        let bend = Vector {
            x: side * half_m * ((1.0 - part_x) * cos + part_x * (1.0 + cos) / 4.0),
            y: half_m * (narrows - open_y * u),
        };
        let zone = bed.stiffness_pa_per_m * bed.length_m * c * c * c / 12.0;
        Roll {
            place,
            slope,
            bend,
            moment_n_m: side * bed.load_n * c / 6.0,
            damping_n_m_s: bed.damping_s * zone,
        }
    }
}

/// Sine, cosine, and one less the cosine without cancellation.
#[inline(always)]
fn turned(phi: f64) -> (f64, f64, f64) {
    let (sin, cos) = phi.sin_cos();
    (sin, cos, sin * sin / (1.0 + cos))
}

/// A sharp edge at ± half the width: the middle is lifted as the body turns about it. Half a width of zero is a
/// joint that stays closed.
#[inline(always)]
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
#[inline(always)]
pub(crate) fn across([lower, upper]: Pair) -> Pair {
    [lower, upper - lower]
}

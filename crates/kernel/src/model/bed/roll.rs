//! How a body rolls over the joint below it: on a bed, whose zone of contact moves, or about a sharp edge.

use std::f64::consts::FRAC_PI_2;

use super::super::number::Number;
use super::super::vector::Vector;
use super::law::Bed;

/// Below this share of φ_c the law of contact in part is not followed any further. A step may try a state
/// there before the change of contact is found.
pub(super) const LEAST_PARTIAL: f64 = 0.25;

/// How the middle of the upper face moves as a joint turns by φ, in the axes of the body below; and what the
/// joint does beyond that. A sharp edge has the same, without moment and energy.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Roll<N = f64> {
    /// Where the middle is, from where it is at rest, m.
    pub place: Vector<N>,
    /// d/dφ of the place, m.
    pub slope: Vector<N>,
    /// d²/dφ² of the place, m.
    pub bend: Vector<N>,
    /// Moment against the rotation by which the bed stores energy, N m.
    pub moment_n_m: N,
    /// Moment against the rotation per rate of rotation, N m s.
    pub damping_n_m_s: N,
}

/// What of the law of a bed does not change as the joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RollingBed<N = f64> {
    /// b, m.
    pub width_m: N,
    /// N, N.
    pub load_n: N,
    /// k L, Pa.
    pub stiffness_pa: N,
    /// ζ, s.
    pub damping_s: N,
    /// Moment per rotation in whole contact, N m.
    pub rotational_stiffness_n_m: N,
    /// φ_c, rad.
    pub full_contact_rad: N,
    /// u_c = sin φ_c, its root, and v_c = 1 - cos φ_c.
    pub u_c: N,
    pub root_u_c: N,
    pub v_c: N,
}

impl RollingBed {
    pub fn new(bed: &Bed) -> Self {
        let full_contact_rad = bed.full_contact_rad();
        let (u_c, _, v_c) = turned(full_contact_rad);
        Self {
            width_m: bed.width_m,
            load_n: bed.load_n,
            stiffness_pa: bed.stiffness_pa_per_m * bed.length_m,
            damping_s: bed.damping_s,
            rotational_stiffness_n_m: bed.rotational_stiffness_n_m(),
            full_contact_rad,
            u_c,
            root_u_c: u_c.sqrt(),
            v_c,
        }
    }
}

impl<N: Number> Roll<N> {
    /// A joint that stays closed on sharp edges: nothing moves. `like` is any number.
    #[inline(always)]
    pub fn none(like: N) -> Self {
        let none = like.constant(0.0);
        let place = Vector::new(none, none);
        Self { place, slope: place, bend: place, moment_n_m: none, damping_n_m_s: none }
    }

    /// About a sharp edge at ± half the width, m: the middle is lifted as the body turns.
    #[inline(always)]
    pub fn about_edge(half_m: N, phi: N) -> Self {
        let (sin, cos, less) = turned(phi);
        Self {
            place: Vector::new(half_m * less, half_m * sin),
            slope: Vector::new(half_m * sin, half_m * cos),
            bend: Vector::new(half_m * cos, -half_m * sin),
            ..Self::none(phi)
        }
    }
}

impl Roll {
    /// The same towards the other side, for -1.
    #[must_use]
    pub fn mirrored_to(self, side: f64) -> Self {
        let Self { place, slope, bend, .. } = self;
        Self {
            place: Vector::new(side * place.x, place.y),
            slope: Vector::new(slope.x, side * slope.y),
            bend: Vector::new(side * bend.x, bend.y),
            moment_n_m: side * self.moment_n_m,
            ..self
        }
    }
}

impl<N: Number> RollingBed<N> {
    /// The joint in whole contact: the body turns about the middle, which stays.
    #[inline(always)]
    pub fn in_full_contact(&self, phi: N) -> Roll<N> {
        let stiffness = self.rotational_stiffness_n_m;
        Roll { moment_n_m: stiffness * phi, damping_n_m_s: self.damping_s * stiffness, ..Roll::none(phi) }
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
    pub fn in_part(&self, side: N, phi: N) -> Roll<N> {
        let Self { width_m, full_contact_rad: phi_c, u_c, root_u_c, v_c, .. } = *self;
        let number = |value: f64| phi.constant(value);
        let one = number(1.0);
        let phi = (side * phi).at_least(number(LEAST_PARTIAL) * phi_c);
        let half_m = width_m / number(2.0);
        let (u, cos) = phi.sine_and_cosine();
        // Beyond a quarter turn, where u falls again, the zone stays as wide as it was there.
        let within = |within: N, beyond: N| phi.choose_up_to(FRAC_PI_2, within, beyond);
        // 1 + cos φ, and 1 - cos φ where that does not cancel: v = u²/(1 + cos φ).
        let w = within(one + cos, one - cos);
        let [over_phi, over_u, over_w] = inverses([phi, within(u, one), w]);
        let (v, over_v) = (within(u * u * over_w, w), within(w * over_u * over_u, over_w));
        let part_y = (u_c * over_u).root();
        let open_y = within(one - part_y, one - root_u_c);
        let risen = within(u * (open_y * open_y), open_y * (u - root_u_c));
        let narrows = within(number(0.5) * part_y * cos * cos * over_u, number(0.0));
        let part_x = (v_c * over_v).root().root();
        // c = b sqrt(φ_c/φ)
        let c = width_m * (phi_c * over_phi).root();
        let fallen = v * (one - number(4.0 / 3.0) * part_x) + v_c * number(1.0 / 3.0);
        let bent = (one - part_x) * cos + part_x * (one + cos) * number(0.25);
        Roll {
            place: Vector::new(side * half_m * fallen, half_m * risen),
            slope: Vector::new(half_m * (one - part_x) * u, side * half_m * open_y * cos),
            bend: Vector::new(side * half_m * bent, half_m * (narrows - open_y * u)),
            moment_n_m: side * self.load_n * c * number(1.0 / 6.0),
            damping_n_m_s: self.damping_s * (self.stiffness_pa * c * c * c * number(1.0 / 12.0)),
        }
    }
}

/// Sine, cosine, and one less the cosine without cancellation.
#[inline(always)]
pub(super) fn turned<N: Number>(phi: N) -> (N, N, N) {
    let (sin, cos) = phi.sine_and_cosine();
    (sin, cos, sin * sin / (phi.constant(1.0) + cos))
}

/// The inverses of three numbers by one division, which takes as long as some ten products.
#[inline(always)]
fn inverses<N: Number>([a, b, c]: [N; 3]) -> [N; 3] {
    let (ab, bc) = (a * b, b * c);
    let inverse = a.constant(1.0) / (ab * c);
    [inverse * bc, inverse * (a * c), inverse * ab]
}

/// The rotations across the ground and across the crack of a pair of body rotations.
#[inline(always)]
pub(crate) fn across<N: Number>([lower, upper]: [N; 2]) -> [N; 2] {
    [lower, upper - lower]
}

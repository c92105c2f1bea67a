//! A bed that crushes: springs without tension whose pressure is limited, and which remember how far they were turned.

use std::f64::consts::FRAC_PI_2;

use super::super::contact::Pivot;
use super::super::vector::Vector;
use super::super::wall::BLOCK_STRENGTH;
use super::law::Bed;
use super::roll::{LEAST_PARTIAL, Roll, turned};

/// A bed of springs without tension that crushes at the pressure 0.85 f, under a constant load.
///
/// With φ the rotation across the joint, b its width, L its length, k the stiffness per area, N the load,
/// A = N/(0.85 f L) the depth of the stress block, φ_s = (0.85 f)² L/(2 k N) and q = φ_s/φ:
///
/// | where | moment about the middle |
/// | --- | --- |
/// | abs(φ) ≤ φ_s | as the elastic bed |
/// | beyond, where the toe crushes | N (b/2 - A/2 - A q²/6) sign φ |
///
/// The second is the balance of pressures that rise along the slope and stay at 0.85 f from there to the toe. φ without
/// bound gives N (b - A)/2: the sharp edge of a corner that is crushed to A.
///
/// What was crushed is gone: after the largest rotation m to a side the joint is an elastic bed on the width that is left,
/// whose edge there lies ℓ = A (1/2 + q²/6 - 2/3 sqrt q) further inside, q = φ_s/m. With it the moment at m is the one
/// above. So ℓ grows from nothing to A/2 at each side. While it grows by dℓ the load sinks by φ dℓ, and N φ dℓ is lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrushingJoint {
    /// k, Pa/m.
    pub stiffness_pa_per_m: f64,
    /// f, Pa.
    pub strength_pa: f64,
    /// Time ζ of the dampers beside the springs, s.
    pub damping_s: f64,
    /// b, m, before anything is crushed.
    pub width_m: f64,
    /// L, m.
    pub length_m: f64,
    /// N, N.
    pub load_n: f64,
    /// m, rad: the largest rotations so far to the right and to the left, without sign.
    pub crushed_rad: [f64; 2],
}

impl CrushingJoint {
    /// A, m: the depth of the stress block.
    pub fn block_m(&self) -> f64 {
        self.load_n / (BLOCK_STRENGTH * self.strength_pa * self.length_m)
    }

    /// K = k L, Pa.
    fn spring_pa(&self) -> f64 {
        self.stiffness_pa_per_m * self.length_m
    }

    /// The sine of φ_s, at which the toe begins to crush; 1 and more: never.
    fn yield_sine(&self) -> f64 {
        let strength_n_per_m = BLOCK_STRENGTH * self.strength_pa * self.length_m;
        strength_n_per_m * strength_n_per_m / (2.0 * self.spring_pa() * self.load_n)
    }

    /// Whether a rotation below a quarter turn crushes it.
    pub(crate) fn ever_crushes(&self) -> bool {
        self.yield_sine() < 1.0
    }

    /// The largest rotation to a side that leaves the bed elastic from here on, rad.
    pub(crate) fn elastic_up_to_rad(&self, side: Pivot) -> f64 {
        let yields_rad = if self.yield_sine() < 1.0 { self.yield_sine().asin() } else { FRAC_PI_2 };
        self.crushed_rad[place_of(side)].max(yields_rad)
    }

    /// This joint once it has been turned so far to a side, rad.
    #[must_use]
    pub(crate) fn turned_by(mut self, side: Pivot, phi: f64) -> Self {
        let crushed_rad = &mut self.crushed_rad[place_of(side)];
        *crushed_rad = crushed_rad.max(phi.abs());
        self
    }

    /// ℓ at a side, m.
    pub fn lost_m(&self, side: Pivot) -> f64 {
        let sine = self.crushed_rad[place_of(side)].min(FRAC_PI_2).sin();
        self.lost_at_m(sine)
    }

    fn lost_at_m(&self, sine: f64) -> f64 {
        if sine <= self.yield_sine() {
            return 0.0;
        }
        let q = self.yield_sine() / sine;
        self.block_m() * (0.5 + q * q / 6.0 - 2.0 / 3.0 * q.sqrt())
    }

    /// B, m: the width that is left.
    pub fn left_m(&self) -> f64 {
        self.width_m - (self.lost_m(Pivot::Right) + self.lost_m(Pivot::Left))
    }

    /// How far to the right the middle of what is left lies, m.
    fn offset_m(&self) -> f64 {
        0.5 * (self.lost_m(Pivot::Left) - self.lost_m(Pivot::Right))
    }

    /// The elastic bed that is left, as if its middle were that of the joint.
    pub(crate) fn left_bed(&self) -> Bed {
        Bed {
            stiffness_pa_per_m: self.stiffness_pa_per_m,
            damping_s: self.damping_s,
            width_m: self.left_m(),
            length_m: self.length_m,
            load_n: self.load_n,
        }
    }

    /// φ_c of what is left, rad.
    pub fn full_contact_rad(&self) -> f64 {
        self.full_contact_sine().min(1.0).asin()
    }

    fn full_contact_sine(&self) -> f64 {
        2.0 * self.load_n / (self.spring_pa() * self.left_m().powi(2))
    }

    /// C = sqrt(2 N/K): the zone of contact is C/sqrt(φ) wide.
    fn contact_root_m(&self) -> f64 {
        (2.0 * self.load_n / self.spring_pa()).sqrt()
    }

    /// Moment about the middle of the joint at a rotation in rad, N m. A joint that is turned further than ever before
    /// crushes.
    pub fn moment_n_m(&self, phi: f64) -> f64 {
        let rise = self.rise(phi);
        self.load_n * rise.slope_m + rise.moment_n_m + rise.lost_n_m
    }

    /// How far the middle is lifted beside rest on the whole joint at a rotation in rad, m.
    pub fn rise_m(&self, phi: f64) -> f64 {
        self.rise(phi).by_m
    }

    /// Energy in the springs beyond that of rest on the whole joint, J.
    pub fn stored_j(&self, phi: f64) -> f64 {
        self.rise(phi).stored_j - self.rest_j()
    }

    /// Energy lost a unit of the largest rotation where that grows, N m: N φ dℓ/dφ.
    pub fn lost_n_m(&self, phi: f64) -> f64 {
        self.rise(phi).lost_n_m
    }

    /// Energy lost by turning the joint to a rotation (rad) further than ever before, J: the sum of N φ dℓ from there.
    pub fn lost_j(&self, phi: f64) -> f64 {
        let crushed_rad = self.crushed_rad[place_of(Pivot::of_angle(phi))];
        let (phi, yields) = (phi.abs(), self.yield_sine());
        let up_to = |phi: f64| {
            let q = (yields / phi).min(1.0);
            // ∫ (sqrt q - q²)/3 dφ from φ_s, q = φ_s/φ.
            (2.0 / 3.0 * phi * q.sqrt() + phi * q * q / 3.0 - yields).max(0.0)
        };
        let before = crushed_rad.min(FRAC_PI_2).sin().max(yields);
        if phi <= before { 0.0 } else { self.load_n * self.block_m() * (up_to(phi) - up_to(before)) }
    }

    fn rest_j(&self) -> f64 {
        self.load_n * self.load_n / (2.0 * self.spring_pa() * self.width_m)
    }

    /// The law at a rotation: that at the sine, to its cube.
    fn rise(&self, phi: f64) -> Rise {
        let side = Pivot::of_angle(phi);
        if phi.abs() <= self.full_contact_sine() {
            return self.whole(phi);
        }
        let crushed = self.crushed_rad[place_of(side)].min(FRAC_PI_2).sin();
        let crushes = phi.abs() > crushed.max(self.yield_sine());
        self.in_part(side, phi.abs(), crushes).on_side(side)
    }

    /// In whole contact at a sine of φ: a bed on what is left, about its middle.
    fn whole(&self, sine: f64) -> Rise {
        let (n, k, left_m) = (self.load_n, self.spring_pa(), self.left_m());
        let stiffness_n_m = k * left_m.powi(3) / 12.0;
        Rise {
            by_m: self.offset_m() * sine + n / k * (1.0 / self.width_m - 1.0 / left_m),
            slope_m: self.offset_m(),
            bend_m: 0.0,
            stored_j: n * n / (2.0 * k * left_m) + 0.5 * stiffness_n_m * sine * sine,
            moment_n_m: stiffness_n_m * sine,
            damping_n_m_s: self.damping_s * stiffness_n_m,
            lost_n_m: 0.0,
        }
    }

    /// In contact in part, open by a sine of φ to a side, which counts as the right one.
    fn in_part(&self, side: Pivot, sine: f64, crushes: bool) -> Rise {
        let (n, root_m) = (self.load_n, self.contact_root_m());
        let root = sine.sqrt();
        let contact_m = root_m / root;
        let elastic = Rise {
            by_m: 0.0,
            slope_m: -contact_m / 2.0,
            bend_m: contact_m / (4.0 * sine),
            stored_j: n * root_m * root / 3.0,
            moment_n_m: n * contact_m / 6.0,
            damping_n_m_s: self.damping_s * n * contact_m / (6.0 * sine),
            lost_n_m: 0.0,
        };
        let lost_m = if crushes { self.lost_at_m(sine) } else { self.lost_m(side) };
        let edge_m = self.width_m / 2.0 - lost_m;
        let by_m = edge_m * sine - root_m * root + n / (self.spring_pa() * self.width_m);
        let rise = Rise { by_m, slope_m: edge_m + elastic.slope_m, ..elastic };
        if !crushes {
            return rise;
        }
        // The edge goes inwards: sin φ dℓ/dsin φ.
        let q = (self.yield_sine() / sine).min(1.0);
        let (block_m, inwards_m) = (self.block_m(), self.block_m() / 3.0 * (q.sqrt() - q * q));
        Rise {
            slope_m: rise.slope_m - inwards_m,
            bend_m: inwards_m / sine,
            damping_n_m_s: self.damping_s * n * block_m * q * q / (3.0 * sine),
            lost_n_m: n * inwards_m,
            ..rise
        }
    }
}

/// What a joint does at a sine of φ: all of it by that sine.
#[derive(Debug, Clone, Copy)]
struct Rise {
    /// How far the middle is lifted, m, and its derivatives.
    by_m: f64,
    slope_m: f64,
    bend_m: f64,
    /// Energy in the springs, J, and its derivative, N m.
    stored_j: f64,
    moment_n_m: f64,
    damping_n_m_s: f64,
    /// Energy that is lost, N m.
    lost_n_m: f64,
}

impl Rise {
    /// Of a joint that is open to a side in place of the right one.
    fn on_side(self, side: Pivot) -> Self {
        let sign = side.sign();
        Self {
            slope_m: sign * self.slope_m,
            moment_n_m: sign * self.moment_n_m,
            lost_n_m: sign * self.lost_n_m,
            ..self
        }
    }

    /// Followed along its tangent from a quarter turn on, where the sine falls again.
    fn beyond_quarter(self, sine: f64) -> Self {
        Self {
            by_m: self.by_m + self.slope_m * (sine - 1.0),
            bend_m: 0.0,
            moment_n_m: 0.0,
            damping_n_m_s: 0.0,
            lost_n_m: 0.0,
            ..self
        }
    }
}

/// Place of a side among the largest rotations.
fn place_of(side: Pivot) -> usize {
    usize::from(side == Pivot::Left)
}

/// The law as the joint turns, in a state of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RollingCrush {
    joint: CrushingJoint,
    side: Pivot,
    full_contact_rad: f64,
}

impl RollingCrush {
    pub fn new(joint: &CrushingJoint, side: Pivot) -> Self {
        Self { joint: *joint, side, full_contact_rad: joint.full_contact_rad() }
    }

    pub fn is_beyond(&self, phi: f64) -> bool {
        self.side.is_open() && phi.abs() > self.joint.elastic_up_to_rad(self.side)
    }

    fn rise(&self, phi: f64, crushes: bool) -> Rise {
        if self.side.is_closed() {
            return self.joint.whole(phi.sin());
        }
        let open = (self.side.sign() * phi).max(LEAST_PARTIAL * self.full_contact_rad);
        if open > FRAC_PI_2 {
            let turned = self.joint.in_part(self.side, 1.0, crushes).beyond_quarter(open.sin());
            return turned.on_side(self.side);
        }
        self.joint.in_part(self.side, open.sin(), crushes).on_side(self.side)
    }

    /// The body turns about the zone of contact: lifted by y(sin φ), and moved along by y tan(φ/2), as about a sharp
    /// edge.
    pub fn roll(&self, phi: f64, crushes: bool) -> Roll {
        let (sin, cos, less) = turned(phi);
        let rise = self.rise(phi, crushes);
        let y = [rise.by_m, rise.slope_m * cos, rise.bend_m * cos * cos - rise.slope_m * sin];
        let x = if cos > 0.0 {
            let half = sin / (1.0 + cos);
            // Of tan(φ/2): (1 + tan²)/2, and tan times that.
            let slope = (1.0 + half * half) / 2.0;
            [y[0] * half, y[1] * half + y[0] * slope, y[2] * half + 2.0 * y[1] * slope + y[0] * half * slope]
        } else {
            let sign = self.side.sign();
            let at_quarter = sign * (y[0] - rise.slope_m * (sin - sign));
            [at_quarter * less, at_quarter * sin, at_quarter * cos]
        };
        let [place, slope, bend] = [0, 1, 2].map(|i| Vector::new(x[i], y[i]));
        Roll { place, slope, bend, moment_n_m: rise.moment_n_m * cos, damping_n_m_s: rise.damping_n_m_s }
    }

    /// Stiffness of what is left in whole contact, N m, and its damping, N m s.
    pub fn stiffness_and_damping(&self) -> [f64; 2] {
        let Rise { moment_n_m, damping_n_m_s, .. } = self.joint.whole(1.0);
        [moment_n_m, damping_n_m_s]
    }

    /// Moment by which energy is lost while the joint crushes, against its opening, N m.
    pub fn lost_n_m(&self, phi: f64) -> f64 {
        self.rise(phi, true).lost_n_m * phi.cos()
    }

    pub fn stored_j(&self, phi: f64, crushes: bool) -> f64 {
        self.rise(phi, crushes).stored_j - self.joint.rest_j()
    }
}

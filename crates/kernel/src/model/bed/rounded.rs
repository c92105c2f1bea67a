//! Edges worn round: the law of rolling on an arc, without springs.

use super::super::vector::Vector;
use super::roll::{Roll, turned};

/// A joint whose edges are worn to an arc of radius R over a width a at either side.
///
/// The body stands on the flat between the arcs, b/2 - a to either side, and opens about its ends. Then it rolls on the
/// arc without sliding, and ends on the edge of the full width. With φ the rotation across the joint and N the load:
///
/// | where | lever z of the load | middle risen by |
/// | --- | --- | --- |
/// | on the arc, abs(φ) ≤ φ_e = asin(a/R) | b/2 - a + R sin abs(φ) | (b/2 - a) sin abs(φ) + R (1 - cos φ) |
/// | on the edge | b/2 | as about that edge |
///
/// The moment is N z: nothing but the weight stores energy. An arc of R ≤ a never comes to the full width. a = 0 is the
/// sharp edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundedEdges {
    /// a, m, at each side.
    pub worn_width_m: f64,
    /// R, m.
    pub radius_m: f64,
    /// b, m.
    pub width_m: f64,
    /// N, N.
    pub load_n: f64,
}

impl RoundedEdges {
    /// Width of the flat that a closed joint stands on, b - 2 a, m.
    pub fn flat_m(&self) -> f64 {
        self.width_m - 2.0 * self.worn_width_m
    }

    /// φ_e, rad, where the body comes to the edge of the full width; `None` of an arc that does not reach it.
    pub fn end_rad(&self) -> Option<f64> {
        (self.radius_m > self.worn_width_m).then(|| (self.worn_width_m / self.radius_m).asin())
    }

    /// Moment about the middle of the open joint at a rotation in rad, N m.
    pub fn moment_n_m(&self, phi: f64) -> f64 {
        let on_arc_m = self.flat_m() / 2.0 + self.radius_m * phi.abs().sin();
        let lever_m = match self.end_rad() {
            Some(end) if phi.abs() > end => self.width_m / 2.0,
            _ => on_arc_m,
        };
        self.load_n * lever_m * phi.signum()
    }

    /// Work of the moment from 0 to a rotation in rad, J.
    pub fn work_j(&self, phi: f64) -> f64 {
        let phi = phi.abs();
        let on_arc = self.end_rad().map_or(phi, |end| phi.min(end));
        let arc_m = self.flat_m() / 2.0 * on_arc + 2.0 * self.radius_m * (on_arc / 2.0).sin().powi(2);
        self.load_n * (arc_m + self.width_m / 2.0 * (phi - on_arc))
    }

    /// How far the middle of the joint is lifted at a rotation in rad, m.
    pub fn rise_m(&self, phi: f64) -> f64 {
        let rolling = RollingArc::new(self);
        rolling.roll(phi.abs(), rolling.is_beyond(phi.abs())).place.y
    }
}

/// What of the law does not change as the joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RollingArc {
    half_flat_m: f64,
    radius_m: f64,
    end_rad: Option<f64>,
    /// Sine, cosine of φ_e, and one less the cosine.
    end: (f64, f64, f64),
    pub load_n: f64,
}

impl RollingArc {
    pub fn new(edges: &RoundedEdges) -> Self {
        let end_rad = edges.end_rad();
        Self {
            half_flat_m: edges.flat_m() / 2.0,
            radius_m: edges.radius_m,
            end_rad,
            end: turned(end_rad.unwrap_or(0.0)),
            load_n: edges.load_n,
        }
    }

    pub fn is_beyond(&self, phi: f64) -> bool {
        self.end_rad.is_some_and(|end| phi > end)
    }

    /// The joint open by φ to the right, on its arc or beyond it.
    pub fn roll(&self, phi: f64, beyond: bool) -> Roll {
        if beyond { self.on_edge(phi) } else { self.on_arc(phi) }
    }

    /// Rolling on the arc: the point of contact has gone R φ along the joint below from the end of the flat.
    fn on_arc(&self, phi: f64) -> Roll {
        let (sin, cos, less) = turned(phi);
        let (e, r) = (self.half_flat_m, self.radius_m);
        Roll {
            place: Vector::new(e * less + r * (phi - sin), e * sin + r * less),
            slope: Vector::new(e * sin + r * less, e * cos + r * sin),
            bend: Vector::new(e * cos + r * sin, r * cos - e * sin),
            ..Roll::default()
        }
    }

    /// Turning about the edge of the full width, which stays where the arc has brought it.
    fn on_edge(&self, phi: f64) -> Roll {
        let (sin, cos, _) = turned(phi);
        let (end_sin, _, end_less) = self.end;
        let (e, r) = (self.half_flat_m, self.radius_m);
        // The edge as the body has it: along its face, and above it.
        let (along, above) = (e + r * end_sin, r * end_less);
        let foot = e + r * self.end_rad.unwrap_or(0.0);
        Roll {
            place: Vector::new(foot - along * cos - above * sin, along * sin - above * cos),
            slope: Vector::new(along * sin - above * cos, along * cos + above * sin),
            bend: Vector::new(along * cos + above * sin, above * cos - along * sin),
            ..Roll::default()
        }
    }

    /// The moment per rotation with which it rolls, N R, N m: what steps have to follow.
    pub fn stiffness_n_m(&self) -> f64 {
        self.load_n * self.radius_m
    }
}

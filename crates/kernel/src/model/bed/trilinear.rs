//! Three lines of moment against rotation, after Doherty and others (2002).

use super::super::vector::Vector;
use super::roll::{Roll, turned};

/// A joint whose moment follows three lines up to that of sharp edges, under a constant load.
///
/// With φ the rotation across the joint, b its width and N the load, it carries the share τ of the moment N b/2 of sharp
/// edges:
///
/// | where | share τ |
/// | --- | --- |
/// | abs(φ) ≤ φ_1 | τ_1 abs(φ)/φ_1 |
/// | φ_1 to φ_2 | τ_1 + (1 - τ_1) (abs(φ) - φ_1)/(φ_2 - φ_1) |
/// | beyond φ_2 | 1 |
///
/// The net force of a wall that leans has its plateau on the second line where that rises as leaning takes, and falls
/// along the rigid line on the third. The body turns about the point that carries the load, z = τ b/2 from the middle:
/// nothing but the weight stores energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrilinearJoint {
    /// τ_1.
    pub plateau: f64,
    /// φ_1, rad.
    pub first_rad: f64,
    /// φ_2, rad; of no meaning where τ_1 is 1.
    pub last_rad: f64,
    /// Time ζ of a damper, s: a moment ζ dM/dφ φ'.
    pub damping_s: f64,
    /// b, m.
    pub width_m: f64,
    /// N, N.
    pub load_n: f64,
}

impl TrilinearJoint {
    /// φ_2, rad, where there is a second line.
    pub fn kink_rad(&self) -> Option<f64> {
        (self.plateau < 1.0).then_some(self.last_rad)
    }

    /// z at a rotation in rad, m, with its sign.
    fn lever_m(&self, phi: f64) -> f64 {
        let line = &self.lines()[self.line_at(phi.abs())];
        (line.at_zero_m + line.slope_m * phi.abs()) * phi.signum()
    }

    fn line_at(&self, phi: f64) -> usize {
        usize::from(phi > self.first_rad) + usize::from(phi > self.kink_rad().unwrap_or(self.first_rad))
    }

    /// z = α + σ φ of each line.
    fn lines(&self) -> [Line; 3] {
        let half_m = self.width_m / 2.0;
        let first = self.plateau * half_m / self.first_rad;
        let second = match self.kink_rad() {
            Some(last_rad) => (1.0 - self.plateau) * half_m / (last_rad - self.first_rad),
            None => 0.0,
        };
        [
            Line { at_zero_m: 0.0, slope_m: first },
            Line { at_zero_m: self.plateau * half_m - second * self.first_rad, slope_m: second },
            Line { at_zero_m: half_m, slope_m: 0.0 },
        ]
    }

    /// Moment about the middle of the joint at a rotation in rad, N m.
    pub fn moment_n_m(&self, phi: f64) -> f64 {
        self.load_n * self.lever_m(phi)
    }

    /// How far the middle of the joint is lifted at a rotation in rad, m: ∫ z dφ.
    pub fn rise_m(&self, phi: f64) -> f64 {
        let [first, second, third] = self.lines();
        let (phi, first_rad) = (phi.abs(), self.first_rad);
        let last_rad = self.kink_rad().unwrap_or(first_rad);
        let over = |line: Line, from: f64, to: f64| {
            let middle = 0.5 * (from + to.max(from));
            (line.at_zero_m + line.slope_m * middle) * (to - from).max(0.0)
        };
        over(first, 0.0, phi.min(first_rad))
            + over(second, first_rad, phi.min(last_rad))
            + over(third, last_rad, phi)
    }

    /// Moment per rotation on the first line, N m.
    pub fn rotational_stiffness_n_m(&self) -> f64 {
        self.load_n * self.plateau * self.width_m / (2.0 * self.first_rad)
    }

    /// φ_c, rad, of the bed that is as stiff at first: N b/(6 φ_c) = τ_1 N b/(2 φ_1).
    pub(crate) fn like_bed_rad(&self) -> f64 {
        self.first_rad / (3.0 * self.plateau)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    at_zero_m: f64,
    slope_m: f64,
}

/// What of the law does not change as the joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RollingLines {
    lines: [Line; 3],
    /// Where the integrals of each line begin, m.
    begin: [Vector; 3],
    kink_rad: Option<f64>,
    load_n: f64,
    damping_s: f64,
}

impl RollingLines {
    pub fn new(joint: &TrilinearJoint) -> Self {
        let lines = joint.lines();
        let kinks = [joint.first_rad, joint.kink_rad().unwrap_or(joint.first_rad)];
        let mut begin = [Vector::default(); 3];
        for (i, kink_rad) in kinks.into_iter().enumerate() {
            let (sin, _, less) = turned(kink_rad);
            let bent_m = lines[i].slope_m - lines[i + 1].slope_m;
            begin[i + 1] = begin[i] + Vector::new(bent_m * sin, -bent_m * less);
        }
        let kink_rad = joint.kink_rad();
        Self { lines, begin, kink_rad, load_n: joint.load_n, damping_s: joint.damping_s }
    }

    pub fn is_beyond(&self, phi: f64) -> bool {
        self.kink_rad.is_none_or(|kink| phi > kink)
    }

    /// On the first line, to either side.
    pub fn on_first(&self, phi: f64) -> Roll {
        self.on(0, phi)
    }

    /// On the second line, or the third, open by φ to the right.
    pub fn open(&self, phi: f64, beyond: bool) -> Roll {
        self.on(if beyond { 2 } else { 1 }, phi)
    }

    /// Stiffness of the first line, N m, and its damper, N m s.
    pub fn stiffness_and_damping(&self) -> [f64; 2] {
        let stiffness_n_m = self.load_n * self.lines[0].slope_m;
        [stiffness_n_m, self.damping_s * stiffness_n_m]
    }

    /// The body turns about z = α + σ φ: x' = z sin φ and y' = z cos φ, integrated.
    fn on(&self, i: usize, phi: f64) -> Roll {
        let (sin, cos, less) = turned(phi);
        let Line { at_zero_m, slope_m } = self.lines[i];
        let z = at_zero_m + slope_m * phi;
        Roll {
            place: self.begin[i] + Vector::new(slope_m * sin - z * cos, z * sin - slope_m * less),
            slope: Vector::new(z * sin, z * cos),
            bend: Vector::new(slope_m * sin + z * cos, slope_m * cos - z * sin),
            moment_n_m: 0.0,
            damping_n_m_s: self.damping_s * self.load_n * slope_m,
        }
    }
}

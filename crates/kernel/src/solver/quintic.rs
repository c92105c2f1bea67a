//! The quintic through positions, velocities and accelerations at both ends of a step.

use wide::f64x2;

use super::bernstein::Bernstein;

/// Positions, velocities and accelerations of the two coordinates at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Positions.
    pub position: [f64; 2],
    /// Velocities.
    pub velocity: [f64; 2],
    /// Accelerations.
    pub acceleration: [f64; 2],
}

impl Point {
    /// This motion a short time later, along its parabola.
    #[must_use]
    pub fn after(&self, short_s: f64) -> Self {
        let (x, v, a) = (self.position, self.velocity, self.acceleration);
        Self {
            position: [0, 1].map(|i| x[i] + short_s * (v[i] + 0.5 * short_s * a[i])),
            velocity: [0, 1].map(|i| v[i] + short_s * a[i]),
            acceleration: a,
        }
    }
}

/// Both coordinates over a step, each a polynomial of degree five in the share of the step that has passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quintic {
    h: f64,
    /// Bernstein coefficients of both coordinates, side by side.
    both: [f64x2; 6],
    /// The same of the first coordinate and of the second less the first.
    gaps: [f64x2; 6],
    /// Bounds on the magnitudes of the coordinates.
    bounds: [f64; 2],
}

/// Within this share of a step the square of a share is below roundings.
const AT_END: f64 = 1e-9;

impl Quintic {
    /// Through both ends of a step of length `h`.
    #[inline(always)]
    pub fn new(start: &Point, end: &Point, h: f64) -> Self {
        // From the differences at the ends, not from the two polynomials. So coordinates that start together,
        // or move together, differ by an exact zero.
        let apart = |[first, second]: [f64; 2]| [first, second - first];
        let gaps_of = |p: &Point| Point {
            position: apart(p.position),
            velocity: apart(p.velocity),
            acceleration: apart(p.acceleration),
        };
        let both = hermite_pair(start, end, h);
        let bounds = both[1..].iter().fold(both[0].abs(), |bound, c| bound.fast_max(c.abs()));
        Self { h, both, gaps: hermite_pair(&gaps_of(start), &gaps_of(end), h), bounds: bounds.to_array() }
    }

    /// Length of the step.
    pub fn h(&self) -> f64 {
        self.h
    }

    /// One coordinate.
    #[inline]
    pub fn coordinate(&self, i: usize) -> Bernstein<6> {
        Bernstein(self.both.map(|c| c.to_array()[i]))
    }

    /// The first coordinate (0), or the second less the first (1).
    #[inline]
    pub fn gap(&self, i: usize) -> Bernstein<6> {
        Bernstein(self.gaps.map(|c| c.to_array()[i]))
    }

    /// Second coordinate less the first.
    #[inline]
    pub fn difference(&self) -> Bernstein<6> {
        self.gap(1)
    }

    /// Smallest and largest coefficients of both gaps, between which these stay over the step.
    #[inline]
    pub fn gaps_between(&self) -> [[f64; 2]; 2] {
        let [first, ref later @ ..] = self.gaps;
        let least = later.iter().fold(first, |least, c| least.fast_min(*c));
        let most = later.iter().fold(first, |most, c| most.fast_max(*c));
        [least.to_array(), most.to_array()]
    }

    /// Bounds on the magnitudes of the coordinates over the step.
    #[inline]
    pub fn bounds(&self) -> [f64; 2] {
        self.bounds
    }

    /// Whether the first coordinate and the second less the first keep to their sides (-1 or 1) for sure. At
    /// the start they may be zero, and at rest; one without a side (0) may be anything.
    #[inline]
    pub fn keep_to(&self, sides: [f64; 2]) -> bool {
        let free = f64x2::new(sides.map(|side| 1.0 - side.abs()));
        let sides = f64x2::new(sides);
        let [x0, v0, ref later @ ..] = self.gaps;
        let least = later.iter().fold(later[3] * sides, |least, c| least.fast_min(*c * sides));
        let start = (x0 * sides).fast_min(v0 * sides);
        let [least, start] = [least + free, start].map(f64x2::to_array);
        least.iter().all(|c| *c > 0.0) && start.iter().all(|c| *c >= 0.0)
    }

    /// Positions at a share of the step.
    #[inline]
    pub fn position(&self, share: f64) -> [f64; 2] {
        values(self.both, share).to_array()
    }

    /// The same for a history. Samples of a measurement mostly lie at those of the record, up to a rounding of their time: there
    /// the path is a line.
    #[inline]
    pub fn sampled(&self, share: f64) -> [f64; 2] {
        let c = &self.both;
        if share < AT_END {
            return (c[0] + (c[1] - c[0]) * (5.0 * share)).to_array();
        } else if 1.0 - share < AT_END {
            return (c[5] - (c[5] - c[4]) * (5.0 * (1.0 - share))).to_array();
        }
        // After Horner in the share, times powers of what is left: less work than de Casteljau's way, by other roundings.
        let left = 1.0 - share;
        let square = left * left;
        let [of_1, of_2, of_3] = [5.0 * (square * square), 10.0 * (square * left), 10.0 * square];
        let from_1 =
            (((c[5] * share + c[4] * (5.0 * left)) * share + c[3] * of_3) * share + c[2] * of_2) * share;
        ((from_1 + c[1] * of_1) * share + c[0] * (square * square * left)).to_array()
    }

    /// Velocities at a share of the step.
    #[inline]
    pub fn velocity(&self, share: f64) -> [f64; 2] {
        let slopes: [f64x2; 5] = std::array::from_fn(|i| (self.both[i + 1] - self.both[i]) * 5.0);
        (values(slopes, share) / self.h).to_array()
    }
}

/// Values of two polynomials at a share of the step, as [`Bernstein::value`] has that of one.
#[inline(always)]
fn values<const N: usize>(mut c: [f64x2; N], share: f64) -> f64x2 {
    for width in (1..N).rev() {
        for i in 0..width {
            c[i] += (c[i + 1] - c[i]) * share;
        }
    }
    c[0]
}

/// Bernstein form of the quintics with these positions, velocities and accelerations at both ends.
#[inline(always)]
fn hermite_pair(start: &Point, end: &Point, h: f64) -> [f64x2; 6] {
    let (x0, x1) = (f64x2::new(start.position), f64x2::new(end.position));
    let (v0, v1) = (f64x2::new(start.velocity) * (h / 5.0), f64x2::new(end.velocity) * (h / 5.0));
    let a = |p: &Point| f64x2::new(p.acceleration) * (h * h / 20.0);
    [x0, x0 + v0, x0 + v0 * 2.0 + a(start), x1 - v1 * 2.0 + a(end), x1 - v1, x1]
}

/// Bernstein form of the quintic with these positions, velocities and accelerations at both ends.
pub fn hermite([x0, v0, a0]: [f64; 3], [x1, v1, a1]: [f64; 3], h: f64) -> Bernstein<6> {
    let (v0, v1) = (v0 * h / 5.0, v1 * h / 5.0);
    let (a0, a1) = (a0 * h * h / 20.0, a1 * h * h / 20.0);
    Bernstein([x0, x0 + v0, x0 + 2.0 * v0 + a0, x1 - 2.0 * v1 + a1, x1 - v1, x1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_reproduces_quintics() {
        let x = |t: f64| 1.0 - 2.0 * t + 0.5 * t.powi(2) + t.powi(3) - 3.0 * t.powi(4) + 0.7 * t.powi(5);
        let v = |t: f64| -2.0 + t + 3.0 * t.powi(2) - 12.0 * t.powi(3) + 3.5 * t.powi(4);
        let a = |t: f64| 1.0 + 6.0 * t - 36.0 * t.powi(2) + 14.0 * t.powi(3);
        let at =
            |t: f64| Point { position: [x(t), -x(t)], velocity: [v(t), -v(t)], acceleration: [a(t), -a(t)] };
        let h = 0.8;
        let quintic = Quintic::new(&at(0.0), &at(h), h);
        for i in 0..=10 {
            let share = f64::from(i) / 10.0;
            // A few roundings of numbers near one.
            assert!((quintic.position(share)[0] - x(share * h)).abs() < 1e-14);
            assert!((quintic.sampled(share)[1] + x(share * h)).abs() < 1e-14);
            assert!((quintic.velocity(share)[1] + v(share * h)).abs() < 1e-13);
            assert!((quintic.difference().value(share) + 2.0 * x(share * h)).abs() < 1e-14);
        }
    }
}

//! The kinematics of two bodies, and the rotations nearest to what channels read of them.
//!
//! Exact (see [`super::measured`]): a displacement at a height follows from the rotations. Two readings that tell both are
//! inverted. More than that are met in least squares, each over the standard deviation of its error, by Gauss and Newton.

use mrbd_kernel::model::{Pair, WallParameters};

/// Steps of Gauss and Newton: rotations are below a quarter turn, so the error is squared five times or more.
const STEPS: usize = 12;

/// What a channel reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reads {
    /// θ_1 or θ_2.
    Rotation(usize),
    /// The displacement at a height, m, relative to the ground.
    Displacement(f64),
}

/// A reading and the standard deviation of its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub reads: Reads,
    pub value: f64,
    pub sd: f64,
}

/// The wall's kinematics.
pub(super) struct Bodies<'a> {
    pub p: &'a WallParameters,
    pub top_held: bool,
}

impl Bodies<'_> {
    /// Height up to which a displacement tells θ_1 alone, m: the crack, or the top of a single block.
    pub fn lower_m(&self) -> f64 {
        self.p.crack_height_m.unwrap_or(self.p.height_m)
    }

    /// Rotations that are not known from each other.
    pub fn unknowns(&self) -> usize {
        if self.top_held || self.p.crack_height_m.is_none() { 1 } else { 2 }
    }

    /// What a channel reads of rotations, and its slopes against both.
    pub fn reading(&self, reads: Reads, theta: Pair) -> (f64, Pair) {
        match reads {
            Reads::Rotation(i) => (theta[i], [0, 1].map(|j| if i == j { 1.0 } else { 0.0 })),
            Reads::Displacement(y) => self.displacement_m(y, theta),
        }
    }

    /// Displacement at a height y, m, relative to the ground, and its slopes.
    pub fn displacement_m(&self, y: f64, [theta1, theta2]: Pair) -> (f64, Pair) {
        let half_1 = theta1.signum() * 0.5 * self.p.lower_width_m;
        let h1 = self.lower_m();
        // The foot of the lower body turns about its corner: y sin θ_1 + s b_1/2 (1 - cos θ_1).
        let arm = y.min(h1);
        let lower = arm * theta1.sin() + half_1 * (1.0 - theta1.cos());
        let slope = arm * theta1.cos() + half_1 * theta1.sin();
        if y <= h1 {
            return (lower, [slope, 0.0]);
        }
        let half_2 = (theta2 - theta1).signum() * 0.5 * self.p.upper_width_m;
        let upper = (y - h1) * theta2.sin() + half_2 * (theta1.cos() - theta2.cos());
        let slopes = [slope - half_2 * theta1.sin(), (y - h1) * theta2.cos() + half_2 * theta2.sin()];
        (lower + upper, slopes)
    }

    /// Standard deviations of the rotations of an upright wall, rad, from those that channels read with.
    pub fn noise_rad(&self, channels: &[(Reads, f64)]) -> [Option<f64>; 2] {
        let row = |(reads, sd): &(Reads, f64)| (self.reading(*reads, [0.0; 2]).1, *sd);
        let rows = channels.iter().map(row).collect::<Vec<_>>();
        let sum = |of: fn(Pair) -> f64| rows.iter().map(|(slopes, sd)| of(*slopes) / (sd * sd)).sum::<f64>();
        let some = |variance: f64| Some(variance.sqrt()).filter(|sd| sd.is_finite());
        if self.unknowns() == 1 {
            let ratio = if self.top_held { self.held(0.0).1 } else { 1.0 };
            let along = |(slopes, sd): &(Pair, f64)| ((slopes[0] + ratio * slopes[1]) / sd).powi(2);
            let variance = 1.0 / rows.iter().map(along).sum::<f64>();
            return [some(variance), some(ratio * ratio * variance)];
        }
        let [aa, ab, bb] = [sum(|s| s[0] * s[0]), sum(|s| s[0] * s[1]), sum(|s| s[1] * s[1])];
        let determinant = aa * bb - ab * ab;
        [some(bb / determinant), some(aa / determinant)]
    }

    /// θ_2 of a held top, and its slope against θ_1.
    pub fn held(&self, theta1: f64) -> (f64, f64) {
        let theta2 = super::measured::upper_rotation_rad(self.p, self.p.height_m, 0.0, theta1);
        let (_, [by_1, by_2]) = self.displacement_m(self.p.height_m, [theta1, theta2]);
        (theta2, -by_1 / by_2)
    }

    /// Rotations nearest to some readings, rad; NaN where they do not tell one.
    pub fn rotations_rad(&self, rows: &[Row]) -> Pair {
        if self.unknowns() == 1 {
            return self.one_rotation(rows);
        }
        let is_lower = |row: &&Row| match row.reads {
            Reads::Rotation(i) => i == 0,
            Reads::Displacement(y) => y <= self.lower_m(),
        };
        let (lower, upper): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(is_lower);
        let own_upper = upper.iter().find(|row| matches!(row.reads, Reads::Rotation(_)));
        match (lower.len(), upper.len()) {
            (0, 1) => [f64::NAN, own_upper.map_or(f64::NAN, |row| row.value)],
            (0, 0) => [f64::NAN; 2],
            (_, 0) => [self.one_rotation(rows)[0], f64::NAN],
            _ => self.both_rotations(rows),
        }
    }

    /// Where one number tells all: of the lower body, of a single block, or of a strip whose top is held.
    fn one_rotation(&self, rows: &[Row]) -> Pair {
        if rows.is_empty() {
            return [f64::NAN; 2];
        }
        let cracked = self.p.crack_height_m.is_some();
        let upper = |theta1: f64| match (self.top_held && cracked, cracked) {
            (true, _) => self.held(theta1),
            (false, false) => (theta1, 1.0),
            (false, true) => (theta1, 0.0),
        };
        let mut theta1 = 0.0;
        for _ in 0..STEPS {
            let (theta2, ratio) = upper(theta1);
            let (mut along, mut square) = (0.0, 0.0);
            for row in rows {
                let (read, slopes) = self.reading(row.reads, [theta1, theta2]);
                let slope = (slopes[0] + ratio * slopes[1]) / row.sd;
                along += slope * (row.value - read) / row.sd;
                square += slope * slope;
            }
            theta1 += along / square;
        }
        [theta1, if cracked { upper(theta1).0 } else { f64::NAN }]
    }

    fn both_rotations(&self, rows: &[Row]) -> Pair {
        let mut theta = [0.0; 2];
        for _ in 0..STEPS {
            let (mut along, mut square) = ([0.0; 2], [0.0; 3]);
            for row in rows {
                let (read, slopes) = self.reading(row.reads, theta);
                let [a, b] = slopes.map(|slope| slope / row.sd);
                let off = (row.value - read) / row.sd;
                along = [along[0] + a * off, along[1] + b * off];
                square = [square[0] + a * a, square[1] + a * b, square[2] + b * b];
            }
            let [aa, ab, bb] = square;
            let determinant = aa * bb - ab * ab;
            theta[0] += (bb * along[0] - ab * along[1]) / determinant;
            theta[1] += (aa * along[1] - ab * along[0]) / determinant;
        }
        theta
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Contact, RockingWall, Wall};

    const MOTIONS: [Pair; 6] =
        [[0.05, 0.08], [0.05, 0.01], [-0.03, 0.02], [-0.03, -0.05], [0.1, 0.1], [0.0, 0.02]];

    fn row(bodies: &Bodies, y: f64, theta: Pair, error_m: f64, sd: f64) -> Row {
        Row { reads: Reads::Displacement(y), value: bodies.displacement_m(y, theta).0 + error_m, sd }
    }

    #[test]
    fn analytic_displacements_are_those_of_the_model() {
        let p = WallParameters::table_wall();
        let wall = RockingWall::new(&Wall::new(p.clone()).expect("a possible wall"));
        let bodies = Bodies { p: &p, top_held: false };
        for theta in MOTIONS {
            let top = wall.top_displacement_m(Contact::of_rotations(theta), theta);
            // Roundings of lengths of some metres.
            assert!((bodies.displacement_m(p.height_m, theta).0 - top).abs() < 1e-14, "{theta:?}");
            let crack = wall.crack_displacement_m(theta[0]);
            assert!((bodies.displacement_m(2.191, theta).0 - crack).abs() < 1e-14, "{theta:?}");
            // Slopes against differences over 1e-6 rad, which are off by 1e-6 of a curvature of metres.
            for y in [1.0, 2.5, 3.9] {
                let (u, slopes) = bodies.displacement_m(y, theta);
                for i in 0..2 {
                    let mut near = theta;
                    near[i] += 1e-6 * if theta[0] < 0.0 { -1.0 } else { 1.0 };
                    let over = (bodies.displacement_m(y, near).0 - u) / (near[i] - theta[i]);
                    let smooth = theta[0] != theta[1];
                    assert!(
                        !smooth || (over - slopes[i]).abs() < 1e-5,
                        "{theta:?} at {y}: {over} {slopes:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn analytic_any_two_channels_that_tell_both_give_the_rotations_back() {
        let p = WallParameters::table_wall();
        let bodies = Bodies { p: &p, top_held: false };
        for theta in MOTIONS {
            for heights in [[1.0, 3.984], [2.191, 2.5], [2.6, 3.9]] {
                let rows = heights.map(|y| row(&bodies, y, theta, 0.0, 1.0));
                let found = bodies.rotations_rad(&rows);
                // Roundings of displacements of up to half a metre, over arms of a third of one.
                assert!((0..2).all(|i| (found[i] - theta[i]).abs() < 1e-12), "{theta:?}: {found:?}");
            }
            let alone = bodies.rotations_rad(&[row(&bodies, 1.0, theta, 0.0, 1.0)]);
            assert!((alone[0] - theta[0]).abs() < 1e-13 && alone[1].is_nan());
            assert!(bodies.rotations_rad(&[row(&bodies, 3.0, theta, 0.0, 1.0)]).iter().all(|t| t.is_nan()));
        }
    }

    #[test]
    fn analytic_more_channels_count_by_their_errors() {
        let p = WallParameters::table_wall();
        let bodies = Bodies { p: &p, top_held: false };
        let theta = [0.02, 0.03];
        // Two channels of the lower body: a millimetre off with an error of one, and right with an error of a tenth.
        let rows = [
            row(&bodies, 1.0, theta, 1e-3, 1e-3),
            row(&bodies, 2.0, theta, 0.0, 1e-4),
            row(&bodies, 3.984, theta, 0.0, 1e-3),
        ];
        // Weights of θ_1: 1 m over a millimetre, 2 m over a tenth: the error is shared as 1 to 400.
        let expected = 0.02 + 1e-3 / (1.0 + 400.0);
        let found = bodies.rotations_rad(&rows);
        assert!((found[0] - expected).abs() < 2e-9, "{found:?}");
    }

    #[test]
    fn analytic_errors_of_channels_become_those_of_the_rotations() {
        let p = WallParameters::table_wall();
        let channel = |y: f64, sd: f64| (Reads::Displacement(y), sd);
        let free = Bodies { p: &p, top_held: false };
        // θ_1 = u/2; θ_2 = (u_top - 2.191 θ_1)/1.793.
        let found = free.noise_rad(&[channel(2.0, 1e-3), channel(3.984, 2e-3)]).map(|sd| sd.expect("stated"));
        let upper = 2e-3_f64.hypot(2.191 * 5e-4) / 1.793;
        assert!((found[0] - 5e-4).abs() < 1e-12 && (found[1] - upper).abs() < 1e-12, "{found:?}");
        let held = Bodies { p: &p, top_held: true }.noise_rad(&[channel(2.0, 1e-3)]);
        let ratio = 2.191 / 1.793;
        assert!((held[0].expect("stated") - 5e-4).abs() < 1e-12);
        assert!((held[1].expect("stated") - ratio * 5e-4).abs() < 1e-12);
    }

    #[test]
    fn analytic_a_held_top_is_told_by_a_displacement_anywhere() {
        let p = WallParameters::table_wall();
        let bodies = Bodies { p: &p, top_held: true };
        for theta1 in [0.03, -0.02] {
            let theta = [theta1, bodies.held(theta1).0];
            assert!(bodies.displacement_m(p.height_m, theta).0.abs() < 1e-14);
            for y in [1.0, 2.191, 3.0] {
                let found = bodies.rotations_rad(&[row(&bodies, y, theta, 0.0, 1.0)]);
                assert!((0..2).all(|i| (found[i] - theta[i]).abs() < 1e-12), "{y}: {found:?}, {theta:?}");
            }
        }
    }
}

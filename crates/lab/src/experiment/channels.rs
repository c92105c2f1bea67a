//! Displacements at heights, and rotations where they were measured, become the rotations of both bodies.
//!
//! A sample has a row for every channel with a reading. The exact kinematics of the bodies (see [`super::measured`]) make
//! a displacement of the rotations. Two rows that tell both rotations are inverted. More than that are met in least
//! squares, each over the standard deviation of its error, by Gauss and Newton.

use std::path::Path;

use super::channel_table::{ChannelTable, Frame};
use super::file::TestTable;
use super::measured::{Columns, rest_mean};
use super::noise::scatter;
use mrbd_files::error::InputError;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Pair, Wall, WallParameters};
use mrbd_records::Motion;

/// Steps of Gauss and Newton: rotations are below a quarter turn, so the error is squared five times or more.
const STEPS: usize = 12;
/// Share of a channel's motion by which the others may contradict it. Bodies that bend do so by some hundredths; a
/// wrong sign, unit or height by more.
const MOST_CONTRADICTION: f64 = 0.2;
/// Errors beyond which they contradict each other.
const CLEAR_CONTRADICTION: f64 = 10.0;

/// What a channel reads.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reads {
    /// θ_1 or θ_2.
    Rotation(usize),
    /// The displacement at a height, m, relative to the ground.
    Displacement(f64),
}

/// A channel relative to the ground, at rest zero.
#[derive(Debug)]
struct Channel {
    column: String,
    key: String,
    reads: Reads,
    values: Vec<f64>,
    /// Standard deviation of its error, rad or m; `None`: it shows none.
    noise: Option<f64>,
    /// Whether that is stated in the experiment.
    is_stated: bool,
}

/// What channels tell of both bodies.
pub(super) struct Told {
    /// θ_1 and θ_2 of every sample, rad; `None`: nothing tells it.
    pub theta_rad: [Option<Vec<f64>>; 2],
    /// Standard deviations of their errors, rad, where those of all channels are stated.
    pub stated_noise_rad: [Option<f64>; 2],
}

/// What is needed to turn the channels of a test into rotations.
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub columns: &'a Columns,
    pub test: &'a TestTable,
    pub wall: &'a Wall,
    pub time_s: &'a [f64],
    pub gap_s: f64,
    /// The table's record, as it is played.
    pub record: Option<&'a Accelerogram>,
}

impl Source<'_> {
    /// What the channels of a test tell.
    pub fn rotations(&self) -> Result<Told, InputError> {
        let channels = self.channels()?;
        let bodies = Bodies { p: &self.wall.indented(), top_held: self.test.top_held };
        let weights = self.weights(&channels, &bodies)?;
        let rows = |k: usize| {
            let of = |(channel, sd): (&Channel, &f64)| Row {
                reads: channel.reads,
                value: channel.values[k],
                sd: *sd,
            };
            channels.iter().zip(&weights).map(of).filter(|row| row.value.is_finite()).collect::<Vec<_>>()
        };
        let theta = (0..self.time_s.len()).map(|k| bodies.rotations_rad(&rows(k))).collect::<Vec<_>>();
        self.check_agreement(&channels, &bodies, &theta)?;
        let of = |i: usize| Some(theta.iter().map(|both| both[i]).collect::<Vec<_>>());
        let told = [of(0), of(1)].map(|channel| channel.filter(|theta| theta.iter().any(|t| t.is_finite())));
        if told.iter().all(Option::is_none) {
            let found = format!(
                "test {:?}: displacements above the crack, which move with both bodies",
                self.test.name
            );
            return Err(InputError::file(self.path, found, self.needed()));
        }
        Ok(Told { theta_rad: told, stated_noise_rad: bodies.stated_noise_rad(&channels) })
    }

    /// What tells both rotations.
    fn needed(&self) -> String {
        let p = self.wall.parameters();
        let crack_m = p.crack_height_m.unwrap_or(p.height_m);
        format!(
            "theta1_rad or a channel up to the crack at {crack_m} m, and theta2_rad or one above it; \
             two above it; or one and top_held = true"
        )
    }

    /// The channels of the experiment, and columns that say by their names what they are.
    fn channels(&self) -> Result<Vec<Channel>, InputError> {
        let table_m = self.table_m()?;
        let given = self.test.channels().iter().filter(|channel| !channel.is_table());
        let mut channels =
            given.map(|channel| self.given(channel, &table_m)).collect::<Result<Vec<_>, _>>()?;
        channels.extend(self.named()?);
        Ok(channels)
    }

    fn given(&self, table: &ChannelTable, table_m: &[f64]) -> Result<Channel, InputError> {
        let column = self.column(table)?;
        let off = |(value, table_m): (f64, &f64)| match table.frame {
            Frame::Ground => value,
            Frame::Absolute => value - table_m,
        };
        let values = column.into_iter().zip(table_m).map(off).collect();
        let own = self.channel(&table.column, &table.key, Reads::Displacement(table.height_m), values);
        Ok(Channel { noise: table.noise_m.or(own.noise), is_stated: table.noise_m.is_some(), ..own })
    }

    /// A column that the experiment names, in metres.
    fn column(&self, table: &ChannelTable) -> Result<Vec<f64>, InputError> {
        let values = self.columns.get(&table.column).ok_or_else(|| {
            let found = format!(
                "no column {:?}, which {}.column of {:?} names",
                table.column, table.key, self.test.name
            );
            InputError::line(self.path, 1, found, format!("one of {}", self.columns.names.join(", ")))
        })?;
        Ok(values.iter().map(|value| table.factor * value).collect())
    }

    /// A channel from which its mean at rest is taken.
    fn channel(&self, column: &str, key: &str, reads: Reads, mut values: Vec<f64>) -> Channel {
        let offset = rest_mean(self.time_s, &values, self.test.rest_s);
        values.iter_mut().for_each(|value| *value -= offset);
        let noise = scatter(self.time_s, &values, self.gap_s);
        Channel { column: column.to_owned(), key: key.to_owned(), reads, values, noise, is_stated: false }
    }

    /// Columns with names that are known, where no channel stands for them.
    fn named(&self) -> Result<Vec<Channel>, InputError> {
        let p = self.wall.parameters();
        let known = [
            ("theta1_rad", Some(Reads::Rotation(0))),
            ("theta2_rad", p.crack_height_m.map(|_| Reads::Rotation(1))),
            ("crack_displacement_m", p.crack_height_m.map(Reads::Displacement)),
            ("top_displacement_m", Some(Reads::Displacement(p.height_m)).filter(|_| !self.test.top_held)),
        ];
        let given = self.test.channels();
        let mut named = Vec::new();
        for (name, reads) in known {
            let (Some(reads), Some(values)) = (reads, self.columns.get(name)) else { continue };
            if given.iter().any(|channel| channel.column == name) {
                continue;
            }
            if let Some(twin) = given.iter().find(|channel| reads == Reads::Displacement(channel.height_m)) {
                let found = format!("columns {name} and {:?}, both at {} m", twin.column, twin.height_m);
                return Err(InputError::line(
                    self.path,
                    1,
                    found,
                    format!("one for a height; see {}", twin.key),
                ));
            }
            named.push(self.channel(name, name, reads, values.to_vec()));
        }
        Ok(named)
    }

    /// Displacement of the table at every sample, m: of its channel, or of the record integrated twice.
    fn table_m(&self) -> Result<Vec<f64>, InputError> {
        if let Some(table) = self.test.channels().iter().find(|channel| channel.is_table()) {
            return self.column(table);
        }
        let start_s = self.test.given_start_s();
        let path = self.record.map(GroundPath::of);
        let at = |time_s: &f64| path.as_ref().map_or(0.0, |path| path.displacement_m(time_s + start_s));
        Ok(self.time_s.iter().map(at).collect())
    }

    /// Standard deviations by which channels count: alike where no sample has more of them than it needs.
    fn weights(&self, channels: &[Channel], bodies: &Bodies) -> Result<Vec<f64>, InputError> {
        if channels.len() <= bodies.unknowns() {
            return Ok(vec![1.0; channels.len()]);
        }
        let of = |channel: &Channel| {
            channel.noise.ok_or_else(|| {
                let found = format!("no scatter in column {:?} of test {:?}", channel.column, self.test.name);
                let allowed =
                    format!("noise_m beside {}: more channels than rotations are weighed by it", channel.key);
                InputError::file(self.path, found, allowed)
            })
        };
        channels.iter().map(of).collect()
    }

    /// Refuses channels that no rotations of two stiff bodies bring together.
    fn check_agreement(
        &self,
        channels: &[Channel],
        bodies: &Bodies,
        theta: &[Pair],
    ) -> Result<(), InputError> {
        for channel in channels {
            let both = channel.values.iter().zip(theta);
            let both = both.filter(|(value, theta)| value.is_finite() && theta.iter().all(|t| t.is_finite()));
            let (mut left, mut moved, mut count) = (0.0, 0.0, 0.0);
            for (value, theta) in both {
                left += (value - bodies.reading(channel.reads, *theta).0).powi(2);
                moved += value * value;
                count += 1.0;
            }
            let clear = CLEAR_CONTRADICTION * channel.noise.unwrap_or(0.0);
            if left > MOST_CONTRADICTION.powi(2) * moved && left > clear * clear * count {
                let share = 100.0 * (left / moved).sqrt();
                let found = format!(
                    "column {:?} of test {:?} contradicts the others by {share:.0} % of its motion",
                    channel.column, self.test.name
                );
                let allowed = format!(
                    "channels that two stiff bodies bring within {:.0} %: are sign, factor, height and frame right?",
                    100.0 * MOST_CONTRADICTION
                );
                return Err(InputError::file(self.path, found, allowed));
            }
        }
        Ok(())
    }
}

/// A reading and the standard deviation of its error.
#[derive(Debug, Clone, Copy)]
struct Row {
    reads: Reads,
    value: f64,
    sd: f64,
}

/// The wall's kinematics.
struct Bodies<'a> {
    p: &'a WallParameters,
    top_held: bool,
}

impl Bodies<'_> {
    /// Height up to which a displacement tells θ_1 alone, m: the crack, or the top of a single block.
    fn lower_m(&self) -> f64 {
        self.p.crack_height_m.unwrap_or(self.p.height_m)
    }

    /// Rotations that are not known from each other.
    fn unknowns(&self) -> usize {
        if self.top_held || self.p.crack_height_m.is_none() { 1 } else { 2 }
    }

    /// What a channel reads of rotations, and its slopes against both.
    fn reading(&self, reads: Reads, theta: Pair) -> (f64, Pair) {
        match reads {
            Reads::Rotation(i) => (theta[i], [0, 1].map(|j| if i == j { 1.0 } else { 0.0 })),
            Reads::Displacement(y) => self.displacement_m(y, theta),
        }
    }

    /// Displacement at a height y, m, relative to the ground, and its slopes.
    fn displacement_m(&self, y: f64, [theta1, theta2]: Pair) -> (f64, Pair) {
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

    /// Standard deviations of the rotations of an upright wall, rad, where those of all channels are stated.
    fn stated_noise_rad(&self, channels: &[Channel]) -> [Option<f64>; 2] {
        let stated = channels.iter().filter(|channel| channel.is_stated);
        let rows =
            stated.filter_map(|c| Some((self.reading(c.reads, [0.0; 2]).1, c.noise?))).collect::<Vec<_>>();
        if rows.len() < channels.len() {
            return [None; 2];
        }
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
    fn held(&self, theta1: f64) -> (f64, f64) {
        let theta2 = super::measured::upper_rotation_rad(self.p, self.p.height_m, 0.0, theta1);
        let (_, [by_1, by_2]) = self.displacement_m(self.p.height_m, [theta1, theta2]);
        (theta2, -by_1 / by_2)
    }

    /// Rotations nearest to some readings, rad; NaN where they do not tell one.
    fn rotations_rad(&self, rows: &[Row]) -> Pair {
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

/// Displacement of the ground under a record: acceleration linear between samples, nothing after the last.
#[derive(Debug)]
struct GroundPath<'a> {
    record: &'a Accelerogram,
    motion: Motion,
}

impl<'a> GroundPath<'a> {
    fn of(record: &'a Accelerogram) -> Self {
        Self { record, motion: Motion::of(record) }
    }

    /// At a time of the record, m; zero before it begins.
    ///
    /// After the last sample the acceleration falls to zero within a step and stays there, as in a run.
    fn displacement_m(&self, time_s: f64) -> f64 {
        if time_s <= 0.0 {
            return 0.0;
        }
        let (step, a) = (self.record.step_s(), self.record.acceleration_m_s2());
        let last = a.len() - 1;
        let k = ((time_s / step) as usize).min(last);
        let next = a.get(k + 1).copied().unwrap_or(0.0);
        let within = time_s - k as f64 * step;
        let along = |t: f64| {
            let rise = (next - a[k]) / step;
            let [x, v] = [self.motion.displacement_m[k], self.motion.velocity_m_s[k]];
            (x + t * (v + t * (a[k] / 2.0 + t * rise / 6.0)), v + t * (a[k] + t * rise / 2.0))
        };
        let (x, v) = along(within.min(step));
        x + v * (within - step).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Contact, RockingWall};

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
    fn analytic_stated_errors_become_those_of_the_rotations() {
        let p = WallParameters::table_wall();
        let channel = |y: f64, sd: f64| Channel {
            column: String::new(),
            key: String::new(),
            reads: Reads::Displacement(y),
            values: Vec::new(),
            noise: Some(sd),
            is_stated: true,
        };
        let free = Bodies { p: &p, top_held: false };
        // θ_1 = u/2; θ_2 = (u_top - 2.191 θ_1)/1.793.
        let found =
            free.stated_noise_rad(&[channel(2.0, 1e-3), channel(3.984, 2e-3)]).map(|sd| sd.expect("stated"));
        let upper = 2e-3_f64.hypot(2.191 * 5e-4) / 1.793;
        assert!((found[0] - 5e-4).abs() < 1e-12 && (found[1] - upper).abs() < 1e-12, "{found:?}");
        let held = Bodies { p: &p, top_held: true }.stated_noise_rad(&[channel(2.0, 1e-3)]);
        let ratio = 2.191 / 1.793;
        assert!((held[0].expect("stated") - 5e-4).abs() < 1e-12);
        assert!((held[1].expect("stated") - ratio * 5e-4).abs() < 1e-12);
        let silent = Channel { is_stated: false, ..channel(3.984, 2e-3) };
        assert_eq!(free.stated_noise_rad(&[channel(2.0, 1e-3), silent]), [None; 2]);
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

    #[test]
    fn analytic_the_path_of_the_ground_is_the_record_integrated_twice() {
        // a = 6 t on [0, 1], then down to zero within a step of 1 s: x = t³; v(1) = 3, and 3 + 3 after that step.
        let record = Accelerogram::new(1.0, vec![0.0, 6.0]).expect("a record");
        let path = GroundPath::of(&record);
        let fall = |t: f64| 1.0 + 3.0 * t + 3.0 * t * t - t * t * t;
        for (time_s, x) in [
            (-1.0, 0.0),
            (0.5, 0.125),
            (1.0, 1.0),
            (1.5, fall(0.5)),
            (2.0, fall(1.0)),
            (3.0, fall(1.0) + 6.0),
        ] {
            assert!(
                (path.displacement_m(time_s) - x).abs() < 1e-14,
                "{time_s}: {}",
                path.displacement_m(time_s)
            );
        }
    }
}

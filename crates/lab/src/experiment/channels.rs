//! Displacements at heights, and rotations where they were measured, become the rotations of both bodies.
//!
//! A sample has a row for every channel with a reading, from which [`Bodies`] tell the rotations.

use std::path::Path;

use super::bodies::{Bodies, Reads, Row};
use super::channel_table::{ChannelTable, Frame};
use super::file::TestTable;
use super::measured::{Columns, rest_mean};
use super::noise::scatter;
use mrbd_files::error::InputError;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Pair, Wall};
use mrbd_records::Motion;

/// Share of a channel's motion by which the others may contradict it. Bodies that bend do so by some hundredths; a
/// wrong sign, unit or height by more.
const MOST_CONTRADICTION: f64 = 0.2;
/// Errors beyond which they contradict each other.
const CLEAR_CONTRADICTION: f64 = 10.0;

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
        Ok(Told { theta_rad: told, stated_noise_rad: stated_noise_rad(&bodies, &channels) })
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

/// Standard deviations of the rotations of an upright wall, rad, where those of all channels are stated.
fn stated_noise_rad(bodies: &Bodies, channels: &[Channel]) -> [Option<f64>; 2] {
    let stated = channels.iter().filter(|channel| channel.is_stated);
    let stated = stated.filter_map(|channel| Some((channel.reads, channel.noise?))).collect::<Vec<_>>();
    if stated.len() < channels.len() { [None; 2] } else { bodies.noise_rad(&stated) }
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

//! Measured rotations as laboratories have them: any sampling, gaps, offsets, other start times, other readings.
//!
//! Displacements become rotations by the exact kinematics of the two bodies, inverted. With s the sign of the open joint,
//! a point of the lower body at height y moves by u = y sin θ_1 + s b_1/2 (1 - cos θ_1). A point of the upper body moves by
//! the displacement of its pivot and (y - h_1) sin θ_2 + s_2 b_2/2 (1 - cos θ_2). All are relative to the ground (model
//! section 3).

use super::channels::{Source, Told};
use super::file::{Reading, TestTable};
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Pair, Wall, WallParameters};
use mrbd_statistics::median;
use std::path::Path;

/// Samples farther apart than this many median distances leave a gap.
const GAP_IN_STEPS: f64 = 2.5;

/// Measured rotations of both bodies, in their own time until [`Measured::moved`] into the record's.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Names of the columns of its file.
    pub columns: Vec<String>,
    /// Times of the samples, s, increasing.
    pub time_s: Vec<f64>,
    /// θ_1 and θ_2 at the samples, rad; NaN where missing; `None`: the channel is lost.
    pub theta_rad: [Option<Vec<f64>>; 2],
    /// Samples farther apart than this are not joined, s.
    pub gap_s: f64,
    /// When the wall collapsed, s.
    pub collapse_s: Option<f64>,
    /// Standard deviations of the errors of θ_1 and θ_2 that follow from those stated of channels, rad; `None`: to be
    /// read from the samples.
    pub stated_noise_rad: [Option<f64>; 2],
}

/// The columns of a measured file, as numbers; NaN where a cell is empty.
pub(super) struct Columns {
    pub(super) names: Vec<String>,
    values: Vec<Vec<f64>>,
}

impl Columns {
    pub(super) fn get(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|n| n == name)?;
        Some(&self.values[index])
    }
}

impl Measured {
    /// Reads the measured file of a test, in its own time.
    ///
    /// Columns: `time_s`, and for each body its rotation (`theta1_rad`, `theta2_rad`) or the reading the test names
    /// (`crack_displacement_m` serves as one for θ_1 by itself, `top_displacement_m` for θ_2); or the channels of the
    /// test, absolute ones less the path of `record`. Empty cells and `nan` are missing samples.
    ///
    /// # Errors
    /// Input errors with file and line: not a table of numbers, times that do not increase, no channel at all.
    pub fn load(path: &Path, test: &TestTable, wall: &Wall, record: Option<&Accelerogram>) -> Result<Self> {
        let columns = read_columns(path)?;
        let time_s = times(path, &columns)?;
        let step_s = median_step(&time_s)
            .ok_or_else(|| InputError::file(path, format!("{} sample(s)", time_s.len()), "2 or more"))?;
        let gap_s = test.gap_s.unwrap_or(GAP_IN_STEPS * step_s);
        let channels = Channels { path, columns: &columns, test, wall, time_s: &time_s };
        let source = Source { path, columns: &columns, test, wall, time_s: &time_s, gap_s, record };
        let Told { theta_rad, stated_noise_rad } = match test.channels() {
            [] => Told { theta_rad: channels.rotations()?, stated_noise_rad: [None; 2] },
            _ => source.rotations()?,
        };
        channels.check_names(&theta_rad)?;
        if theta_rad.iter().all(Option::is_none) {
            let allowed = "theta1_rad, theta2_rad, crack_displacement_m, top_displacement_m, \
                           or displacements that [[channels]] or lower_reading and upper_reading name";
            let found = format!("columns {}, in none of them a measured rotation", columns.names.join(", "));
            return Err(InputError::line(path, 1, found, allowed).into());
        }
        Ok(Self { time_s, theta_rad, gap_s, collapse_s: None, stated_noise_rad, columns: columns.names })
    }

    /// The same in the record's time, of which `start_s` is the measurement's zero. The collapse is the one given, in
    /// the record's time, or where a rotation first passes its collapse rotation.
    #[must_use]
    pub fn moved(mut self, start_s: f64, collapse_s: Option<f64>, wall: &Wall) -> Self {
        self.time_s.iter_mut().for_each(|t| *t += start_s);
        self.collapse_s = collapse_s.or_else(|| first_collapse(&self.time_s, &self.theta_rad, wall));
        self
    }

    /// Times, s, and rotations, rad, from the beginning of the record until the wall fell. NaN where a sample is
    /// missing or lies in none of these windows of time, s. Without windows all count.
    pub fn counted(&self, windows_s: &[[f64; 2]]) -> (Vec<f64>, Vec<Pair>) {
        let end_s = self.collapse_s.unwrap_or(f64::INFINITY);
        let counts =
            |t: f64| windows_s.is_empty() || windows_s.iter().any(|[from, to]| *from <= t && t <= *to);
        let value =
            |channel: &Option<Vec<f64>>, k: usize| channel.as_ref().map_or(f64::NAN, |theta| theta[k]);
        let kept = (0..self.time_s.len()).filter(|&k| self.time_s[k] >= 0.0 && self.time_s[k] < end_s);
        let sample = |k: usize| {
            let t = self.time_s[k];
            let theta = self.theta_rad.each_ref().map(|channel| value(channel, k));
            (t, if counts(t) { theta } else { [f64::NAN; 2] })
        };
        kept.map(sample).unzip()
    }
}

fn read_columns(path: &Path) -> Result<Columns> {
    let readable = "a CSV table of numbers with a header";
    let refuse = |e: csv::Error| {
        let line = e.position().map_or(1, |p| p.line() as usize);
        InputError::line(path, line, e.to_string(), readable)
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(refuse)?;
    let names = reader.headers().map_err(refuse)?.iter().map(str::to_owned).collect::<Vec<_>>();
    let mut values = vec![Vec::new(); names.len()];
    for row in reader.records() {
        let row = row.map_err(refuse)?;
        let line = row.position().map_or(0, |p| p.line() as usize);
        for ((column, name), cell) in values.iter_mut().zip(&names).zip(&row) {
            column.push(parse_cell(cell).ok_or_else(|| {
                let allowed = "finite numbers; empty or nan where a sample is missing";
                InputError::line(path, line, format!("{cell:?} under {name}"), allowed)
            })?);
        }
    }
    Ok(Columns { names, values })
}

fn parse_cell(cell: &str) -> Option<f64> {
    if cell.is_empty() || cell.eq_ignore_ascii_case("nan") {
        return Some(f64::NAN);
    }
    cell.parse::<f64>().ok().filter(|value| value.is_finite())
}

fn times(path: &Path, columns: &Columns) -> Result<Vec<f64>, InputError> {
    let Some(time) = columns.get("time_s") else {
        let found = format!("columns {}", columns.names.join(", "));
        return Err(InputError::line(path, 1, found, "a column time_s"));
    };
    // The header is line 1.
    let not_after = |i: usize| !(time[i].is_finite() && (i == 0 || time[i] > time[i - 1]));
    if let Some(i) = (0..time.len()).find(|&i| not_after(i)) {
        let allowed = "times that increase from line to line";
        return Err(InputError::line(path, i + 2, format!("time_s {}", time[i]), allowed));
    }
    Ok(time.to_vec())
}

/// Median distance of times in order, s; `None` of less than two.
pub(crate) fn median_step(time_s: &[f64]) -> Option<f64> {
    median(&time_s.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>())
}

/// Finds and cleans the channels of a test.
struct Channels<'a> {
    path: &'a Path,
    columns: &'a Columns,
    test: &'a TestTable,
    wall: &'a Wall,
    time_s: &'a [f64],
}

impl Channels<'_> {
    fn rotations(&self) -> Result<[Option<Vec<f64>>; 2], InputError> {
        let p = &self.wall.indented();
        let lower = match &self.test.lower_reading {
            None => self.column("theta1_rad").or_else(|| self.of_crack(p)),
            Some(reading) => {
                let u = self.reading("lower_reading", reading)?;
                let theta = |u: &f64| lower_rotation_rad(p, reading.height_m, *u);
                Some(u.iter().map(theta).collect())
            }
        };
        let top = Reading { column: "top_displacement_m".into(), height_m: p.height_m };
        let direct = self.column("theta2_rad");
        let upper = match (&self.test.upper_reading, direct, &lower) {
            (Some(reading), _, Some(lower)) => Some(self.upper("upper_reading", reading, lower)?),
            (None, Some(direct), _) => Some(direct),
            (None, None, Some(lower)) if self.test.top_held => {
                Some(lower.iter().map(|theta1| upper_rotation_rad(p, p.height_m, 0.0, *theta1)).collect())
            }
            (None, None, Some(lower)) if self.columns.get(&top.column).is_some() => {
                Some(self.upper("measured", &top, lower)?)
            }
            _ => None,
        };
        Ok([lower, upper].map(|channel| channel.filter(|values| values.iter().any(|v| v.is_finite()))))
    }

    /// θ_1 by the displacement of the crack, where the file has it.
    fn of_crack(&self, p: &WallParameters) -> Option<Vec<f64>> {
        let height_m = p.crack_height_m?;
        let u = self.column("crack_displacement_m")?;
        Some(u.iter().map(|u| lower_rotation_rad(p, height_m, *u)).collect())
    }

    /// Refuses a column that was meant for a rotation which nothing gives: as a lost channel it would be passed over.
    fn check_names(&self, theta_rad: &[Option<Vec<f64>>; 2]) -> Result<(), InputError> {
        let lost = ["theta1_rad", "theta2_rad"].into_iter().zip(["theta1", "theta2"]).zip(theta_rad);
        for ((name, begin), _) in lost.filter(|(_, theta)| theta.is_none()) {
            let meant = |column: &&String| *column != name && column.to_lowercase().starts_with(begin);
            if let Some(column) =
                self.columns.names.iter().find(meant).filter(|_| self.columns.get(name).is_none())
            {
                let found = format!("columns {}", self.columns.names.join(", "));
                let allowed =
                    format!("{name} in radians, or no column that begins like it; did you mean {column:?}?");
                return Err(InputError::line(self.path, 1, found, allowed));
            }
        }
        Ok(())
    }

    fn upper(&self, key: &str, reading: &Reading, lower: &[f64]) -> Result<Vec<f64>, InputError> {
        let p = &self.wall.indented();
        let u = self.reading(key, reading)?;
        let theta = |(u, theta1): (&f64, &f64)| upper_rotation_rad(p, reading.height_m, *u, *theta1);
        Ok(u.iter().zip(lower).map(theta).collect())
    }

    fn reading(&self, key: &str, reading: &Reading) -> Result<Vec<f64>, InputError> {
        let p = self.wall.parameters();
        let h1 = p.crack_height_m.unwrap_or(p.height_m);
        let [from, to] = if key == "lower_reading" { [0.0, h1] } else { [h1, p.height_m] };
        let inside = reading.height_m > from && reading.height_m <= to;
        if !inside {
            let found = format!("a {key} of {:?} at {} m", self.test.name, reading.height_m);
            return Err(InputError::file(self.path, found, format!("above {from} m and up to {to} m")));
        }
        self.column(&reading.column).ok_or_else(|| {
            let found = format!("no column {:?}, which {key} of {:?} names", reading.column, self.test.name);
            InputError::line(self.path, 1, found, format!("one of {}", self.columns.names.join(", ")))
        })
    }

    /// A column without its mean over the first seconds at rest.
    fn column(&self, name: &str) -> Option<Vec<f64>> {
        let values = self.columns.get(name)?;
        let offset = rest_mean(self.time_s, values, self.test.rest_s);
        Some(values.iter().map(|v| v - offset).collect())
    }
}

/// Mean of values over the first seconds at rest; 0 where there are none.
pub(super) fn rest_mean(time_s: &[f64], values: &[f64], rest_s: f64) -> f64 {
    let until = time_s[0] + rest_s;
    let at_rest = || time_s.iter().zip(values).filter(|(t, v)| **t < until && v.is_finite());
    let count = at_rest().count();
    if count == 0 { 0.0 } else { at_rest().map(|(_, v)| v).sum::<f64>() / count as f64 }
}

/// When a measured rotation first passes the collapse rotation of its body.
fn first_collapse(time_s: &[f64], theta_rad: &[Option<Vec<f64>>; 2], wall: &Wall) -> Option<f64> {
    let limits = wall.collapse_rotation_rad();
    let passed =
        |k: usize| (0..2).any(|i| theta_rad[i].as_ref().is_some_and(|theta| theta[k].abs() >= limits[i]));
    (0..time_s.len()).find(|&k| passed(k)).map(|k| time_s[k])
}

/// Steps of Newton's method: rotations are below a quarter turn, so the error is squared five times or more.
const STEPS: usize = 12;

/// θ_1, rad, from the displacement of the lower body at a height, m; NaN stays NaN.
pub fn lower_rotation_rad(wall: &WallParameters, height_m: f64, displacement_m: f64) -> f64 {
    // b_1/2 and u have the same sign as θ_1, so the reading itself tells the corner.
    solve(height_m, displacement_m.signum() * 0.5 * wall.lower_width_m, displacement_m)
}

/// θ_2, rad, from θ_1 and the displacement of the upper body at a height, m; NaN stays NaN.
pub fn upper_rotation_rad(wall: &WallParameters, height_m: f64, displacement_m: f64, theta1: f64) -> f64 {
    let Some(h1) = wall.crack_height_m else { return theta1 };
    let half_1 = theta1.signum() * 0.5 * wall.lower_width_m;
    // The crack opens to the side where turning with the lower body falls short of the reading.
    let together = h1 * theta1.sin() + half_1 * (1.0 - theta1.cos()) + (height_m - h1) * theta1.sin();
    let half_2 = (displacement_m - together).signum() * 0.5 * wall.upper_width_m;
    let pivot = half_1 + (half_2 - half_1) * theta1.cos() + h1 * theta1.sin() - half_2;
    solve(height_m - h1, half_2, displacement_m - pivot)
}

/// The rotation at which arm sin θ + half (1 - cos θ) equals u.
fn solve(arm: f64, half: f64, u: f64) -> f64 {
    let mut theta = u / arm;
    for _ in 0..STEPS {
        let residual = arm * theta.sin() + half * (1.0 - theta.cos()) - u;
        theta -= residual / (arm * theta.cos() + half * theta.sin());
    }
    theta
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::RockingWall;

    #[test]
    fn analytic_rotations_come_back_from_the_models_own_displacements() {
        let p = WallParameters::table_wall();
        let wall = RockingWall::new(&Wall::new(p.clone()).expect("a possible wall"));
        for theta in [[0.05, 0.08], [0.05, 0.01], [-0.03, 0.02], [-0.03, -0.05], [0.1, 0.1], [0.0, 0.02]] {
            let contact = mrbd_kernel::model::Contact::of_rotations(theta);
            let top = wall.top_displacement_m(contact, theta);
            let crack = 2.191 * theta[0].sin()
                + 0.5
                    * 0.271
                    * theta[0].abs()
                    * theta[0].tan().signum()
                    * ((1.0 - theta[0].cos()) / theta[0].abs().max(1e-300));
            let theta1 = lower_rotation_rad(&p, 2.191, crack);
            // Roundings of a displacement of up to half a metre, over an arm of some metres.
            assert!((theta1 - theta[0]).abs() < 1e-14, "{theta:?}: {theta1}");
            let theta2 = upper_rotation_rad(&p, 3.984, top, theta1);
            assert!((theta2 - theta[1]).abs() < 1e-13, "{theta:?}: {theta2}");
        }
    }
}

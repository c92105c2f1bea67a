//! A test as the diagnosis sees it: the shaking, what was measured, and how noisy it is.

use std::path::Path;

use super::file::{Purpose, TestTable};
use super::local::{HALF_S, channel_noise_rad};
use super::measured::median_step;
use super::noise::{is_uneven, rest_offset_rad};
use super::shaking::straightened;
use super::test::Test;
use crate::limits::{LEAST_SAMPLES, TOO_LARGE_RAD};
use mrbd_files::error::InputError;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Pair, Wall};
use mrbd_kernel::simulate::{Shaking, Start};

/// How a test was measured, where not as most are: both rotations, evenly sampled, from rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Manner {
    /// Whether samples are unevenly spaced: states are read from those about a time, not from so many of them.
    pub by_time: bool,
    /// Whether the top was held sideways: θ_2 follows from θ_1, is not measured, and has no samples.
    pub top_held: bool,
    /// The measured state from which the wall moves by itself.
    pub release: Option<Start>,
}

impl Manner {
    /// How many rotations are measured: θ_1 alone where the top is held.
    pub fn channels(self) -> usize {
        if self.top_held { 1 } else { 2 }
    }
}

/// One test: measured rotations of both bodies and the shaking that caused them.
#[derive(Debug, Clone)]
pub struct TestData {
    /// Name in results.
    pub name: String,
    /// Whether the fit sees it, or the result is only judged by it.
    pub purpose: Purpose,
    /// The records, in as few samples as tell them, and free motion to the end of the measurement.
    pub shaking: Shaking,
    /// Times of the samples in the record's time, s.
    pub time_s: Vec<f64>,
    /// θ_1 and θ_2 as read, rad; NaN where a sample is missing or does not count.
    pub theta_rad: Vec<Pair>,
    /// Standard deviation of the noise of each channel, rad.
    pub noise_rad: Pair,
    /// What each channel reads at rest, rad: taken off where a pattern is recognised, never where a model is judged.
    pub rest_offset_rad: Pair,
    /// What each channel reads of a rotation, as far as it is known or was found out: taken out at the same places.
    pub read_gain: Pair,
    /// Time between samples, s: their median distance.
    pub step_s: f64,
    /// Samples farther apart than this are not joined, s.
    pub gap_s: f64,
    /// How it was measured.
    pub manner: Manner,
}

impl TestData {
    /// A test as it was read for the errors over whole runs. Its table says what of the file at `path` counts, and
    /// the wall at which gains its sensors read.
    ///
    /// # Errors
    /// Input errors for a channel that is lost or without noise, rotations no standing wall has, a measurement apart
    /// from its record, or too few samples.
    pub fn new(test: &Test, path: &Path, table: &TestTable, wall: &Wall) -> Result<Self, InputError> {
        let refuse = |found: String, allowed: &str| InputError::file(path, found, allowed);
        let measured = &test.measured;
        check_both_told(test, path)?;
        check_radians(test, path, table)?;
        let (time_s, mut theta_rad) = measured.counted(&super::release::counted_s(table));
        check_shaken(test, path, &time_s)?;
        let step_s = median_step(&time_s).filter(|_| time_s.len() >= LEAST_SAMPLES).ok_or_else(|| {
            let found =
                format!("{} samples of test {:?} from its record's beginning on", time_s.len(), test.name);
            let allowed = format!("{LEAST_SAMPLES} or more before the wall falls; are rotations in radians?");
            refuse(found, &allowed)
        })?;
        let by_time = is_uneven(&time_s, measured.gap_s);
        // Uneven samples nearer than a channel is a cubic are joined.
        let gap_s = match table.gap_s {
            None if by_time => measured.gap_s.max(HALF_S),
            _ => measured.gap_s,
        };
        let [Some(lower_rad), Some(upper_rad)] = channel_noise_rad(measured, &time_s, &theta_rad) else {
            return Err(refuse("no noise at all".into(), "rotations as measured"));
        };
        let noise_rad = [lower_rad, upper_rad];
        let step_s = if by_time { mean_step(&time_s, gap_s).unwrap_or(step_s) } else { step_s };
        // What follows from the other rotation is no second reading.
        if test.top_held {
            theta_rad.iter_mut().for_each(|theta| theta[1] = f64::NAN);
        }
        let [last_s, record_s] = [time_s.last().copied().unwrap_or(0.0), record_s(test)];
        let tail_s = (last_s - record_s).max(0.0) + gap_s;
        let shaking = Shaking { tail_s, ..test.shaking.clone() };
        let shaking = straightened(shaking, wall.parameters(), f64::min(lower_rad, upper_rad), last_s);
        Ok(Self {
            name: test.name.clone(),
            purpose: test.purpose,
            shaking,
            step_s,
            time_s,
            rest_offset_rad: rest_offset_rad(&theta_rad, noise_rad),
            read_gain: wall.reading().gain,
            theta_rad,
            noise_rad,
            gap_s,
            manner: Manner { by_time, top_held: test.top_held, release: test.start() },
        })
    }

    /// Rotations of a sample, rad, with what is read at rest as zero and without the gains that were found.
    pub fn from_rest_rad(&self, k: usize) -> Pair {
        let ([lower, upper], rest_rad, gain) = (self.theta_rad[k], self.rest_offset_rad, self.read_gain);
        [(lower - rest_rad[0]) / gain[0], (upper - rest_rad[1]) / gain[1]]
    }

    /// Samples per second times `seconds`, at least one.
    pub fn samples_in(&self, seconds: f64) -> usize {
        (seconds / self.step_s).round().max(1.0) as usize
    }
}

/// Refuses a test that tells one rotation only.
fn check_both_told(test: &Test, path: &Path) -> Result<(), InputError> {
    let [Some(_), Some(_)] = &test.measured.theta_rad else {
        let found = format!("one rotation only in test {:?}", test.name);
        let allowed = "what tells both: theta1_rad and theta2_rad, a displacement up to the crack and one above it, \
             or either and top_held = true";
        return Err(InputError::file(path, found, allowed));
    };
    Ok(())
}

/// Length of the record of a test, s; 0 where it moved by itself.
fn record_s(test: &Test) -> f64 {
    test.shaking.horizontal.as_ref().map_or(0.0, Accelerogram::duration_s)
}

/// Refuses samples that all lie outside the record, where there is one.
fn check_shaken(test: &Test, path: &Path, time_s: &[f64]) -> Result<(), InputError> {
    let [first_s, last_s] = [time_s.first(), time_s.last()].map(|t| t.copied().unwrap_or(0.0));
    let record_s = record_s(test);
    if test.shaking.horizontal.is_none() || last_s.min(record_s) > first_s {
        return Ok(());
    }
    let measured_s = &test.measured.time_s;
    let [from_s, to_s] = [measured_s.first(), measured_s.last()].map(|t| t.copied().unwrap_or(0.0));
    let found = format!("test {:?} measured from {from_s:.2} to {to_s:.2} s of the record's time", test.name);
    let allowed = format!("times that overlap the record, 0 to {record_s:.2} s; see start_s");
    Err(InputError::file(path, found, allowed))
}

/// Mean distance of samples that no gap parts, s.
fn mean_step(time_s: &[f64], gap_s: f64) -> Option<f64> {
    let steps = time_s.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step <= gap_s);
    let (sum, count) = steps.fold((0.0, 0.0), |(sum, count), step| (sum + step, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// Refuses rotations that no standing wall has: they are in degrees.
///
/// # Errors
/// An input error on the measured file at `path`.
pub(crate) fn check_radians(test: &Test, path: &Path, table: &TestTable) -> Result<(), InputError> {
    let measured = &test.measured;
    let fell_s = table.collapse_s.unwrap_or(f64::INFINITY);
    let standing = measured.time_s.iter().take_while(|time_s| **time_s < fell_s).count();
    let rotations = measured.theta_rad.iter().flatten().flat_map(|theta| &theta[..standing]);
    let largest_rad =
        rotations.map(|theta| theta.abs()).filter(|theta| theta.is_finite()).fold(0.0, f64::max);
    if largest_rad <= TOO_LARGE_RAD {
        return Ok(());
    }
    let found = format!("a rotation of {largest_rad:.3} in test {:?}", test.name);
    let allowed = format!(
        "radians, below {TOO_LARGE_RAD} while the wall stands; are these degrees? A wall that fell: collapse_s"
    );
    Err(InputError::file(path, found, allowed))
}

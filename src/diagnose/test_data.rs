//! A test as the diagnosis sees it: the shaking, what was measured, and how noisy it is.

use std::path::Path;

use super::noise::noise_rad;
use crate::calibrate::Measured;
use crate::error::{InputError, Result};
use crate::ground::{ReadOptions, read};
use crate::input::experiment::{Purpose, TestTable};
use crate::model::{Pair, Wall};
use crate::simulate::Shaking;

/// Fewest samples of both rotations that can be diagnosed: some windows of tens of samples.
const LEAST_SAMPLES: usize = 200;

/// No wall that still stands has turned by this much, rad; read in degrees one has at once.
const TOO_LARGE_RAD: f64 = 0.7;

/// One test: measured rotations of both bodies and the shaking that caused them.
#[derive(Debug, Clone)]
pub struct TestData {
    /// Name in results.
    pub name: String,
    /// Whether the fit sees it, or the result is only judged by it.
    pub purpose: Purpose,
    /// The record, and free motion to the end of the measurement.
    pub shaking: Shaking,
    /// Times of the samples in the record's time, s.
    pub time_s: Vec<f64>,
    /// θ_1 and θ_2 as read, rad; NaN where a sample is missing.
    pub theta_rad: Vec<Pair>,
    /// Standard deviation of the noise of each channel, rad.
    pub noise_rad: Pair,
    /// Time between samples, s: their median distance.
    pub step_s: f64,
    /// Samples farther apart than this are not joined, s.
    pub gap_s: f64,
}

impl TestData {
    /// Reads a test of an experiment; its paths are relative to `folder`.
    ///
    /// # Errors
    /// Input errors of the record and of the measured file; a channel that is lost; too few samples.
    pub fn load(folder: &Path, table: &TestTable, wall: &Wall) -> Result<Self> {
        let options = ReadOptions { step_s: table.record_step_s, ..ReadOptions::default() };
        let record = read(&folder.join(&table.record), &options)?.accelerogram.scaled(table.scale);
        let path = folder.join(&table.measured);
        let measured = Measured::load(&path, table, wall)?;
        let [Some(lower), Some(upper)] = &measured.theta_rad else {
            let found = format!("one rotation only in test {:?}", table.name);
            return Err(InputError::file(&path, found, "theta1_rad and theta2_rad").into());
        };
        let largest_rad =
            lower.iter().chain(upper).filter(|t| t.is_finite()).fold(0.0, |m, t| f64::max(m, t.abs()));
        if largest_rad > TOO_LARGE_RAD && table.collapse_s.is_none() {
            let found = format!("a rotation of {largest_rad:.3} in test {:?}", table.name);
            let allowed =
                "radians, below 0.7 while the wall stands; are these degrees? A wall that fell: collapse_s";
            return Err(InputError::file(&path, found, allowed).into());
        }
        let end_s = measured.collapse_s.unwrap_or(f64::INFINITY);
        let kept = |k: &usize| measured.time_s[*k] >= 0.0 && measured.time_s[*k] < end_s;
        let kept = (0..measured.time_s.len()).filter(kept).collect::<Vec<_>>();
        let time_s = kept.iter().map(|&k| measured.time_s[k]).collect::<Vec<_>>();
        let theta_rad = kept.iter().map(|&k| [lower[k], upper[k]]).collect::<Vec<_>>();
        let last_s = time_s.last().copied().unwrap_or(0.0);
        let overlap_s = last_s.min(record.duration_s()) - time_s.first().copied().unwrap_or(0.0);
        if time_s.len() < LEAST_SAMPLES || overlap_s <= 0.0 {
            let found = format!(
                "{} samples of test {:?} within its record of {:.2} s",
                time_s.len(),
                table.name,
                record.duration_s()
            );
            return Err(InputError::file(&path, found, format!("{LEAST_SAMPLES} or more")).into());
        }
        let noise_rad = noise_rad(&time_s, &theta_rad, measured.gap_s)
            .ok_or_else(|| InputError::file(&path, "no noise at all", "rotations as measured"))?;
        let tail_s = (last_s - record.duration_s()).max(0.0) + measured.gap_s;
        Ok(Self {
            name: table.name.clone(),
            purpose: table.purpose,
            shaking: Shaking { horizontal: Some(record), vertical: None, tail_s },
            step_s: median_step_s(&time_s),
            time_s,
            theta_rad,
            noise_rad,
            gap_s: measured.gap_s,
        })
    }

    /// Samples per second times `seconds`, at least one.
    pub fn samples_in(&self, seconds: f64) -> usize {
        (seconds / self.step_s).round().max(1.0) as usize
    }
}

fn median_step_s(time_s: &[f64]) -> f64 {
    let mut steps = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
    steps.sort_by(f64::total_cmp);
    steps[steps.len() / 2]
}

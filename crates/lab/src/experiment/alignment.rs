//! Clocks of record and measurement brought together: by a time that was given, or by matching the first motion.
//!
//! The simulated beginning of the wall as given is moved along the measurement until ∫|θ_exp - θ_num| is least. Only
//! until the first impacts does it not depend on the coefficients that are sought. Where shaking grows slowly these
//! impacts are over before a rotation can be seen. With wrong coefficients the time found would then be some
//! hundredths of a second off. So a beginning that does not fit is refused, and the time must be given.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::file::{StartTime, TestTable};
use super::measured::Measured;
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::{Pair, Wall};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};

/// Rows of the simulated history a sample of the record.
const FINER: f64 = 5.0;
/// The motion has begun at this share of its largest rotation.
const BEGUN: f64 = 0.02;
/// Rest before the motion that is matched too, s.
const REST_BEFORE_S: f64 = 0.5;
/// Swings that are matched, from the beginning on: later ones depend on the coefficients sought.
const SWINGS: usize = 2;
/// Share of the matched stretch that must have been measured.
const COVERED: f64 = 0.9;
/// Mismatch above which nothing fits. A twin whose wall file had C_l = 1 for 0.76 to 1.03 was aligned 25 ms off, at
/// 0.2. With the right ones it was aligned to 0.1 ms.
const MOST_MISMATCH: f64 = 0.1;
/// Halvings of the step about the best time found.
const HALVINGS: u32 = 12;

/// How the clocks were brought together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Alignment {
    /// Time of the record at which the measured time is zero, s.
    pub start_s: f64,
    /// Whether it was found by matching.
    pub matched: bool,
    /// ∫|θ_exp - θ_num| / ∫|θ_num| of the matched beginning; `None` where the time was given.
    pub mismatch: Option<f64>,
}

/// Moves a measurement into the record's time.
///
/// # Errors
/// An input error if the beginning is to be matched and the wall as given does not move, or no time fits.
pub(super) fn aligned(
    path: &Path,
    table: &TestTable,
    measured: Measured,
    wall: &Wall,
    shaking: &Shaking,
    accuracy: Accuracy,
) -> Result<(Measured, Alignment)> {
    let (start_s, mismatch) = match table.start_s {
        StartTime::Given(start_s) => (start_s, None),
        StartTime::Match => {
            let beginning = Beginning::of(wall, shaking, accuracy);
            let best = beginning.and_then(|b| b.best_start(&measured));
            let (start_s, mismatch) = best.filter(|(_, m)| *m <= MOST_MISMATCH).ok_or_else(|| {
                let least = best.map_or_else(String::new, |(_, m)| format!("; the least mismatch is {m:.2}"));
                let found = format!("no beginning of a motion that matches in test {:?}{least}", table.name);
                let allowed =
                    format!("a mismatch up to {MOST_MISMATCH} of the wall as given, or start_s in seconds");
                InputError::file(path, found, allowed)
            })?;
            (start_s, Some(mismatch))
        }
    };
    let matched = table.start_s == StartTime::Match;
    Ok((measured.moved(start_s, table.collapse_s, wall), Alignment { start_s, matched, mismatch }))
}

/// The simulated beginning of the motion.
struct Beginning {
    step_s: f64,
    theta_rad: Vec<Pair>,
    from_s: f64,
    to_s: f64,
}

impl Beginning {
    fn of(wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Option<Self> {
        let step_s = shaking.horizontal.as_ref()?.step_s() / FINER;
        let mut history = History::new(step_s);
        simulate_observed(wall, shaking, accuracy, &mut history);
        let theta_rad = history.rows.iter().map(|row| row.theta_rad).collect::<Vec<_>>();
        let largest = theta_rad.iter().map(|theta| theta[0].abs()).fold(0.0, f64::max);
        let begun = theta_rad.iter().position(|theta| largest > 0.0 && theta[0].abs() > BEGUN * largest)?;
        let turns = (begun + 1..theta_rad.len()).filter(|&k| theta_rad[k - 1][0] * theta_rad[k][0] < 0.0);
        let end = turns.take(SWINGS).last().unwrap_or(theta_rad.len() - 1);
        let from_s = (begun as f64 * step_s - REST_BEFORE_S).max(0.0);
        Some(Self { step_s, theta_rad, from_s, to_s: end as f64 * step_s })
    }

    /// The start of least mismatch among all that the measurement allows, and its mismatch.
    fn best_start(&self, measured: &Measured) -> Option<(f64, f64)> {
        let (first, last) = (*measured.time_s.first()?, *measured.time_s.last()?);
        let mut step_s = FINER * self.step_s;
        let (least, most) = (self.from_s - last, self.to_s - first);
        let steps = ((most - least) / step_s) as usize;
        let tried = (0..=steps).filter_map(|k| {
            let start_s = least + k as f64 * step_s;
            self.mismatch(measured, start_s).map(|mismatch| (start_s, mismatch))
        });
        let mut best = tried.reduce(|a, b| if b.1 < a.1 { b } else { a })?;
        for _ in 0..HALVINGS {
            step_s *= 0.5;
            for start_s in [best.0 - step_s, best.0 + step_s] {
                if let Some(mismatch) = self.mismatch(measured, start_s).filter(|m| *m < best.1) {
                    best = (start_s, mismatch);
                }
            }
        }
        Some(best)
    }

    /// ∫|θ_exp - θ_num| / ∫|θ_num| over the beginning; `None` if too little of it was measured.
    fn mismatch(&self, measured: &Measured, start_s: f64) -> Option<f64> {
        let from = measured.time_s.partition_point(|t| t + start_s < self.from_s);
        let to = measured.time_s.partition_point(|t| t + start_s <= self.to_s);
        let (mut errors, mut rotations, mut counted_s) = (0.0, 0.0, 0.0);
        for k in from..to.min(measured.time_s.len() - 1) {
            let weight_s = measured.time_s[k + 1] - measured.time_s[k];
            if weight_s > measured.gap_s {
                continue;
            }
            let simulated = self.at(measured.time_s[k] + start_s);
            for (theta, simulated) in measured.theta_rad.iter().zip(simulated) {
                let Some(value) = theta.as_ref().map(|theta| theta[k]).filter(|x| x.is_finite()) else {
                    continue;
                };
                errors += weight_s * (value - simulated).abs();
                rotations += weight_s * simulated.abs();
            }
            counted_s += weight_s;
        }
        let covered = counted_s >= COVERED * (self.to_s - self.from_s) && rotations > 0.0;
        covered.then(|| errors / rotations)
    }

    /// Rotations at a time, linear between the rows.
    fn at(&self, time_s: f64) -> Pair {
        let place = (time_s / self.step_s).max(0.0);
        let k = (place as usize).min(self.theta_rad.len().saturating_sub(2));
        let share = (place - k as f64).clamp(0.0, 1.0);
        let [a, b] = [k, k + 1].map(|k| self.theta_rad[k.min(self.theta_rad.len() - 1)]);
        [0, 1].map(|i| a[i] + share * (b[i] - a[i]))
    }
}

//! Short windows of a test that start where the measured pattern is beyond doubt.
//!
//! The motion of an impact system forgets its past badly: a simulation over a whole test parts from the measurement for
//! the smallest cause. Over a window with one or two impacts it does not, once the state at its start is fitted.

use std::ops::Range;

use super::file::Purpose;
use super::pattern::{Freedom, MeasuredState, measured_state};
use super::test_data::TestData;
use crate::limits::{LEAST_WINDOW_SAMPLES, MOVES, WINDOW_S};

/// Samples to the next doubt beyond which a start is as good as any.
const FAR_FROM_DOUBT: usize = 40;
/// Preference for starting in pattern 3, in samples: two numbers to fit and no crack that opens by less than the noise.
const MONOLITHIC: i64 = 10;
/// Aversion to starting in rest soon after motion, in samples, and how soon: a wall about to stop may not stand quite.
const JUST_STOPPED: i64 = -20;
const SOON: usize = 60;

/// A stretch of a test and the state at its start.
#[derive(Debug, Clone)]
pub struct Window {
    /// The test, by its place in the experiment.
    pub test: usize,
    /// Whether the fit sees it.
    pub purpose: Purpose,
    /// Its samples.
    pub samples: Range<usize>,
    /// Rotations measured in it: two of each sample, less those that are missing.
    pub readings: usize,
    /// What is free at its start.
    pub freedom: Freedom,
    /// Whether both bodies are free though a joint reads as closed.
    pub opened: bool,
    /// The state smoothed from the measurement: (θ, θ') of the free bodies.
    pub measured: Vec<f64>,
    /// Changes of these, within what the noise leaves open, over which sensitivities are taken.
    pub spread: Vec<f64>,
}

/// Whether a window can start somewhere in a test.
pub fn is_readable(test: &TestData) -> bool {
    (0..test.time_s.len()).any(|k| measured_state(test, k).is_some())
}

/// The windows of all tests in which the wall moves: where it stands it says little, and would take half of the work.
pub fn windows(tests: &[TestData]) -> Vec<Window> {
    tests.iter().enumerate().flat_map(|(index, test)| windows_of(index, test)).collect()
}

fn windows_of(index: usize, test: &TestData) -> Vec<Window> {
    let count = test.time_s.len();
    let states = (0..count).map(|k| measured_state(test, k)).collect::<Vec<_>>();
    let worth = worths(test, &states);
    let step = test.samples_in(WINDOW_S);
    let [nearest, farthest] = reach(test, step);
    let mut starts = Vec::new();
    let mut next = (0..count).find(|&k| states[k].is_some());
    while let Some(k) = next {
        starts.push(k);
        let reach = (k + nearest).min(count)..(k + farthest).min(count);
        let best = reach.clone().rev().max_by_key(|&k| worth[k]);
        next = best.filter(|&k| states[k].is_some());
        next = next.or_else(|| (reach.end..count).find(|&k| states[k].is_some()));
    }
    let ends = starts.iter().skip(1).copied().chain([count]).collect::<Vec<_>>();
    let pairs = starts.iter().zip(ends);
    let longest = 4 * step;
    pairs
        .filter_map(|(&from, to)| {
            let to = gap_after(test, from).min(to).min(from + longest);
            window(index, test, from..to, states[from].as_ref()?)
        })
        .collect()
}

/// How many samples after a start the next may be.
///
/// Where samples are few every window must hold enough of them all the same.
fn reach(test: &TestData, step: usize) -> [usize; 2] {
    let even = [step / 2, 3 * step / 2];
    let sparse = test.manner.by_time && even[0] < LEAST_WINDOW_SAMPLES;
    if sparse { even.map(|samples| samples + LEAST_WINDOW_SAMPLES - even[0]) } else { even }
}

/// The first sample after another that is not joined to the one before it, or their number.
fn gap_after(test: &TestData, from: usize) -> usize {
    // A simulated window passes over a gap; only where gaps are rare is it worth none.
    let longest_s = if test.manner.by_time { test.gap_s.max(0.5 * WINDOW_S) } else { test.gap_s };
    let gap = |k: &usize| test.time_s[*k] - test.time_s[*k - 1] > longest_s;
    (from + 1..test.time_s.len()).find(gap).unwrap_or(test.time_s.len())
}

/// How good a start each sample is: far from doubt.
fn worths(test: &TestData, states: &[Option<MeasuredState>]) -> Vec<i64> {
    let freedom = |k: usize| states[k].as_ref().map(|s| s.freedom);
    let count = states.len();
    let same = |k: usize, other: usize| freedom(k).is_some() && freedom(k) == freedom(other);
    let (mut before, mut after) = (vec![0_usize; count], vec![0_usize; count]);
    for k in 1..count {
        before[k] = if same(k, k - 1) { before[k - 1] + 1 } else { 0 };
    }
    for k in (0..count.saturating_sub(1)).rev() {
        after[k] = if same(k, k + 1) { after[k + 1] + 1 } else { 0 };
    }
    let moved_soon = |k: usize| (k.saturating_sub(SOON)..k).any(|j| moves(test, j));
    let worth = |k: usize| match freedom(k) {
        None => i64::MIN,
        Some(freedom) => {
            let far = before[k].min(after[k]).min(FAR_FROM_DOUBT) as i64;
            far + match freedom {
                Freedom::Monolithic => MONOLITHIC,
                Freedom::Rest if moved_soon(k) => JUST_STOPPED,
                _ => 0,
            }
        }
    };
    (0..count).map(worth).collect()
}

fn moves(test: &TestData, k: usize) -> bool {
    let theta = test.from_rest_rad(k);
    (0..2).any(|i| theta[i].abs() > MOVES * test.noise_rad[i])
}

fn window(index: usize, test: &TestData, samples: Range<usize>, start: &MeasuredState) -> Option<Window> {
    let in_motion = samples.clone().filter(|&k| moves(test, k)).count() > 2;
    let readings = test.theta_rad[samples.clone()].iter().flatten().filter(|t| t.is_finite()).count();
    let channels = test.manner.channels();
    if readings < channels * LEAST_WINDOW_SAMPLES || (start.freedom == Freedom::Rest && !in_motion) {
        return None;
    }
    Some(Window {
        test: index,
        purpose: test.purpose,
        freedom: start.freedom,
        opened: false,
        measured: start.numbers.clone(),
        spread: start.spread.clone(),
        readings,
        samples,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Manner;
    use mrbd_kernel::simulate::Shaking;

    const NOISE_RAD: f64 = 1e-5;

    /// Four seconds of a wall that sways in pattern 3, at these samples of 200 a second.
    fn swaying(samples: impl Iterator<Item = u32>) -> TestData {
        let time_s = samples.map(|k| 0.005 * f64::from(k)).collect::<Vec<_>>();
        TestData {
            name: "swaying".to_owned(),
            purpose: Purpose::Fit,
            shaking: Shaking { tail_s: 1.0, ..Shaking::default() },
            theta_rad: time_s.iter().map(|t| [0.02 + 0.01 * (3.0 * t).sin(); 2]).collect(),
            time_s,
            noise_rad: [NOISE_RAD; 2],
            rest_offset_rad: [0.0; 2],
            read_gain: [1.0; 2],
            step_s: 0.005,
            gap_s: 0.0125,
            manner: Manner::default(),
        }
    }

    #[test]
    fn analytic_motion_sampled_unevenly_has_windows_that_start_in_its_states() {
        // One, two and three steps in turn, and a fifth of a second without samples.
        let uneven = (0..400).flat_map(|k| [6 * k, 6 * k + 1, 6 * k + 3]).take_while(|k| *k < 800);
        let manner = Manner { by_time: true, ..Manner::default() };
        let even = swaying(uneven.filter(|k| !(300..340).contains(k)));
        let test = TestData { step_s: 0.01, gap_s: 0.06, manner, ..even };
        let held = Manner { top_held: true, ..manner };
        let lower = test.theta_rad.iter().map(|theta| [theta[0], f64::NAN]).collect();
        let held = TestData { theta_rad: lower, manner: held, ..test.clone() };
        for (test, freedom) in [(test, Freedom::Monolithic), (held, Freedom::Held)] {
            let found = windows(std::slice::from_ref(&test));
            assert!(found.len() > 4, "{}", found.len());
            for window in found {
                assert_eq!(window.freedom, freedom);
                let t = test.time_s[window.samples.start];
                // Over 0.06 s a cubic leaves 3⁴ 0.01/24 0.06⁴ of the sine, 4e-7 rad, and some of that by 0.06 s of its slope.
                let x = [0.02 + 0.01 * (3.0 * t).sin(), 0.03 * (3.0 * t).cos()];
                let off = [0, 1].map(|i| (window.measured[i] - x[i]).abs());
                assert!(off[0] < 4e-7 && off[1] < 4e-5, "at {t}: {off:?}");
            }
        }
    }

    #[test]
    fn analytic_no_window_reaches_over_a_gap_and_none_is_there_without_samples() {
        assert!(windows(&[swaying(0..0)]).is_empty());
        // A tenth of a second was not written, in the middle of what would be a window.
        let test = swaying((0..415).chain(435..800));
        let found = windows(std::slice::from_ref(&test));
        assert!(found.len() > 4, "{}", found.len());
        for window in &found {
            let times = &test.time_s[window.samples.clone()];
            assert!(times.windows(2).all(|pair| pair[1] - pair[0] < test.gap_s), "{:?}", window.samples);
            assert_eq!(window.readings, 2 * times.len());
        }
    }

    #[test]
    fn analytic_missing_readings_do_not_count() {
        let mut test = swaying(0..800);
        for k in 410..430 {
            test.theta_rad[k][1] = f64::NAN;
        }
        let found = windows(std::slice::from_ref(&test));
        let missing = found.iter().map(|w| 2 * w.samples.len() - w.readings).sum::<usize>();
        assert_eq!(missing, 20);
    }
}

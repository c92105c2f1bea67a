//! Short windows of a test that start where the measured pattern is beyond doubt.
//!
//! The motion of an impact system forgets its past badly: a simulation over a whole test parts from the measurement for
//! the smallest cause. Over a window with one or two impacts it does not, once the state at its start is fitted.

use std::ops::Range;

use super::file::Purpose;
use super::pattern::{Freedom, MeasuredState, measured_state, stands_among_even};
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

/// Whether the wall moves in a test, but no sample of its motion stands among evenly spaced ones: no state can be read there.
pub fn moves_unevenly(test: &TestData) -> bool {
    let moving = (0..test.time_s.len()).filter(|&k| moves(test, k)).collect::<Vec<_>>();
    moving.len() >= LEAST_WINDOW_SAMPLES && !moving.into_iter().any(|k| stands_among_even(test, k))
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
    let mut starts = Vec::new();
    let mut next = (0..count).find(|&k| states[k].is_some());
    while let Some(k) = next {
        starts.push(k);
        let reach = (k + step / 2).min(count)..(k + 3 * step / 2).min(count);
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

/// The first sample after another that is not joined to the one before it, or their number.
fn gap_after(test: &TestData, from: usize) -> usize {
    let gap = |k: &usize| test.time_s[*k] - test.time_s[*k - 1] > test.gap_s;
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
    if readings < 2 * LEAST_WINDOW_SAMPLES || (start.freedom == Freedom::Rest && !in_motion) {
        return None;
    }
    let noise = test.noise_rad[0].max(test.noise_rad[1]);
    // A cubic through 17 samples knows its value to 0.37 and its slope to 0.125 of the noise a sample: about that for the
    // value, a fifth of it for the slope, over which the motion is still linear.
    let spread = [0.5 * noise, 0.025 * noise / test.step_s];
    Some(Window {
        test: index,
        purpose: test.purpose,
        freedom: start.freedom,
        opened: false,
        measured: start.numbers.clone(),
        spread: spread.iter().copied().cycle().take(start.freedom.numbers()).collect(),
        readings,
        samples,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::simulate::Shaking;

    const NOISE_RAD: f64 = 1e-5;

    #[test]
    fn regress_motion_sampled_unevenly_is_told_from_motion_sampled_evenly() {
        assert!(!moves_unevenly(&swaying(0..800)));
        // One, two and three steps in turn.
        let uneven = (0..400).flat_map(|k| [6 * k, 6 * k + 1, 6 * k + 3]).take_while(|k| *k < 800);
        assert!(moves_unevenly(&swaying(uneven)));
        let still = TestData { theta_rad: vec![[0.0; 2]; 800], ..swaying(0..800) };
        assert!(!moves_unevenly(&still));
    }

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

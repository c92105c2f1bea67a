//! Patterns read again, where a sensor turns out to read a gain, and where a joint may be open by less than the noise.
//!
//! Two channels that part by a few percent look like an open crack, so that windows start in patterns the wall was not in,
//! and not even the true gain follows them. The gain itself is found all the same: without it patterns are read anew.
//!
//! A joint that is open by less than the noise reads as closed. What it does soon shows, so that a window that starts so is
//! followed by no wall; it may be once its bodies are free.

use rayon::prelude::*;

use super::fit::Fit;
use super::pattern::Freedom;
use super::replay::Replay;
use super::score::nats;
use super::search::Tried;
use super::test_data::TestData;
use super::window_fit::{POOR, WindowFit, fit_window, other_valleys};
use super::windows::Window;
use crate::model::Pair;

/// Steps by which the state of a window with its bodies free is fitted.
const STEPS: usize = 4;
/// Share of the squared error that the free bodies may leave of a window for its joints to count as open.
const LEFT_BY_OPENING: f64 = 0.5;

/// The gain of each channel that the best single effect names, where taking it out could change how a pattern is read.
pub fn gain_misread(tests: &[TestData], best: &Tried) -> Option<Pair> {
    let gain = best.hypothesis.physics(&best.fit.values)?.wall.reading().gain;
    let shows = |test: &TestData| {
        let change = [0, 1].map(|i| gain[i] / test.read_gain[i] - 1.0);
        let largest = |i: usize| test.theta_rad.iter().map(|t| t[i].abs()).fold(0.0, f64::max);
        (0..2).any(|i| change[i].abs() * largest(i) > test.noise_rad[i])
    };
    tests.iter().any(shows).then_some(gain)
}

/// Reads the tests with these gains; those before.
pub fn set_gain(tests: &mut [TestData], gain: Pair) -> Pair {
    let before = tests.first().map_or([1.0; 2], |test| test.read_gain);
    tests.iter_mut().for_each(|test| test.read_gain = gain);
    before
}

/// Whether the best single effect is a gain again, and leaves less of its windows than it left of those before.
pub fn reads_better(before: &[Tried], after: &[Tried]) -> bool {
    let is_gain = |t: &Tried| t.hypothesis.additions.iter().any(|a| a.kind() == Some("sensor_gain"));
    let [Some(before), Some(after)] = [before, after].map(<[Tried]>::first) else { return false };
    is_gain(after) && left(after) < left(before)
}

/// What speaks against it, by window: the windows are others once patterns are read anew.
fn left(tried: &Tried) -> f64 {
    let windows = [&tried.fit.windows[..], &tried.held_out.windows].concat();
    nats(&windows) / windows.len() as f64
}

/// The windows of a fit, those that it follows badly with both bodies free at their start where that follows them; none where
/// no window changes.
pub fn opened(tests: &[TestData], tried: &Tried, fit: &Fit, windows: &[Window]) -> Option<Vec<Window>> {
    let replay = Replay::new(tests, &tried.hypothesis.physics(&fit.values)?);
    let open = |(window, closed): (&Window, &WindowFit)| {
        let doubt = closed.reduced() > POOR && matches!(window.freedom, Freedom::Monolithic | Freedom::Upper);
        if doubt { with_free_bodies(&replay, tests, window, closed) } else { None }
    };
    let found = windows.par_iter().zip(&fit.windows).map(open).collect::<Vec<_>>();
    let any = found.iter().any(Option::is_some);
    let windows = windows.iter().zip(found).map(|(old, new)| new.unwrap_or_else(|| old.clone()));
    any.then(|| windows.collect())
}

/// A window whose closed joint is open to one side or the other by half the noise, if its state then follows the measurement.
fn with_free_bodies(
    replay: &Replay,
    tests: &[TestData],
    window: &Window,
    closed: &WindowFit,
) -> Option<Window> {
    let noise_rad = tests[window.test].noise_rad;
    let (theta, omega) = (closed.x[0], closed.x[1]);
    let starts = [0.5, -0.5].map(|share| match window.freedom {
        Freedom::Upper => [share * noise_rad[0], 0.0, theta, omega],
        _ => [theta, omega, theta + share * noise_rad[1], omega],
    });
    let spread = [&window.spread[..], &window.spread].concat();
    let fits = starts.map(|x| {
        let free =
            Window { freedom: Freedom::Both, measured: x.to_vec(), spread: spread.clone(), ..window.clone() };
        let fit = fit_window(replay, &free, &x, STEPS);
        let fit = if fit.reduced() > POOR { other_valleys(replay, &free, &fit, STEPS) } else { fit };
        (fit, free)
    });
    let (fit, free) = fits.into_iter().min_by(|a, b| a.0.squares.total_cmp(&b.0.squares))?;
    let follows = fit.reduced() < POOR && fit.squares < LEFT_BY_OPENING * closed.squares;
    follows.then_some(Window { measured: fit.x, ..free })
}

//! Patterns read again where a sensor turns out to read a gain.
//!
//! Two channels that part by a few percent look like an open crack, so that windows start in patterns the wall was not in,
//! and not even the true gain follows them. The gain itself is found all the same: without it patterns are read anew.

use super::Tried;
use crate::diagnose::fit::nats;
use crate::diagnose::measured::TestData;
use mrbd_kernel::model::{EffectKind, Pair};

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
    let is_gain = |t: &Tried| t.hypothesis.additions.iter().any(|a| a.kind() == Some(EffectKind::SensorGain));
    let [Some(before), Some(after)] = [before, after].map(<[Tried]>::first) else { return false };
    is_gain(after) && left(after) < left(before)
}

/// What speaks against it, by window: the windows are others once patterns are read anew.
fn left(tried: &Tried) -> f64 {
    let windows = [&tried.fit.windows[..], &tried.held_out.windows].concat();
    nats(&windows) / windows.len() as f64
}

//! Stretches of a measurement in which the contact state is plain and no impact happens.

use super::misfit::Sample;
use mrbd_kernel::model::{Contact, Pair, Pivot};

/// An opening counts as one when it is this many standard deviations of the noise.
const CLEAR: f64 = 3.0;
/// Least opening that counts as one where there is no noise, rad.
const LEAST_OPENING_RAD: f64 = 1e-6;
/// Shortest stretch, s: a joint that only passes through zero is within the noise for less.
const SHORTEST_S: f64 = 0.06;
/// Length at the end of a stretch that is used, s: longer ones tell its velocity no better than the model does.
const LONGEST_S: f64 = 0.25;
/// Samples farther apart than this many median distances leave a gap.
const GAP_IN_STEPS: f64 = 2.5;

/// A stretch, by the numbers of its first sample and the one after its last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stretch {
    pub first: usize,
    pub end: usize,
    pub contact: Contact,
}

/// The stretches of a measurement, in order, each cut to its last quarter of a second; none if a channel is lost.
pub(super) fn stretches(samples: &[Sample], noise_rad: Pair) -> Vec<Stretch> {
    let contact = |s: &Sample| contact(s, noise_rad);
    let step_s = median(samples.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect());
    let together = |k: usize| {
        let (a, b) = (&samples[k - 1], &samples[k]);
        contact(a) == contact(b) && b.time_s - a.time_s <= GAP_IN_STEPS * step_s
    };
    let mut found = Vec::new();
    let mut first = 0;
    for end in 1..=samples.len() {
        if end < samples.len() && together(end) {
            continue;
        }
        let last_s = samples[end - 1].time_s;
        if let Some(contact) =
            contact(&samples[first]).filter(|_| last_s - samples[first].time_s >= SHORTEST_S)
        {
            let used = samples[first..end].partition_point(|s| s.time_s < last_s - LONGEST_S);
            found.push(Stretch { first: first + used, end, contact });
        }
        first = end;
    }
    found
}

/// The contact state a sample shows; none where a channel is missing.
fn contact(s: &Sample, noise_rad: Pair) -> Option<Contact> {
    let pivot = |opening: f64, noise: f64| {
        let clear = opening.abs() > (CLEAR * noise).max(LEAST_OPENING_RAD);
        if clear { Pivot::of_angle(opening) } else { Pivot::Closed }
    };
    let [noise_1, noise_2] = noise_rad;
    let present = s.weight_s.iter().all(|weight| *weight > 0.0);
    present.then(|| Contact {
        ground: pivot(s.theta_rad[0], noise_1),
        crack: pivot(s.theta_rad[1] - s.theta_rad[0], noise_1.hypot(noise_2)),
    })
}

/// Standard deviation of each channel's noise, rad: from third differences of the samples, in which a motion hardly
/// shows, by their median, which impacts do not move.
pub(super) fn noise_rad(samples: &[Sample]) -> Pair {
    [0, 1].map(|i| {
        let third = |w: &[Sample]| {
            let x = |k: usize| w[k].theta_rad[i];
            (x(3) - 3.0 * x(2) + 3.0 * x(1) - x(0)).abs()
        };
        // The median of |z| of a standard normal z is 0.6745; 1² + 3² + 3² + 1² = 20.
        median(samples.windows(4).map(third).collect()) / (0.6745 * 20.0_f64.sqrt())
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(k: usize, theta_rad: Pair) -> Sample {
        Sample { time_s: 0.01 * k as f64, theta_rad, weight_s: [0.01, 0.01], block: 0 }
    }

    #[test]
    fn analytic_stretches_end_where_a_joint_changes_sides() {
        // Half a second in pattern 3a, half a second in 1a, a crossing of the ground in three samples, then 3b.
        let theta = |k: usize| match k {
            0..50 => [0.01, 0.01],
            50..100 => [0.01, 0.02],
            100..103 => [0.0, 0.02],
            _ => [-0.01, -0.01],
        };
        let samples = (0..200).map(|k| sample(k, theta(k))).collect::<Vec<_>>();
        let found = stretches(&samples, [0.0, 0.0]);
        let ends = found.iter().map(|s| (s.first, s.end, s.contact.name())).collect::<Vec<_>>();
        // A quarter of a second at the end of each: 26 samples.
        assert_eq!(ends, [(24, 50, "3a"), (74, 100, "1a"), (174, 200, "3b")]);
    }

    #[test]
    fn analytic_noise_is_told_from_a_fast_motion() {
        let wave = |k: usize| 0.05 * (0.05 * k as f64).sin();
        let noise = |k: usize| if k.is_multiple_of(2) { 1e-4 } else { -1e-4 };
        let samples = (0..400).map(|k| sample(k, [wave(k), wave(k) + noise(k)])).collect::<Vec<_>>();
        let [smooth, noisy] = noise_rad(&samples);
        // A third difference of alternating ± a is 8 a: 8e-4 / (0.6745 √20) = 2.65e-4.
        assert!(smooth < 5e-6 && (noisy / 2.65e-4 - 1.0).abs() < 0.05, "{smooth} {noisy}");
    }
}

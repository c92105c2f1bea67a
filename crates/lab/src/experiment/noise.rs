//! What a channel reads beside the motion, from the channel alone: white noise, and an offset at rest.

use super::pattern::HALF;
use crate::limits::{OFFSET_CLEAR, REST_DRIFT, REST_SCATTER, UNEVEN};
use mrbd_kernel::model::Pair;
use mrbd_statistics::median;

/// Fourth differences of white noise are √70 times as large as the noise.
const FOURTH_DIFFERENCE: f64 = 8.366_600_265_340_756;
/// The median magnitude of a normal variable over its standard deviation.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

/// Standard deviation of the white noise of each channel, rad; `None` of one with too few samples or no noise.
///
/// From the median of the fourth differences. Motion is smooth from sample to sample but for the impacts, which a
/// median does not see. Samples farther apart than `gap_s` are not joined; NaN is no sample.
pub fn noise_rad(time_s: &[f64], theta_rad: &[Pair], gap_s: f64) -> [Option<f64>; 2] {
    [0, 1].map(|channel: usize| {
        let joined = |k: usize| time_s[k + 4] - time_s[k] <= 4.0 * gap_s;
        let at = |k: usize| theta_rad[k][channel];
        let differences = (0..theta_rad.len().saturating_sub(4))
            .filter(|&k| joined(k))
            .map(|k| (at(k) - 4.0 * at(k + 1) + 6.0 * at(k + 2) - 4.0 * at(k + 3) + at(k + 4)).abs())
            .filter(|d| d.is_finite())
            .collect::<Vec<_>>();
        let middle = median(&differences).filter(|middle| *middle > 0.0)?;
        Some(middle / (MEDIAN_OF_NORMAL * FOURTH_DIFFERENCE))
    })
}

/// Share of the samples that must stand in evenly spaced runs for a test to be read as evenly sampled.
const MOSTLY: f64 = 0.5;
/// Samples of a run: as many as a pattern is read from.
const RUN: usize = 2 * HALF + 1;

/// Whether most samples do not stand in evenly spaced runs: then neither noise nor states are read as if they did.
pub fn is_uneven(time_s: &[f64], gap_s: f64) -> bool {
    let joined = |run: &&[f64]| run[RUN - 1] - run[0] <= (RUN - 1) as f64 * gap_s;
    let runs = time_s.windows(RUN).filter(joined).collect::<Vec<_>>();
    let is_even = |run: &&&[f64]| {
        let mean_s = (run[RUN - 1] - run[0]) / (RUN - 1) as f64;
        run.windows(2).all(|pair| ((pair[1] - pair[0]) / mean_s - 1.0).abs() < UNEVEN)
    };
    let even = runs.iter().filter(is_even).count();
    (even as f64) < MOSTLY * runs.len() as f64
}

/// Standard deviation of the white noise of a channel, in its unit, however it is sampled; `None` of one with too few
/// samples or no noise.
///
/// From the median of what cubics through four of five neighbours leave at the fifth: divided differences, over the
/// root of their squared weights. Evenly spaced they are the fourth differences of [`noise_rad`].
pub fn scatter(time_s: &[f64], values: &[f64], gap_s: f64) -> Option<f64> {
    let kept = (0..values.len()).filter(|&k| values[k].is_finite()).collect::<Vec<_>>();
    let of = |some: &[usize]| {
        let weight = |i: &usize| {
            let others = some.iter().filter(|j| *j != i);
            1.0 / others.map(|j| (time_s[*i] - time_s[*j]) / gap_s).product::<f64>()
        };
        let weights = some.iter().map(weight);
        let (sum, squares) = some.iter().zip(weights).fold((0.0, 0.0), |(sum, squares), (i, weight)| {
            (sum + weight * values[*i], squares + weight * weight)
        });
        sum.abs() / squares.sqrt()
    };
    let joined = |some: &&[usize]| time_s[some[4]] - time_s[some[0]] <= 4.0 * gap_s;
    let differences = kept.windows(5).filter(joined).map(of).collect::<Vec<_>>();
    let middle = median(&differences).filter(|middle| *middle > 0.0)?;
    Some(middle / MEDIAN_OF_NORMAL)
}

/// Samples looked at together.
const BLOCK: usize = 40;
/// Fewest blocks of standing still.
const LEAST_BLOCKS: usize = 2;

/// What each channel reads at rest, rad, from the quiet beginning of a test; zero where that is not clear of zero or the
/// test does not begin at rest.
pub fn rest_offset_rad(theta_rad: &[Pair], noise_rad: Pair) -> Pair {
    let still = theta_rad.chunks_exact(BLOCK).take_while(|block| is_still(block, noise_rad)).count();
    if still < LEAST_BLOCKS {
        return [0.0; 2];
    }
    let quiet = &theta_rad[..still * BLOCK];
    let n = quiet.len() as f64;
    [0, 1].map(|i| {
        let mean = mean(quiet, i);
        if mean.abs() > OFFSET_CLEAR * noise_rad[i] / n.sqrt() { mean } else { 0.0 }
    })
}

fn is_still(block: &[Pair], noise_rad: Pair) -> bool {
    let (first, second) = block.split_at(BLOCK / 2);
    (0..2).all(|i| {
        let about = mean(block, i);
        let variance = block.iter().map(|theta| (theta[i] - about).powi(2)).sum::<f64>() / BLOCK as f64;
        let drift = (mean(first, i) - mean(second, i)).abs();
        // A missing sample is no sign of rest: comparisons with NaN fail.
        variance.sqrt() < REST_SCATTER * noise_rad[i]
            && drift < REST_DRIFT * noise_rad[i] * (4.0 / BLOCK as f64).sqrt()
    })
}

fn mean(some: &[Pair], channel: usize) -> f64 {
    some.iter().map(|theta| theta[channel]).sum::<f64>() / some.len() as f64
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    use super::*;

    #[test]
    fn analytic_white_noise_on_a_swing_is_found_within_its_own_scatter() {
        // The median of n differences scatters by about 1.2/√n with overlap: 2 % of 5000 is over three times that.
        let normal = Normal::new(0.0, 3e-5).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let time = (0..5000).map(|k| 0.005 * f64::from(k)).collect::<Vec<_>>();
        let theta = time
            .iter()
            .map(|t| [0.01 * (6.0 * t).sin(), 0.02 * (5.0 * t).cos()])
            .map(|theta| theta.map(|x| x + normal.sample(&mut random)))
            .collect::<Vec<_>>();
        let found = noise_rad(&time, &theta, 0.0125).map(|sigma| sigma.expect("noise"));
        assert!(found.iter().all(|sigma| (sigma / 3e-5 - 1.0).abs() < 0.06), "{found:?}");
    }

    #[test]
    fn analytic_noise_is_told_from_a_fast_motion_and_a_lost_channel_has_none() {
        let wave = |k: usize| 0.05 * (0.05 * k as f64).sin();
        let noise = |k: usize| if k.is_multiple_of(2) { 1e-4 } else { -1e-4 };
        let time = (0..400).map(|k| 0.01 * f64::from(k)).collect::<Vec<_>>();
        let theta = (0..400).map(|k| [wave(k), wave(k) + noise(k)]).collect::<Vec<_>>();
        let [smooth, noisy] = noise_rad(&time, &theta, 0.025).map(|sigma| sigma.expect("differences"));
        // A fourth difference of alternating ± a is 16 a: 16e-4 / (0.6745 √70) = 2.84e-4; that of the wave is 0.05⁵.
        assert!(smooth < 1e-7 && (noisy / 2.835e-4 - 1.0).abs() < 0.01, "{smooth} {noisy}");
        let lost = theta.iter().map(|theta| [theta[1], f64::NAN]).collect::<Vec<_>>();
        assert!(matches!(noise_rad(&time, &lost, 0.025), [Some(_), None]));
    }

    #[test]
    fn analytic_most_samples_tell_whether_a_test_is_evenly_sampled() {
        let even = (0..400).map(|k| 0.01 * f64::from(k)).collect::<Vec<_>>();
        let rounded = (0..400).map(|k| (1e3 * f64::from(k) / 256.0).round() / 1e3).collect::<Vec<_>>();
        let gaps = (0..400).map(|k| 0.01 * f64::from(k) + 0.5 * f64::from(k / 60)).collect::<Vec<_>>();
        assert!([even, rounded, gaps].iter().all(|time_s| !is_uneven(time_s, 0.025)));
        let uneven = (0..400).map(|k| 0.01 * f64::from(k) + 0.004 * f64::from(k % 3)).collect::<Vec<_>>();
        assert!(is_uneven(&uneven, 0.025));
    }

    #[test]
    fn analytic_scatter_does_not_see_a_cubic_however_it_is_sampled() {
        let time_s = (0..200).map(|k| 0.01 * f64::from(k) + 0.004 * f64::from(k * k % 3)).collect::<Vec<_>>();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let noise = Normal::new(0.0, 1e-4).expect("a positive standard deviation");
        let cubic = |t: &f64| 0.3 * t - 0.5 * t * t + 0.2 * t * t * t;
        let values = time_s.iter().map(|t| cubic(t) + noise.sample(&mut random)).collect::<Vec<_>>();
        // The median of 200 differences that overlap scatters by some tenth.
        let found = scatter(&time_s, &values, 0.03).expect("noise");
        assert!((found / 1e-4 - 1.0).abs() < 0.3, "{found}");
    }

    const NOISE_RAD: f64 = 1e-4;

    /// Two seconds of rest, then four of rocking, with noise and these offsets.
    fn measured(offset_rad: Pair) -> Vec<Pair> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let noise = Normal::new(0.0, NOISE_RAD).expect("a positive standard deviation");
        let rocking = |k: usize| if k < 400 { 0.0 } else { 0.02 * ((k - 400) as f64 / 60.0).sin() };
        (0..1200).map(|k| offset_rad.map(|offset| rocking(k) + offset + noise.sample(&mut random))).collect()
    }

    #[test]
    fn analytic_offset_is_the_mean_at_rest() {
        let found = rest_offset_rad(&measured([0.0, -3e-4]), [NOISE_RAD; 2]);
        // 400 samples: the mean is known to a twentieth of the noise; four of those.
        assert_eq!(found[0], 0.0);
        assert!((found[1] + 3e-4).abs() < 4.0 * NOISE_RAD / 20.0, "{found:?}");
    }

    #[test]
    fn analytic_test_that_begins_in_motion_has_none() {
        let moving = measured([1e-3, 1e-3]).split_off(420);
        assert_eq!(rest_offset_rad(&moving, [NOISE_RAD; 2]), [0.0; 2]);
    }
}

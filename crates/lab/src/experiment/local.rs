//! A channel about a time, however it was sampled: a cubic in least squares, and how well it knows value and slope.
//!
//! Evenly sampled tests have a road of their own ([`super::pattern`]), with as many samples to either side. Here it is
//! those within a time, of which there may be more on one side. What that costs stands in the covariance.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::measured::Measured;
use super::noise::{is_uneven, noise_rad, scatter};
use mrbd_kernel::model::Pair;
use mrbd_statistics::median;

/// Time to either side over which a channel is a cubic, s: a swing lasts some tenths.
pub const HALF_S: f64 = 0.06;
/// Samples to either side at most.
const MOST: usize = 6;
/// The same where samples are sparse, s. What a cubic does not follow there, its residuals tell.
const FARTHEST_S: f64 = 0.1;
/// Fewest samples: three more than a cubic takes.
pub const LEAST: usize = 7;
/// Free numbers of a cubic.
const CUBIC: usize = 4;

/// A channel about a time.
#[derive(Debug, Clone, PartialEq)]
pub struct About {
    /// Value and slope a second.
    pub state: Pair,
    /// Standard deviations of both, over that of the noise of a sample.
    pub sd: Pair,
    /// Sum of the squared residuals.
    pub residual: f64,
    /// Samples.
    pub count: usize,
}

/// The samples about the k-th that no gap parts from it: within [`HALF_S`], or farther where these are too few.
pub fn around(time_s: &[f64], k: usize, gap_s: f64) -> Range<usize> {
    let near = within(time_s, k, gap_s, HALF_S);
    if near.len() >= LEAST { near } else { within(time_s, k, gap_s, FARTHEST_S) }
}

fn within(time_s: &[f64], k: usize, gap_s: f64, half_s: f64) -> Range<usize> {
    let joins = |a: usize, b: usize| time_s[b] - time_s[a] <= gap_s;
    let (mut from, mut to) = (k, k + 1);
    while from > k.saturating_sub(MOST) && joins(from - 1, from) && time_s[k] - time_s[from - 1] <= half_s {
        from -= 1;
    }
    while to < time_s.len().min(k + MOST + 1) && joins(to - 1, to) && time_s[to] - time_s[k] <= half_s {
        to += 1;
    }
    from..to
}

/// The cubic through samples about a time, in least squares; `None` of too few, or of samples at too few times.
pub fn about(time_s: &[f64], values: &[f64], middle_s: f64) -> Option<About> {
    let kept = (0..values.len()).filter(|&k| values[k].is_finite()).collect::<Vec<_>>();
    if kept.len() < LEAST {
        return None;
    }
    let x = |k: usize| (time_s[k] - middle_s) / HALF_S;
    let rows = DMatrix::from_fn(kept.len(), CUBIC, |i, power| x(kept[i]).powi(power as i32));
    let read = DVector::from_iterator(kept.len(), kept.iter().map(|&k| values[k]));
    let covariance = (rows.transpose() * &rows).try_inverse()?;
    let fitted = &covariance * rows.transpose() * &read;
    Some(About {
        state: [fitted[0], fitted[1] / HALF_S],
        sd: [covariance[(0, 0)].sqrt(), covariance[(1, 1)].sqrt() / HALF_S],
        residual: (&rows * &fitted - read).norm_squared(),
        count: kept.len(),
    })
}

/// Standard deviation of the noise of a channel, in its unit: what is left about local cubics, and at least the scatter from
/// sample to sample. `None` where neither can be told.
///
/// Errors that go together over more than a tenth of a second, as of digitised curves, are in neither: they are to be
/// stated, see `noise_m`.
pub fn local_scatter(time_s: &[f64], theta_rad: &[Pair], channel: usize, gap_s: f64) -> Option<f64> {
    let values = theta_rad.iter().map(|theta| theta[channel]).collect::<Vec<_>>();
    let of = |k: usize| {
        let near = around(time_s, k, gap_s);
        let fit = about(&time_s[near.clone()], &values[near], time_s[k])?;
        Some(fit.residual / (fit.count - CUBIC) as f64)
    };
    let left = (0..values.len()).filter_map(of).collect::<Vec<_>>();
    let near = scatter(time_s, &values, gap_s);
    let wide = median(&left).map(f64::sqrt).filter(|sd| *sd > 0.0);
    [near, wide].into_iter().flatten().reduce(f64::max)
}

/// Standard deviation of the noise of each channel, rad: as stated, or read from samples as they are spaced.
pub fn channel_noise_rad(measured: &Measured, time_s: &[f64], theta_rad: &[Pair]) -> [Option<f64>; 2] {
    let read = match is_uneven(time_s, measured.gap_s) {
        true => [0, 1].map(|i| local_scatter(time_s, theta_rad, i, measured.gap_s)),
        false => noise_rad(time_s, theta_rad, measured.gap_s),
    };
    [0, 1].map(|i| measured.stated_noise_rad[i].or(read[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    /// Times with steps of 4 to 16 ms.
    fn uneven(count: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut time_s = 0.0;
        let step = |_| {
            time_s += random.random_range(0.004..0.016);
            time_s
        };
        (0..count).map(step).collect()
    }

    #[test]
    fn analytic_a_cubic_is_given_back_from_uneven_and_one_sided_samples() {
        let time_s = uneven(40);
        let cubic = |t: f64| 0.3 - 0.2 * t + 0.5 * t * t + 4.0 * t * t * t;
        let values = time_s.iter().map(|t| cubic(*t)).collect::<Vec<_>>();
        for k in [0, 5, 20, 39] {
            let near = around(&time_s, k, 0.02);
            let found = about(&time_s[near.clone()], &values[near], time_s[k]).expect("samples");
            let slope = -0.2 + time_s[k] + 12.0 * time_s[k] * time_s[k];
            // Roundings, of which one-sided samples make some thousands.
            assert!((found.state[0] - values[k]).abs() < 1e-11, "{k}: {found:?}");
            assert!((found.state[1] - slope).abs() < 1e-9, "{k}: {found:?}");
        }
    }

    #[test]
    fn analytic_standard_deviations_are_those_of_the_noise() {
        let time_s = uneven(30);
        let near = around(&time_s, 12, 0.02);
        let time_s = &time_s[near.clone()];
        let middle_s = time_s[12 - near.start];
        let normal = Normal::new(0.0, 1.0).expect("a deviation");
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let (mut squares, mut told, draws) = ([0.0; 2], [0.0; 2], 4000);
        for _ in 0..draws {
            let values = time_s.iter().map(|_| normal.sample(&mut random)).collect::<Vec<_>>();
            let found = about(time_s, &values, middle_s).expect("samples");
            told = found.sd;
            (0..2).for_each(|i| squares[i] += found.state[i].powi(2) / f64::from(draws));
        }
        // The variance of 4000 draws scatters by √(2/4000), 2 %; four of those.
        assert!((0..2).all(|i| (squares[i] / told[i].powi(2) - 1.0).abs() < 0.09), "{squares:?} {told:?}");
    }

    #[test]
    fn analytic_noise_of_uneven_samples_is_found_on_a_swing() {
        let time_s = uneven(3000);
        let normal = Normal::new(0.0, 3e-4).expect("a deviation");
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let swing = |t: &f64| [0.05 * (6.0 * t).sin() + normal.sample(&mut random), f64::NAN];
        let theta = time_s.iter().map(swing).collect::<Vec<_>>();
        let found = local_scatter(&time_s, &theta, 0, 0.025).expect("noise");
        // Of the two estimates the larger is taken; each scatters by some hundredths.
        assert!((found / 3e-4 - 1.0).abs() < 0.1, "{found}");
        assert_eq!(local_scatter(&time_s, &theta, 1, 0.025), None);
    }

    #[test]
    fn analytic_no_samples_are_taken_from_beyond_a_gap() {
        let time_s =
            (0..20).map(|k| 0.01 * f64::from(k) + if k < 10 { 0.0 } else { 0.03 }).collect::<Vec<_>>();
        assert_eq!(around(&time_s, 8, 0.025), 2..10);
        assert_eq!(around(&time_s, 11, 0.025), 10..18);
        // Sparse samples are taken from farther away.
        let sparse = (0..20).map(|k| 0.03 * f64::from(k)).collect::<Vec<_>>();
        assert_eq!(around(&sparse, 10, 0.06), 7..14);
    }
}

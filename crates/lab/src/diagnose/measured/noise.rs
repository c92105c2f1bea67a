//! How noisy a channel is, from the channel alone.

use mrbd_kernel::model::Pair;

/// Fourth differences of white noise are √70 times as large as the noise.
const FOURTH_DIFFERENCE: f64 = 8.366_600_265_340_756;
/// The median magnitude of a normal variable over its standard deviation.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

/// Standard deviation of the white noise of each channel, rad; none if a channel has no samples or no noise.
///
/// From the median of the fourth differences: motion is smooth from sample to sample but for the impacts, which a
/// median does not see.
pub fn noise_rad(time_s: &[f64], theta_rad: &[Pair], gap_s: f64) -> Option<Pair> {
    let of = |channel: usize| {
        let joined = |k: usize| time_s[k + 4] - time_s[k] <= 4.0 * gap_s;
        let at = |k: usize| theta_rad[k][channel];
        let mut differences = (0..theta_rad.len().saturating_sub(4))
            .filter(|&k| joined(k))
            .map(|k| (at(k) - 4.0 * at(k + 1) + 6.0 * at(k + 2) - 4.0 * at(k + 3) + at(k + 4)).abs())
            .filter(|d| d.is_finite())
            .collect::<Vec<_>>();
        differences.sort_by(f64::total_cmp);
        let median = *differences.get(differences.len() / 2)?;
        (median > 0.0).then_some(median / (MEDIAN_OF_NORMAL * FOURTH_DIFFERENCE))
    };
    Some([of(0)?, of(1)?])
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    use super::*;

    #[test]
    fn white_noise_on_a_swing_is_found_within_its_own_scatter() {
        // The median of n differences scatters by about 1.2/√n with overlap: 2 % of 5000 is over three times that.
        let normal = Normal::new(0.0, 3e-5).unwrap();
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let time = (0..5000).map(|k| 0.005 * f64::from(k)).collect::<Vec<_>>();
        let theta = time
            .iter()
            .map(|t| [0.01 * (6.0 * t).sin(), 0.02 * (5.0 * t).cos()])
            .map(|theta| theta.map(|x| x + normal.sample(&mut random)))
            .collect::<Vec<_>>();
        let found = noise_rad(&time, &theta, 0.0125).unwrap();
        assert!(found.iter().all(|sigma| (sigma / 3e-5 - 1.0).abs() < 0.06), "{found:?}");
    }
}

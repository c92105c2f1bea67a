//! Offsets at rest: what a channel reads while the wall stands, before the shaking moves it.

use mrbd_kernel::model::Pair;

/// Samples looked at together.
const BLOCK: usize = 40;
/// Fewest blocks of standing still.
const LEAST_BLOCKS: usize = 2;
/// A block whose scatter is this many times the noise, or whose two halves differ by as many standard deviations, moves.
const SCATTER: f64 = 1.4;
const DRIFT: f64 = 5.0;
/// Standard deviations of the mean that are an offset: below, it is taken for zero.
const CLEAR: f64 = 6.0;

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
        if mean.abs() > CLEAR * noise_rad[i] / n.sqrt() { mean } else { 0.0 }
    })
}

fn is_still(block: &[Pair], noise_rad: Pair) -> bool {
    let (first, second) = block.split_at(BLOCK / 2);
    (0..2).all(|i| {
        let about = mean(block, i);
        let variance = block.iter().map(|theta| (theta[i] - about).powi(2)).sum::<f64>() / BLOCK as f64;
        let drift = (mean(first, i) - mean(second, i)).abs();
        // A missing sample is no sign of rest: comparisons with NaN fail.
        variance.sqrt() < SCATTER * noise_rad[i] && drift < DRIFT * noise_rad[i] * (4.0 / BLOCK as f64).sqrt()
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

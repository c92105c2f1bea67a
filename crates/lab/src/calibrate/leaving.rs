//! Where a run leaves the measurement.

use crate::experiment::misfit::{Sample, Target};
use crate::experiment::segments::noise_rad;

/// Samples looked at together: of their 60 sizes, the mean of normal noise is known to a tenth.
const TOGETHER: usize = 30;
/// Errors smaller than this share of the mean rotation are taken for noise: without any, a run would be held to have left
/// at once.
const LEAST_NOISE: f64 = 0.005;

/// How many samples a run with these errors follows the measurement: up to where they are so many times what the noise
/// alone would make.
pub(super) fn followed(target: &Target, residuals: &[f64], times_noise: f64) -> usize {
    let expected = noise_sizes(target);
    let sizes = residuals.chunks_exact(2).map(|pair| pair[0].abs() + pair[1].abs()).collect::<Vec<_>>();
    let together = TOGETHER.min(sizes.len()).max(1);
    let sum = |part: &[f64]| part.iter().sum::<f64>();
    let mut parts = sizes.windows(together).zip(expected.windows(together));
    let left = parts.position(|(sizes, noise)| sum(sizes) > times_noise * sum(noise));
    left.map_or(sizes.len(), |first| first + together)
}

/// The size of both errors of each sample, as they weigh in Eq. 8, that noise makes on the average: E|noise| = √(2/π) σ.
fn noise_sizes(target: &Target) -> Vec<f64> {
    let (noise, weights, counted_s) = (noise_rad(target.samples()), target.weights(), target.counted_s());
    let size = [0, 1].map(|i| {
        // The weight is 1 / ∫|θ|: a share of the mean rotation weighs the same in every test.
        let least = if counted_s[i] > 0.0 { LEAST_NOISE / counted_s[i] } else { 0.0 };
        (std::f64::consts::FRAC_2_PI.sqrt() * noise[i] * weights[i]).max(least)
    });
    let of_sample = |s: &Sample| s.weight_s[0] * size[0] + s.weight_s[1] * size[1];
    target.samples().iter().map(of_sample).collect()
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::calibrate::Draws;
    use crate::experiment::Measured;
    use mrbd_files::load_wall;

    #[test]
    fn analytic_a_run_leaves_where_its_errors_are_larger_than_the_noise() {
        let normal =
            |k: usize, i: u32| -> f64 { StandardNormal.sample(&mut Draws::new(1, "").of(0, k as u32, i)) };
        let noise = |k: usize| [1e-3 * normal(k, 0), 2e-3 * normal(k, 1)];
        let theta = |i: usize| (0..=400).map(|k| 0.1 * (0.05 * k as f64).sin() + noise(k)[i]).collect();
        let measured = Measured {
            time_s: (0..=400).map(|k| 0.005 * f64::from(k)).collect(),
            theta_rad: [Some(theta(0)), Some(theta(1))],
            gap_s: 0.01,
            collapse_s: None,
        };
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../inputs/walls/table_wall.toml");
        let wall = load_wall(path.as_ref()).expect("the table wall");
        let target = Target::new(&measured, &[], &wall).expect("samples that count");
        let error = |k: usize, i: usize| {
            let times = if k < 200 { 1.0 } else { 3.0 };
            times * target.weights()[i] * target.samples()[k].weight_s[i] * noise(k)[i]
        };
        let errors = (0..=400).flat_map(|k| [error(k, 0), error(k, 1)]).collect::<Vec<_>>();
        // The mean over thirty samples reaches twice the noise when half of them are beyond.
        assert!((205..230).contains(&followed(&target, &errors, 2.0)), "{}", followed(&target, &errors, 2.0));
        // Never five times, and never twice by the noise alone.
        assert_eq!(followed(&target, &errors, 5.0), 401);
        let noise_alone = [&errors[..400], &[0.0; 402]].concat();
        assert_eq!(followed(&target, &noise_alone, 2.0), 401);
    }
}

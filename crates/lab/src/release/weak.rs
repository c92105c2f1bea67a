//! The motion under test functions, from unevenly sampled rotations.
//!
//! The weights c_j of the second derivative of the parabola through some samples, in least squares, have
//! Σ c_j θ(t_j) = ∫ φ θ'' dt for any motion, with φ(t) = Σ c_j max(t_j - t, 0), since they take nothing of a line. φ is
//! straight between samples and its integral is 1. So nothing is differentiated, and samples may lie as they like.
//! What else stands in the equation is integrated with φ along cubics through four samples each.

use nalgebra::{DMatrix, DVector};

/// Half the length of a test function, s: a swing lasts some tenths.
pub const HALF_S: f64 = 0.06;
/// Fewest samples under a test function: two more than a parabola has numbers.
const LEAST_SAMPLES: usize = 5;
/// Samples farther apart than this share of the half length leave too much to the cubics.
const WIDEST_SHARE: f64 = 0.75;

/// Places and weights of Gauss's rule of three points on 0 to 1: exact for φ times a polynomial of fourth order.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// The motion at an instant under a test function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    /// φ times the length of time it stands for; over a test function they sum to 1.
    pub weight: f64,
    /// θ_1, rad.
    pub theta: f64,
    /// θ_1', rad/s.
    pub omega: f64,
}

/// One test function over a motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Support {
    /// Its middle, s.
    pub time_s: f64,
    /// ∫ φ θ_1'' dt, rad/s².
    pub acceleration: f64,
    pub nodes: Vec<Node>,
}

/// A test function about every sample that has enough others near.
pub(super) fn supports(samples: &[(f64, f64)]) -> Vec<Support> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Vec::new() };
    let inside = |middle_s: f64| middle_s - HALF_S >= first.0 && middle_s + HALF_S <= last.0;
    let middles = samples.iter().map(|sample| sample.0).filter(|middle_s| inside(*middle_s));
    middles.filter_map(|middle_s| support(samples, middle_s)).collect()
}

fn support(samples: &[(f64, f64)], middle_s: f64) -> Option<Support> {
    let from = samples.partition_point(|s| s.0 < middle_s - HALF_S);
    let to = samples.partition_point(|s| s.0 <= middle_s + HALF_S);
    let under = &samples[from..to];
    let dense = under.windows(2).all(|pair| pair[1].0 - pair[0].0 <= WIDEST_SHARE * HALF_S);
    if under.len() < LEAST_SAMPLES || !dense {
        return None;
    }
    let weights = curvature_weights(under, middle_s)?;
    let acceleration = under.iter().zip(weights.iter()).map(|(s, c)| c * s.1).sum();
    let phi = |t: f64| under.iter().zip(weights.iter()).map(|(s, c)| c * (s.0 - t).max(0.0)).sum::<f64>();
    let between = |k: usize| {
        let (start, length) = (samples[k].0, samples[k + 1].0 - samples[k].0);
        let four = k.saturating_sub(1).min(samples.len() - 4);
        GAUSS.map(|(place, share)| {
            let t = start + place * length;
            let [theta, omega] = through_four(&samples[four..four + 4], t);
            Node { weight: share * length * phi(t), theta, omega }
        })
    };
    Some(Support { time_s: middle_s, acceleration, nodes: (from..to - 1).flat_map(between).collect() })
}

/// Weights of the second derivative of the parabola through samples, in least squares.
fn curvature_weights(samples: &[(f64, f64)], middle_s: f64) -> Option<DVector<f64>> {
    let power = |k: usize, p: usize| ((samples[k].0 - middle_s) / HALF_S).powi(p as i32);
    let rows = DMatrix::from_fn(samples.len(), 3, power);
    let normal = (rows.transpose() * &rows).cholesky()?;
    let second = normal.solve(&DVector::from_vec(vec![0.0, 0.0, 1.0]));
    Some(rows * second * (2.0 / (HALF_S * HALF_S)))
}

/// Value and slope at a time of the cubic through four samples, by Newton's divided differences.
fn through_four(samples: &[(f64, f64)], t: f64) -> [f64; 2] {
    let mut differences = samples.iter().map(|s| s.1).collect::<Vec<_>>();
    for order in 1..samples.len() {
        for k in (order..samples.len()).rev() {
            let span = samples[k].0 - samples[k - order].0;
            differences[k] = (differences[k] - differences[k - 1]) / span;
        }
    }
    let ends = differences.iter().zip(samples).rev();
    ends.fold([0.0, 0.0], |[value, slope], (difference, sample)| {
        [difference + (t - sample.0) * value, value + (t - sample.0) * slope]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uneven times of a motion.
    fn samples(motion: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let time = |k: usize| 0.015 * k as f64 + 0.004 * (1.7 * k as f64).sin();
        (0..60).map(|k| (time(k), motion(time(k)))).collect()
    }

    #[test]
    fn analytic_test_functions_sum_to_one_and_know_a_parabola() {
        let all = supports(&samples(|t| 0.3 - t + 2.0 * t * t));
        assert!(all.len() > 40);
        for Support { time_s, acceleration, nodes } in &all {
            let sum = |of: &dyn Fn(&Node) -> f64| nodes.iter().map(|n| n.weight * of(n)).sum::<f64>();
            // Roundings of weights of up to 1e4 per s², over samples of order one.
            assert!((acceleration - 4.0).abs() < 1e-9 && (sum(&|_| 1.0) - 1.0).abs() < 1e-10);
            // The middle of φ lies within a sample of that of its reach.
            assert!((sum(&|n| (n.omega + 1.0) / 4.0) - time_s).abs() < 0.019);
        }
    }

    #[test]
    fn analytic_the_weak_form_of_an_oscillator_holds() {
        // θ'' + ω² θ = 0: cubics through samples 15 ms apart miss θ by (ω h)⁴/24·9/16, a share of 1e-5 at ω = 9 per s.
        let all = supports(&samples(|t| 0.05 * (9.0 * t).cos()));
        for support in &all {
            let force = support.nodes.iter().map(|n| n.weight * 81.0 * n.theta).sum::<f64>();
            assert!((support.acceleration + force).abs() < 2e-5 * 81.0 * 0.05, "{}", support.time_s);
        }
    }

    #[test]
    fn analytic_where_samples_are_sparse_nothing_is_told() {
        let mut sparse = samples(|t| t * t);
        let whole = supports(&sparse).len();
        sparse.drain(20..24);
        assert!(supports(&sparse).len() < whole - 4);
        assert!(supports(&sparse[..4]).is_empty());
    }
}

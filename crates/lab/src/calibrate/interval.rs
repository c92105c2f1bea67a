//! How far a number that was fitted to tests may be off.
//!
//! The curvature of likelihood tells what noise leaves open, and how far single tests pull a number tells the same without asking how
//! large the noise is: the larger counts. Two more things do not show in them. A number that few windows tell has no others against
//! which one could be seen to err. And a model of contact is one of several, which differ by more than the finest noise.

use mrbd_statistics::normal::NINETY_FIVE_PERCENT;
use mrbd_statistics::student;
use nalgebra::DMatrix;

use crate::diagnose::certainty::Spread;

/// Relative standard deviation of a number by another formulation of contact than this model's.
///
/// Chosen: between this library and stiff corners C_6 differs by 1e-4 to 4e-4, C_3 and k_d by 5e-4, where windows tell them
/// to 1e-4.
const FORMULATION_SD: f64 = 3e-4;

/// Variance of number i: by curvature or by tests, and by formulation.
pub(super) fn variance(spread: &Spread, i: usize, value: f64) -> f64 {
    spread.covariance[(i, i)].max(spread.scatter[(i, i)]) + (FORMULATION_SD * value).powi(2)
}

/// Half width of the 95 % interval of number i: what the tests leave open, and what another formulation would move it by.
///
/// The curvature rests on the noise, which is known. How far tests pull is known from as many windows as tell the number: Student's t.
/// On a hundred twins whose errors are known the curvature alone is what those of this formulation scatter by (1.0 of it), and a
/// third of what those of another do; both added, by Student's t, held 99 % of the truths.
pub(super) fn half_width(spread: &Spread, i: usize, value: f64) -> f64 {
    let by_noise = NINETY_FIVE_PERCENT * spread.covariance[(i, i)].sqrt();
    let by_tests = student::ninety_five_percent(spread.told_by[i]) * spread.scatter[(i, i)].sqrt();
    // Without tests that pull, and windows that tell, the latter is no number and the former stands.
    by_noise.max(by_tests).hypot(NINETY_FIVE_PERCENT * FORMULATION_SD * value)
}

/// Correlations of numbers; `None` where one leaves no trace.
pub(super) fn correlation(covariance: &DMatrix<f64>) -> Vec<Vec<Option<f64>>> {
    let of = |i: usize, j: usize| {
        let size = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        Some(covariance[(i, j)] / size).filter(|_| size.is_finite() && size > 0.0)
    };
    (0..covariance.nrows()).map(|i| (0..covariance.nrows()).map(|j| of(i, j)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_an_interval_is_as_wide_as_noise_or_tests_say_and_never_narrower_than_formulations_differ() {
        let one = |covariance: f64, scatter: f64, told_by: f64| Spread {
            covariance: DMatrix::from_element(1, 1, covariance),
            scatter: DMatrix::from_element(1, 1, scatter),
            told_by: vec![told_by],
        };
        let half = |covariance, scatter, told_by| half_width(&one(covariance, scatter, told_by), 0, 0.8);
        // t of two degrees is 4.3027; beside 0.01 of it stands the formulation, 1.96 · 3e-4 · 0.8 = 4.7e-4.
        assert!((half(1e-6, 1e-4, 2.0) - 0.043_027).abs() < 1e-5);
        assert!((half(1e-4, 1e-6, 2.0) - 0.019_605).abs() < 1e-5);
        assert_eq!(half(f64::INFINITY, 0.0, 0.0), f64::INFINITY);
        assert_eq!(half(0.0, 0.0, 50.0), NINETY_FIVE_PERCENT * FORMULATION_SD * 0.8);
        let by_tests = variance(&one(1e-6, 1e-4, 2.0), 0, 0.0);
        assert_eq!([by_tests, variance(&one(1e-4, 1e-6, 2.0), 0, 0.0)], [1e-4; 2]);
    }
}

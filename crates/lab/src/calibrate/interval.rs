//! How far a number that was fitted to tests may be off.
//!
//! The curvature of likelihood and the pulls of single tests tell what noise leaves open. Two more things do not show in them. A
//! number that few windows tell has no others against which one could be seen to err. And a model of contact is one of
//! several, which differ by more than the finest noise.

use mrbd_statistics::normal::NINETY_FIVE_PERCENT;
use mrbd_statistics::student;
use nalgebra::DMatrix;

use super::likelihood::Over;
use crate::diagnose::certainty::Spread;

/// Relative standard deviation of a number by another formulation of contact than this model's.
///
/// Chosen: between this library and stiff corners C_6 differs by 1e-4 to 4e-4, C_3 and k_d by 5e-4, where windows tell them
/// to 1e-4.
const FORMULATION_SD: f64 = 3e-4;

/// Variance of number i: by curvature, by tests, and by formulation.
pub(super) fn variance(spread: &Spread, i: usize, value: f64) -> f64 {
    left_open(spread, i) + (FORMULATION_SD * value).powi(2)
}

/// What the tests leave open of number i, squared.
fn left_open(spread: &Spread, i: usize) -> f64 {
    spread.covariance[(i, i)] + spread.scatter[(i, i)]
}

/// Half width of the 95 % interval of number i: what the tests leave open, and what another formulation would move it by.
///
/// A window may err by more than its noise, and how far is known from as many windows as tell the number: Student's t. A whole
/// test that is followed from rest has been through tens of impacts, each of them met.
pub(super) fn half_width(over: Over, spread: &Spread, i: usize, value: f64) -> f64 {
    let reach = match over {
        Over::Windows => student::ninety_five_percent(spread.told_by[i]),
        Over::WholeTests => NINETY_FIVE_PERCENT,
    };
    (reach * left_open(spread, i).sqrt()).hypot(NINETY_FIVE_PERCENT * FORMULATION_SD * value)
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
    fn analytic_an_interval_is_the_wider_the_fewer_windows_tell_a_number_and_never_narrower_than_formulations_differ()
     {
        let one = |variance: f64, told_by: f64| Spread {
            covariance: DMatrix::from_element(1, 1, variance),
            scatter: DMatrix::zeros(1, 1),
            told_by: vec![told_by],
        };
        let half = |over, variance, told_by| half_width(over, &one(variance, told_by), 0, 0.8);
        // t of two degrees is 4.3027; beside 0.01 of it stands the formulation, 1.96 · 3e-4 · 0.8 = 4.7e-4.
        assert!((half(Over::Windows, 1e-4, 2.0) - 0.043_027).abs() < 1e-5);
        assert!((half(Over::WholeTests, 1e-4, 2.0) - 0.019_605).abs() < 1e-5);
        assert_eq!(half(Over::Windows, f64::INFINITY, 0.0), f64::INFINITY);
        let least = NINETY_FIVE_PERCENT * FORMULATION_SD * 0.8;
        assert_eq!([Over::Windows, Over::WholeTests].map(|over| half(over, 0.0, 50.0)), [least; 2]);
    }
}

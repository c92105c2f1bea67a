//! Linear least squares without priors: the step that a motion's start takes, in a calibration and in a diagnosis.

use nalgebra::{DMatrix, DVector};

/// The x of least |J x + r|² for a Jacobian J and residuals r: -R⁻¹ Qᵀ r with J = Q R.
///
/// J has as many rows as columns, or more. `None` where a column says nothing beside the others. The normal equations
/// would square the condition of J.
pub(crate) fn newton_step(jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> Option<DVector<f64>> {
    let qr = jacobian.clone().qr();
    let step = qr.r().solve_upper_triangular(&-(qr.q().transpose() * residuals));
    step.filter(|step| step.iter().all(|x| x.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_line_through_points_is_found_and_a_column_of_zeros_refused() {
        let jacobian = DMatrix::from_fn(20, 2, |k, v| if v == 0 { 1.0 } else { k as f64 });
        // Errors of ± 1 about a line, as many above as below in each half, leave it where it is.
        let about = |k: usize| [1.0, -1.0, -1.0, 1.0][k % 4];
        let residuals = DVector::from_fn(20, |k, _| 2.0 - 0.5 * k as f64 + about(k));
        let found = newton_step(&jacobian, &residuals).expect("two independent columns");
        // Roundings of twenty sums of numbers below ten.
        assert!((found[0] + 2.0).abs() < 1e-12 && (found[1] - 0.5).abs() < 1e-12, "{found}");
        assert!(newton_step(&DMatrix::zeros(20, 1), &residuals).is_none());
    }
}

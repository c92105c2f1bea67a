//! Linear least squares without priors: the step that a motion's start takes, in a calibration and in a diagnosis.

use nalgebra::{DMatrix, DVector};

/// A step of Gauss and Newton.
#[derive(Debug, Clone)]
pub(crate) struct NewtonStep {
    /// The x of least |J x + r|².
    pub x: DVector<f64>,
    /// What |J x + r|² is less than |r|²: the gain in the sum of squares where J does not change.
    pub promise: f64,
}

impl NewtonStep {
    /// What a share of the step promises.
    pub fn promise_of(&self, share: f64) -> f64 {
        self.promise * share * (2.0 - share)
    }
}

/// The step for a Jacobian J and residuals r: x = -R⁻¹ Qᵀ r with J = Q R, which promises |Qᵀ r|².
///
/// J has as many rows as columns, or more. `None` where a column says nothing beside the others. The normal equations
/// would square the condition of J.
pub(crate) fn step_of(jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> Option<NewtonStep> {
    let qr = jacobian.clone().qr();
    let mut turned = residuals.clone();
    qr.q_tr_mul(&mut turned);
    let along = turned.rows(0, jacobian.ncols());
    let promise = along.norm_squared();
    let x = qr.r().solve_upper_triangular(&-along)?;
    x.iter().all(|x| x.is_finite()).then_some(NewtonStep { x, promise })
}

/// The x of [`step_of`].
pub(crate) fn newton_step(jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> Option<DVector<f64>> {
    step_of(jacobian, residuals).map(|step| step.x)
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

        let step = step_of(&jacobian, &residuals).expect("two independent columns");
        for share in [1.0, 0.4] {
            let gain = residuals.norm_squared() - (&jacobian * &step.x * share + &residuals).norm_squared();
            assert!((step.promise_of(share) - gain).abs() < 1e-12 * gain);
        }
    }
}

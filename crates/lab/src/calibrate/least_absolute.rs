//! The step to the least sum of sizes of errors that are linear in the values: one iteration of Gauss-Newton under Eq. 8.
//!
//! Iteratively reweighted least squares (P. W. Holland, R. E. Welsch (1977), "Robust regression using iteratively
//! reweighted least-squares", Communications in Statistics A6), repeated until the weights are those of the errors
//! that the step leaves. Repeating costs no simulation. By it the step follows all windows but those that went
//! another way. With the weights of the errors before the step it is a compromise between them.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::objective::LnPrior;
use mrbd_statistics::median;

/// Reweightings of a step.
const REWEIGHTINGS: usize = 10;
/// The corner of the sizes falls no lower than this share of the errors before the step. So one can divide by errors
/// that vanish.
const LEAST_CORNER: f64 = 1e-6;
/// Errors beyond so many are thinned out: neighbouring samples tell the same.
const MOST_ERRORS: usize = 20_000;

/// Errors as if they were linear in the values; the cost is the sum of their sizes times the prior's factor.
pub(super) struct Linear {
    /// Slopes of the errors that some value moves, row by row.
    slopes: Vec<f64>,
    residuals: Vec<f64>,
    /// Sum of the sizes of those that no value moves.
    unmoved: f64,
    prior: LnPrior,
}

impl Linear {
    /// Errors and their slopes, one row an error, over shares of the bounds.
    pub fn new(slopes: &DMatrix<f64>, residuals: &[f64], prior: LnPrior) -> Self {
        let moves = |k: &usize| slopes.row(*k).iter().any(|s| *s != 0.0);
        let (moved, unmoved): (Vec<usize>, Vec<usize>) = (0..residuals.len()).partition(moves);
        // Errors of θ_1 and θ_2 stand by turns: every odd-numbered one has both.
        let every = (moved.len() / MOST_ERRORS) | 1;
        let kept = moved.into_iter().step_by(every).collect::<Vec<_>>();
        let row = |&k: &usize| slopes.row(k).iter().copied().collect::<Vec<_>>();
        Self {
            slopes: kept.iter().flat_map(row).collect(),
            residuals: kept.iter().map(|&k| residuals[k]).collect(),
            unmoved: unmoved.iter().map(|&k| residuals[k].abs()).sum::<f64>() / every as f64,
            prior,
        }
    }

    /// The steps under these dampings (D. W. Marquardt (1963), "An algorithm for least-squares estimation of nonlinear
    /// parameters", SIAM Journal 11), as shares of each variable's own curvature.
    pub fn steps(&self, dampings: &[f64]) -> Vec<DVector<f64>> {
        let typical = median_size(&self.residuals);
        let own = self.normal(&self.residuals, typical).0.diagonal();
        // A variable that moves nothing stays where it is under any damping above zero.
        let own =
            own.map(|curvature| if curvature > 0.0 { curvature } else { own.max().max(f64::MIN_POSITIVE) });
        let step = |damping: &f64| self.step(*damping * &own, LEAST_CORNER * typical);
        dampings.par_iter().map(step).collect::<Vec<_>>().into_iter().flatten().collect()
    }

    fn step(&self, damping: DVector<f64>, least_corner: f64) -> Option<DVector<f64>> {
        let n = self.prior.slope.len();
        let damping = DMatrix::from_diagonal(&damping);
        let mut left = self.residuals.clone();
        let mut step = DVector::zeros(n);
        for _ in 0..REWEIGHTINGS {
            let corner = median_size(&left).max(least_corner);
            let (curvature, slope) = self.normal(&left, corner);
            step = (curvature + &damping).cholesky()?.solve(&-slope);
            let rows = self.slopes.chunks_exact(n).zip(&self.residuals);
            let moved = |row: &[f64]| row.iter().zip(step.iter()).map(|(s, p)| s * p).sum::<f64>();
            left = rows.map(|(row, r)| r + moved(row)).collect();
        }
        Some(step)
    }

    /// Square root of the covariance of a normal cloud, in shares of the bounds, about the least by this linear
    /// model. A vector of it costs this share more on the average of every direction. `widest` is its size where the
    /// errors say nothing.
    pub fn cloud(&self, share: f64, widest: f64) -> Option<DMatrix<f64>> {
        let n = self.prior.slope.len();
        let (curvature, _) = self.normal(&self.residuals, median_size(&self.residuals));
        let cost = self.unmoved + self.residuals.iter().map(|r| r.abs()).sum::<f64>();
        // ½ pᵀ H p = share × cost.
        let precision = curvature / (2.0 * share * cost).max(f64::MIN_POSITIVE);
        let precision = precision + DMatrix::from_diagonal_element(n, n, widest.powi(-2));
        // H = L Lᵀ: L⁻ᵀ z has the covariance H⁻¹.
        precision.cholesky()?.l().transpose().try_inverse()
    }

    /// Curvature and slope of the cost at no step. An error weighs by the size it is left with; below the corner of a
    /// size, as a square.
    fn normal(&self, left: &[f64], corner: f64) -> (DMatrix<f64>, DVector<f64>) {
        let n = self.prior.slope.len();
        let cost = self.unmoved + left.iter().map(|r| r.abs()).sum::<f64>();
        let mut curvature = DMatrix::from_diagonal(&(cost * &self.prior.curvature));
        let mut slope = cost * &self.prior.slope;
        for ((row, residual), left) in self.slopes.chunks_exact(n).zip(&self.residuals).zip(left) {
            let weight = 1.0 / left.abs().max(corner);
            for i in 0..n {
                let weighted = weight * row[i];
                slope[i] += weighted * residual;
                (0..=i).for_each(|j| curvature[(i, j)] += weighted * row[j]);
            }
        }
        curvature.fill_upper_triangle_with_lower_triangle();
        (curvature, slope)
    }
}

/// Median of the sizes, above zero.
pub(super) fn median_size(residuals: &[f64]) -> f64 {
    let sizes = residuals.iter().map(|r| r.abs()).collect::<Vec<_>>();
    median(&sizes).unwrap_or(0.0).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_step_follows_most_errors_and_leaves_the_others_alone() {
        // Errors x + y t of a line through zero, but for a tenth of them, which lie far off on one side.
        let t = |k: usize| k as f64 / 100.0;
        let slopes = DMatrix::from_fn(100, 2, |k, v| if v == 0 { 1.0 } else { t(k) });
        let residuals = (0..100).map(|k| 0.3 - 0.4 * t(k) + if k % 10 == 0 { 5.0 } else { 0.0 });
        let linear = Linear::new(&slopes, &residuals.collect::<Vec<_>>(), LnPrior::flat(2));
        let step = &linear.steps(&[1e-12])[0];
        // Least squares would be half an error away; what is left is the corner's, a millionth of the median error, and
        // how far ten reweightings go.
        assert!((step[0] + 0.3).abs() < 1e-3 && (step[1] - 0.4).abs() < 1e-3, "{step}");
    }

    #[test]
    fn analytic_a_prior_draws_the_step_to_the_least_of_the_product() {
        // Errors k - x, k = -50 to 50, and ln f = 0.02 (x - 10) + 0.01 (x - 10)²/2 about x = 10.
        let residuals = (-50..=50).map(|k| f64::from(k) - 10.0).collect::<Vec<_>>();
        let slopes = DMatrix::from_element(101, 1, -1.0);
        let one = |x| DVector::from_element(1, x);
        let prior = LnPrior { slope: one(0.02), curvature: one(0.01), scatter: one(0.0) };
        let step = Linear::new(&slopes, &residuals, prior).steps(&[1e-12])[0][0];
        let cost = |p: f64| {
            let sizes = residuals.iter().map(|r| (r - p).abs()).sum::<f64>();
            sizes * (0.02 * p + 0.005 * p * p).exp()
        };
        let least = (-4000..0).map(|k| f64::from(k) / 100.0).min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
        // The step minimises the sum with a quadratic about the corner and not the sizes themselves: within one spacing of
        // the errors.
        assert!((step - least.expect("not empty")).abs() < 1.0, "{step} {least:?}");
    }
}

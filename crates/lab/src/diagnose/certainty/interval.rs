//! How well the numbers of an answer are known.

use nalgebra::{DMatrix, DVector};

use crate::diagnose::fit::{Loss, WindowSlopes};
use crate::diagnose::trials::{Data, Tried};

/// Half width of a 90 % interval of a normal variable, in standard deviations.
const NINETY_PERCENT: f64 = 1.644_853_626_951_472_2;

/// 90 % intervals of the values of a fitted hypothesis; all that a number may be where the tests do not tell.
///
/// From the curvature of the loss at the fit, and from how far the tests pull it apart (an infinitesimal jackknife over
/// tests): the first does not know that the windows of a test err together.
pub fn intervals(data: &Data, tried: &Tried) -> Vec<[f64; 2]> {
    let variance = variances(data, tried);
    let interval = |(i, value): (usize, &f64)| {
        let half = NINETY_PERCENT * variance.as_ref().map_or(f64::INFINITY, |v| v[i].sqrt());
        let unknown = &tried.hypothesis.unknowns[i];
        [(value - half).max(unknown.lower), (value + half).min(unknown.upper)]
    };
    tried.fit.values.iter().enumerate().map(interval).collect()
}

/// `None` where the curvature cannot be told; infinite where a number leaves no trace.
fn variances(data: &Data, tried: &Tried) -> Option<Vec<f64>> {
    let count = tried.fit.values.len();
    if count == 0 {
        return Some(Vec::new());
    }
    let (slopes, _) = data.fit.slopes(&tried.hypothesis, &tried.fit, None)?;
    let mut curvature = DMatrix::zeros(count, count);
    let mut pulls: Vec<(usize, DVector<f64>)> = Vec::new();
    for ((window, state), WindowSlopes { residual, by_values, .. }) in
        data.fit.windows.iter().zip(&tried.fit.windows).zip(&slopes)
    {
        let weight = Loss::Likelihood.weight(state);
        curvature += by_values.transpose() * by_values * weight;
        let pull = by_values.transpose() * residual * weight;
        match pulls.iter_mut().find(|(test, _)| *test == window.test) {
            Some((_, sum)) => *sum += pull,
            None => pulls.push((window.test, pull)),
        }
    }
    tried.hypothesis.add_prior(&tried.fit.values, &mut curvature, &mut DVector::zeros(count));
    let pulls = pulls.into_iter().map(|(_, pull)| pull).collect::<Vec<_>>();
    let covariance = covariance_of(&curvature)?;
    let scatter = scatter(&covariance, &pulls);
    Some((0..count).map(|i| covariance[(i, i)] + scatter[i]).collect())
}

/// The covariance that a curvature means, infinite for numbers without a trace; `None` where two leave the same.
fn covariance_of(curvature: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let traced = (0..curvature.nrows()).filter(|i| curvature[(*i, *i)] > 0.0).collect::<Vec<_>>();
    // Numbers of different units: each by its own trace.
    let size = |k: usize| curvature[(traced[k], traced[k])].sqrt();
    let of = |k: usize, l: usize| curvature[(traced[k], traced[l])] / (size(k) * size(l));
    let inverse = DMatrix::from_fn(traced.len(), traced.len(), of).cholesky()?.inverse();
    let mut covariance = DMatrix::zeros(curvature.nrows(), curvature.nrows());
    covariance.fill_diagonal(f64::INFINITY);
    for k in 0..traced.len() {
        for l in 0..traced.len() {
            covariance[(traced[k], traced[l])] = inverse[(k, l)] / (size(k) * size(l));
        }
    }
    Some(covariance)
}

/// Variances over tests: how far each would move the values by its own pull, beyond the mean of all; none of one test.
fn scatter(covariance: &DMatrix<f64>, pulls: &[DVector<f64>]) -> Vec<f64> {
    let n = pulls.len() as f64;
    if pulls.len() < 2 {
        return vec![0.0; covariance.nrows()];
    }
    let mean = pulls.iter().fold(DVector::zeros(covariance.nrows()), |sum, pull| sum + pull) / n;
    // A number without a trace is not pulled.
    let known = covariance.map(|c| if c.is_finite() { c } else { 0.0 });
    let moves = pulls.iter().map(|pull| &known * (pull - &mean)).collect::<Vec<_>>();
    let variance = |i: usize| n / (n - 1.0) * moves.iter().map(|m| m[i] * m[i]).sum::<f64>();
    (0..covariance.nrows()).map(variance).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_tests_of_a_mean_scatter_as_their_means_do() {
        // The mean of four numbers known to 1, one a test: curvature 4, pulls are the residuals. Leaving one out moves the mean
        // by a third of its residual: (n - 1)/n of the sum of their squares is sum r²/(n (n - 1)).
        let residuals = [0.3, -1.1, 0.5, 0.3];
        let pulls = residuals.map(|r| DVector::from_element(1, r));
        let covariance = covariance_of(&DMatrix::from_element(1, 1, 4.0)).expect("a trace");
        let expected = residuals.iter().map(|r| r * r).sum::<f64>() / 12.0;
        assert!((covariance[(0, 0)] - 0.25).abs() < 1e-15);
        assert!((scatter(&covariance, &pulls)[0] - expected).abs() < 1e-15);
    }

    #[test]
    fn analytic_a_number_without_a_trace_is_not_known_and_two_with_one_trace_are_not_told_apart() {
        let one = covariance_of(&DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0])).expect("a trace");
        assert!((one[(0, 0)] - 0.25).abs() < 1e-15 && one[(1, 1)] == f64::INFINITY);
        assert_eq!(scatter(&one, &[[1.0, 0.0], [-1.0, 0.0]].map(|p| DVector::from_column_slice(&p)))[1], 0.0);
        assert!(covariance_of(&DMatrix::from_element(2, 2, 1.0)).is_none());
    }
}

//! Gauss-Newton over the signed errors: where the misfit is smooth, some dozens of vectors go where a population needs
//! thousands.
//!
//! An iteration takes the errors' slopes by central differences, wide ones at first, which average the roughness that
//! bursts of impacts leave under `whole`. Errors weigh as in Eq. 8, by their size and not its square, through iteratively
//! reweighted least squares (P. W. Holland, R. E. Welsch (1977), "Robust regression using iteratively reweighted
//! least-squares", Communications in Statistics A6). The steps of several dampings (Levenberg and Marquardt) are
//! simulated, and the cheapest vector is the next.

use nalgebra::{DMatrix, DVector};

use super::search::{Bounds, Found, Member};
use super::slopes::{Fit, Fitted, sides, slopes};
use crate::error::Result;

/// Dampings, as shares of the largest curvature.
const DAMPINGS: [f64; 8] = [1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
/// Half-widths of the central differences, as shares of the bounds: at first, and at least, where roundings and the
/// roughness of a burst still do not show.
const DIFFERENCE: [f64; 2] = [0.1, 0.005];
/// The most a half-width shrinks in an iteration.
const SHRINK: f64 = 0.2;
/// An iteration that lowers the cost by less than this share is the last.
const SETTLED: f64 = 0.01;

/// Where the search stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GaussNewton {
    /// The vector.
    pub values: Vec<f64>,
    /// Half-widths of the next differences, as shares of the bounds.
    differences: Vec<f64>,
}

impl GaussNewton {
    /// Begins at a vector.
    pub fn new(values: Vec<f64>) -> Self {
        Self { differences: vec![DIFFERENCE[0]; values.len()], values }
    }

    /// Begins near the vector sought: differences are small from the start.
    pub fn near(values: Vec<f64>) -> Self {
        Self { differences: vec![DIFFERENCE[1]; values.len()], values }
    }

    /// Goes down until the cost has settled, or as long as `budget` vectors allow.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn minimise(&mut self, bounds: &[Bounds], budget: usize, fit: &mut dyn Fit) -> Result<Found> {
        let start = fit.fitted(0, std::slice::from_ref(&self.values))?.pop().flatten();
        let cost = start.as_ref().map_or(f64::INFINITY, |fitted| fitted.cost);
        let mut found = Found::start(vec![Member { values: self.values.clone(), cost }]);
        let vectors_each = 2 * bounds.len() + DAMPINGS.len();
        let mut now = start;
        let mut iteration = 0;
        while let Some(fitted) = now.take().filter(|_| found.evaluations + vectors_each <= budget) {
            let next = self.iterate(1 + 2 * iteration, bounds, &fitted, fit, &mut found)?;
            let settled = next.cost > (1.0 - SETTLED) * fitted.cost;
            // The first iteration's differences may have been too wide to lower anything.
            now = Some(next).filter(|_| !settled || iteration == 0);
            iteration += 1;
        }
        Ok(found)
    }

    /// Moves to the cheapest vector of an iteration, which may be where it stands.
    fn iterate(
        &mut self,
        generation: u32,
        bounds: &[Bounds],
        now: &Fitted,
        fit: &mut dyn Fit,
        found: &mut Found,
    ) -> Result<Fitted> {
        let sides = sides(&self.values, &self.differences, bounds);
        let around = fit.fitted(generation, &sides)?;
        let steps = steps(&slopes(&self.values, &sides, &around, now, bounds), &now.residuals);
        let moved = |step: &DVector<f64>| -> Vec<f64> {
            let all = self.values.iter().zip(bounds).zip(step.iter());
            all.map(|((x, b), step)| b.clamp(x + step * b.width())).collect()
        };
        let candidates = steps.iter().map(moved).collect::<Vec<_>>();
        let tried = fit.fitted(generation + 1, &candidates)?;
        found.evaluations += sides.len() + candidates.len();
        let all = sides.into_iter().zip(around).chain(candidates.into_iter().zip(tried));
        let finished = all.filter_map(|(values, fitted)| fitted.map(|fitted| (values, fitted)));
        let best = finished.reduce(|a, b| if b.1.cost < a.1.cost { b } else { a });
        let next = best.filter(|(_, fitted)| fitted.cost < now.cost);
        let (values, fitted) = next.unwrap_or_else(|| (self.values.clone(), now.clone()));
        self.narrow(&values, bounds);
        self.values.clone_from(&values);
        found.population = vec![Member { values, cost: fitted.cost }];
        found.note();
        Ok(fitted)
    }

    /// The next differences are as wide as the step that was taken.
    fn narrow(&mut self, next: &[f64], bounds: &[Bounds]) {
        for (v, difference) in self.differences.iter_mut().enumerate() {
            let step = (next[v] - self.values[v]).abs() / bounds[v].width();
            *difference = step.max(DIFFERENCE[1]).clamp(SHRINK * *difference, *difference);
        }
    }
}

/// Steps of the dampings, in shares of the bounds.
fn steps(slopes: &DMatrix<f64>, residuals: &[f64]) -> Vec<DVector<f64>> {
    let typical = median_size(residuals);
    // 1 / |r| makes r² weigh like |r|; below the median they weigh as squares, for |r| has a corner at zero.
    let weight = |r: &f64| 1.0 / r.abs().max(typical);
    let weights = DVector::from_iterator(residuals.len(), residuals.iter().map(weight));
    let mut weighted = slopes.clone();
    weighted.column_iter_mut().for_each(|mut column| column.component_mul_assign(&weights));
    let curvature = weighted.transpose() * slopes;
    let slope = weighted.transpose() * DVector::from_column_slice(residuals);
    let largest = curvature.diagonal().max();
    let step = |damping: &f64| {
        let damped = &curvature + DMatrix::from_diagonal_element(slope.len(), slope.len(), damping * largest);
        damped.cholesky().map(|factors| factors.solve(&-&slope))
    };
    DAMPINGS.iter().filter_map(step).collect()
}

/// Median of the sizes, above zero.
pub(super) fn median_size(residuals: &[f64]) -> f64 {
    let mut sizes = residuals.iter().map(|r| r.abs()).collect::<Vec<_>>();
    if sizes.is_empty() {
        return f64::MIN_POSITIVE;
    }
    let middle = sizes.len() / 2;
    sizes.select_nth_unstable_by(middle, f64::total_cmp).1.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors |a - x| of a line through two points: linear in the variables.
    struct Lines;

    impl Fit for Lines {
        fn fitted(&mut self, _: u32, candidates: &[Vec<f64>]) -> Result<Vec<Option<Fitted>>> {
            let fitted = |x: &Vec<f64>| {
                let at = |t: f64| 0.3 + 0.4 * t - (x[0] + x[1] * t);
                let residuals = (0..40).map(|k| at(f64::from(k) / 40.0)).collect::<Vec<_>>();
                let cost = residuals.iter().map(|r| r.abs()).sum();
                Some(Fitted { cost, residuals })
            };
            Ok(candidates.iter().map(fitted).collect())
        }
    }

    #[test]
    fn analytic_linear_errors_vanish_in_a_few_iterations() {
        let bounds = [Bounds { lower: 0.0, upper: 1.0 }; 2];
        let mut search = GaussNewton::new(vec![0.9, 0.1]);
        let found = search.minimise(&bounds, 100, &mut Lines).expect("no simulation");
        // Linear errors take one step; the least damping, 1e-7, leaves some 1e-7 of them.
        assert!(found.best().cost < 1e-4 && found.evaluations <= 61, "{found:?}");
        assert!((search.values[0] - 0.3).abs() < 1e-5 && (search.values[1] - 0.4).abs() < 1e-5);
    }
}

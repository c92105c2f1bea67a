//! Gauss-Newton over the signed errors: where the misfit is smooth, some dozens of vectors go where a population needs
//! thousands.
//!
//! An iteration takes the errors' slopes by central differences. Wide ones at first average the roughness that bursts
//! of impacts leave under `whole`. Errors weigh as in Eq. 8, by their size and not its square ([`Linear`]), and what
//! was known beforehand counts as in the cost. The steps of several dampings (Levenberg and Marquardt) are simulated,
//! and the cheapest vector is the next.

use nalgebra::{DMatrix, DVector};
use rand_distr::{Distribution, StandardNormal};

use super::least_absolute::Linear;
use super::search::{Bounds, Draws, Found, Member};
use super::slopes::{Fit, Fitted, sides, slopes};
use mrbd_files::error::Result;

/// Dampings, as shares of each variable's own curvature.
const DAMPINGS: [f64; 8] = [1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
/// Half-widths of the central differences, as shares of the bounds: at first, and at least. At the least, roundings
/// and the roughness of a burst still do not show.
const DIFFERENCE: [f64; 2] = [0.1, 0.005];
/// The cloud is as wide as this share of the misfit more allows, and at most so wide, as a share of the bounds.
const CLOUD_SHARE: f64 = 0.01;
const CLOUD_WIDEST: f64 = 0.1;
/// The most a half-width shrinks in an iteration.
const SHRINK: f64 = 0.2;
/// An iteration that lowers the cost by less than this share is idle. After it, slopes over wider differences may
/// still see a way, such as out of a corner of the bounds. After two, the search ends.
const SETTLED: f64 = 0.01;
const MOST_IDLE: u32 = 2;
const ANOTHER_DIFFERENCE: f64 = 0.05;
/// A misfit of the roundings of the simulations.
const NOTHING_LEFT: f64 = 1e-9;

/// Where the search stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GaussNewton {
    /// The vector.
    pub values: Vec<f64>,
    /// Half-widths of the next differences, as shares of the bounds.
    differences: Vec<f64>,
    /// The shape of the valley as the last slopes show it: square root of a covariance, in shares of the bounds.
    pub cloud: Option<DMatrix<f64>>,
}

impl GaussNewton {
    /// Begins at a vector.
    pub fn new(values: Vec<f64>) -> Self {
        Self { differences: vec![DIFFERENCE[0]; values.len()], values, cloud: None }
    }

    /// Begins near the vector sought: differences are small from the start.
    pub fn near(values: Vec<f64>) -> Self {
        Self { differences: vec![DIFFERENCE[1]; values.len()], values, cloud: None }
    }

    /// Goes down from here until the cost has settled or `budget` vectors are spent.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn minimise(&mut self, bounds: &[Bounds], budget: usize, fit: &mut dyn Fit) -> Result<Found> {
        let mut now = fit.fitted(0, std::slice::from_ref(&self.values))?.pop().flatten();
        let cost = now.as_ref().map_or(f64::INFINITY, |fitted| fitted.cost);
        let mut found = Found::start(vec![Member { values: self.values.clone(), cost }]);
        let vectors_each = 2 * bounds.len() + DAMPINGS.len();
        let (mut iteration, mut idle) = (0, 0);
        while let Some(fitted) = now.take().filter(|_| found.evaluations + vectors_each <= budget) {
            let next = self.iterate(1 + 2 * iteration, bounds, &fitted, fit, &mut found)?;
            let settled = next.cost > (1.0 - SETTLED) * fitted.cost;
            // The first iteration's differences may have been too wide to lower anything.
            idle = if settled && iteration > 0 { idle + 1 } else { 0 };
            if idle > 0 {
                self.differences.fill(ANOTHER_DIFFERENCE);
            }
            now = Some(next).filter(|next| idle < MOST_IDLE && next.cost > NOTHING_LEFT);
            iteration += 1;
        }
        Ok(found)
    }

    /// A vector of the cloud; `None` before the first slopes.
    pub fn near_by(&self, number: u32, bounds: &[Bounds], draws: &Draws) -> Option<Vec<f64>> {
        let normal = |v: usize| StandardNormal.sample(&mut draws.of(0, number, v as u32));
        let step = self.cloud.as_ref()? * DVector::from_fn(bounds.len(), |v, _| normal(v));
        let all = self.values.iter().zip(bounds).zip(step.iter());
        Some(all.map(|((x, b), step)| b.clamp(x + step * b.width())).collect())
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
        let slopes = slopes(&self.values, &sides, &around, now, bounds);
        let linear = Linear::new(&slopes, &now.residuals, fit.ln_prior(&self.values));
        let steps = linear.steps(&DAMPINGS);
        self.cloud = linear.cloud(CLOUD_SHARE, CLOUD_WIDEST);
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

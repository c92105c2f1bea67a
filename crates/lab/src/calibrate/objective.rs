//! What a search minimises: the mean WME over some tests, times how unlikely the values were beforehand.

use nalgebra::DVector;
use rayon::prelude::*;

use super::archive::{Address, Archive, Origin, Row};
use super::parameters::{Parameter, ParameterSpace};
use super::search::Evaluate;
use super::slopes::{Fit, Fitted};
use crate::experiment::{Simulated, Test};
use mrbd_files::error::Result;
use mrbd_kernel::simulate::Accuracy;

/// The cost of a vector in one test or several, every simulation kept in the archive.
#[derive(Debug)]
pub struct Objective<'a> {
    /// What makes a wall of a vector.
    pub space: &'a ParameterSpace,
    /// All tests of the experiment.
    pub tests: &'a [Test],
    /// Which of them count.
    pub chosen: &'a [usize],
    /// Accuracy of the simulations.
    pub accuracy: Accuracy,
    /// Where simulations are kept.
    pub archive: &'a Archive,
    /// Name of the search.
    pub method: &'a str,
}

impl Evaluate for Objective<'_> {
    fn costs_below(&mut self, generation: u32, candidates: &[Vec<f64>], most: &[f64]) -> Result<Vec<f64>> {
        let jobs = (0..candidates.len()).collect::<Vec<_>>();
        let results = jobs
            .par_iter()
            .map(|&index| self.in_every_test(generation, index, &candidates[index], most[index]))
            .collect::<Vec<_>>();
        let costs = results.iter().map(|(cost, _)| *cost).collect::<Vec<_>>();
        let rows = results.into_iter().flat_map(|(_, rows)| rows).collect::<Vec<_>>();
        let simulations = rows.len();
        self.archive.keep(rows)?;
        let best = costs.iter().copied().fold(f64::INFINITY, f64::min);
        self.archive.show_best(&self.label(), best, simulations);
        Ok(costs)
    }
}

impl Objective<'_> {
    fn label(&self) -> String {
        match self.chosen {
            [test] => format!("{} {}", self.method, self.tests[*test].name),
            _ => self.method.to_owned(),
        }
    }

    /// The cost of a candidate and its simulations: one test after another, until the cost is certain to pass `most`.
    fn in_every_test(
        &self,
        generation: u32,
        index: usize,
        values: &[f64],
        most: f64,
    ) -> (f64, Vec<(Row, Origin)>) {
        let factor = prior_factor(&self.space.parameters, values, self.independent_samples());
        let count = self.chosen.len() as f64;
        let most_wme = most * count / factor;
        let (mut sum, mut rows) = (0.0, Vec::new());
        for &test in self.chosen {
            let (row, origin) = self.simulate(generation, index, test, values, most_wme - sum);
            sum += row.wme.unwrap_or(f64::INFINITY);
            rows.push((row, origin));
            if sum > most_wme || sum.is_infinite() {
                break;
            }
        }
        let cost = if rows.len() < self.chosen.len() { f64::INFINITY } else { sum / count * factor };
        (cost, rows)
    }

    fn simulate(
        &self,
        generation: u32,
        index: usize,
        test: usize,
        values: &[f64],
        most_wme: f64,
    ) -> (Row, Origin) {
        let address = Address { method: self.method.to_owned(), test, generation, index: index as u32 };
        // What was abandoned before is asked for to its end when there is no limit.
        let usable = |row: &Row| row.outcome != "abandoned" || most_wme.is_finite();
        if let Some(row) = self.archive.recall(&address, values).filter(usable) {
            return (row, Origin::Recalled);
        }
        let run = self.space.wall(values).ok();
        let run = run.map(|wall| self.tests[test].simulate_below(&wall, self.accuracy, most_wme));
        (Row::of(address, values, run.as_ref()), Origin::New)
    }
}

impl Fit for Objective<'_> {
    fn fitted(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<Option<Fitted>>> {
        let jobs = candidates.par_iter().enumerate();
        let results = jobs.map(|(index, values)| self.fit_every_test(generation, index, values));
        let mut all = Vec::with_capacity(candidates.len());
        for (fitted, rows) in results.collect::<Vec<_>>() {
            let simulations = rows.len();
            self.archive.keep(rows)?;
            let cost = fitted.as_ref().map_or(f64::INFINITY, |fitted: &Fitted| fitted.cost);
            self.archive.show_best(&self.label(), cost, simulations);
            all.push(fitted);
        }
        Ok(all)
    }

    fn ln_prior(&self, values: &[f64]) -> LnPrior {
        ln_prior(&self.space.parameters, values, self.independent_samples())
    }
}

impl Objective<'_> {
    fn independent_samples(&self) -> f64 {
        self.chosen.iter().map(|&k| self.tests[k].target.independent_samples()).sum()
    }

    /// The errors of a candidate in every test one after another; `None` if a run could not be finished.
    fn fit_every_test(
        &self,
        generation: u32,
        index: usize,
        values: &[f64],
    ) -> (Option<Fitted>, Vec<(Row, Origin)>) {
        let (mut rows, mut residuals, mut sum) = (Vec::new(), Vec::new(), Some(0.0));
        let wall = self.space.wall(values).ok();
        for &test in self.chosen {
            let address = Address { method: self.method.to_owned(), test, generation, index: index as u32 };
            let run = wall.as_ref().map(|wall| self.tests[test].residuals(wall, self.accuracy));
            let (simulated, errors) = run.map_or((None, Vec::new()), |(s, errors)| (Some(s), errors));
            residuals.extend(errors);
            sum = sum.zip(simulated.as_ref().and_then(|s| s.wme)).map(|(sum, wme)| sum + wme);
            let known = self.archive.recall(&address, values).is_some();
            let origin = if known { Origin::Again } else { Origin::New };
            rows.push((Row::of(address, values, simulated.as_ref()), origin));
        }
        let factor = prior_factor(&self.space.parameters, values, self.independent_samples());
        (sum.map(|sum| Fitted { cost: sum / self.chosen.len() as f64 * factor, residuals }), rows)
    }
}

/// Runs a vector through a test; `None` if it makes no possible wall.
pub fn simulate(
    space: &ParameterSpace,
    test: &Test,
    values: &[f64],
    accuracy: Accuracy,
) -> Option<Simulated> {
    space.wall(values).ok().map(|wall| test.simulate(&wall, accuracy))
}

/// exp(½ Σ z² / n), z in standard deviations known beforehand, n independent samples.
///
/// With absolute errors after Laplace, of unknown size, -ln likelihood is n ln WME. Adding ½ Σ z² for the prior and
/// taking the n-th root gives this factor. One when nothing was known.
pub fn prior_factor(parameters: &[Parameter], values: &[f64], independent_samples: f64) -> f64 {
    let z = |(p, x): (&Parameter, &f64)| p.prior_sd.map_or(0.0, |sd| (x - p.nominal) / sd);
    let squares = parameters.iter().zip(values).map(|pair| z(pair).powi(2)).sum::<f64>();
    (0.5 * squares / independent_samples).exp()
}

/// The first two derivatives of ln f over shares of the bounds; f raises a cost for what was known beforehand.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LnPrior {
    pub slope: DVector<f64>,
    /// Of each variable by itself.
    pub curvature: DVector<f64>,
    /// How much the slope would differ had what was known been drawn anew: its standard deviation.
    pub scatter: DVector<f64>,
}

impl LnPrior {
    /// Nothing was known.
    pub fn flat(variables: usize) -> Self {
        let zero = DVector::zeros(variables);
        Self { slope: zero.clone(), curvature: zero.clone(), scatter: zero }
    }
}

/// ln [`prior_factor`] about a vector.
pub(super) fn ln_prior(parameters: &[Parameter], values: &[f64], independent_samples: f64) -> LnPrior {
    // The bounds' width in standard deviations; none where nothing was known.
    let width = |p: &Parameter| p.prior_sd.map_or(0.0, |sd| p.bounds.width() / sd);
    let z = |p: &Parameter, x: f64| p.prior_sd.map_or(0.0, |sd| (x - p.nominal) / sd);
    let of = |f: &dyn Fn(&Parameter, f64) -> f64| {
        let all = parameters.iter().zip(values).map(|(p, x)| f(p, *x) / independent_samples);
        DVector::from_iterator(parameters.len(), all)
    };
    LnPrior {
        slope: of(&|p, x| width(p) * z(p, x)),
        curvature: of(&|p, _| width(p).powi(2)),
        scatter: of(&|p, _| width(p)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::{Bounds, Target};

    #[test]
    fn analytic_the_prior_of_gauss_newton_is_that_of_the_cost() {
        let parameter = |name: &str, nominal: f64, prior_sd: Option<f64>| Parameter {
            name: name.into(),
            target: Target::Key(vec![name.into()]),
            bounds: Bounds { lower: 0.8 * nominal, upper: 1.3 * nominal },
            nominal,
            prior_sd,
        };
        let parameters = [parameter("k", 37e3, Some(1e3)), parameter("m", 180.0, None)];
        let ln = |share: f64| {
            let values = parameters.clone().map(|p| p.bounds.at(share));
            prior_factor(&parameters, &values, 40.0).ln()
        };
        let values = parameters.clone().map(|p| p.bounds.at(0.7));
        let prior = ln_prior(&parameters, &values, 40.0);
        let slope = (ln(0.701) - ln(0.699)) / 0.002;
        let curvature = (ln(0.701) - 2.0 * ln(0.7) + ln(0.699)) / 1e-6;
        // ln f is quadratic: what is left are roundings of numbers near ten over the squared difference.
        assert!((prior.slope.sum() / slope - 1.0).abs() < 1e-9, "{prior:?} {slope}");
        assert!((prior.curvature.sum() / curvature - 1.0).abs() < 1e-6, "{prior:?} {curvature}");
        assert_eq!((prior.slope[1], prior.curvature[1]), (0.0, 0.0));
    }
}

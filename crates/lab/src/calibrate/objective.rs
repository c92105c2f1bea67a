//! What a search minimises: the mean WME over some tests, times how unlikely the values were beforehand.

use rayon::prelude::*;

use super::archive::{Address, Archive, Row};
use super::prior::{LnPrior, ln_prior, prior_factor};
use super::search::Evaluate;
use super::slopes::{Fit, Fitted};
use super::space::ParameterSpace;
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
        let runs = results.into_iter().flat_map(|(_, runs)| runs);
        let (rows, new): (Vec<Row>, Vec<bool>) = runs.unzip();
        let simulations = rows.len();
        self.archive.keep(rows, &new)?;
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
    ) -> (f64, Vec<(Row, bool)>) {
        let factor = prior_factor(&self.space.parameters, values, self.independent_samples());
        let count = self.chosen.len() as f64;
        let most_wme = most * count / factor;
        let (mut sum, mut rows) = (0.0, Vec::new());
        for &test in self.chosen {
            let (row, new) = self.simulate(generation, index, test, values, most_wme - sum);
            sum += row.wme.unwrap_or(f64::INFINITY);
            rows.push((row, new));
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
    ) -> (Row, bool) {
        let address = Address { method: self.method.to_owned(), test, generation, index: index as u32 };
        // What was abandoned before is asked for to its end when there is no limit.
        let usable = |row: &Row| row.outcome != "abandoned" || most_wme.is_finite();
        if let Some(row) = self.archive.recall(&address, values).filter(usable) {
            return (row, false);
        }
        let run = self.space.wall(values).ok();
        let run = run.map(|wall| self.tests[test].simulate_below(&wall, self.accuracy, most_wme));
        (Row::of(address, values, run.as_ref()), true)
    }
}

impl Fit for Objective<'_> {
    fn fitted(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<Option<Fitted>>> {
        let jobs = candidates.par_iter().enumerate();
        let results = jobs.map(|(index, values)| self.fit_every_test(generation, index, values));
        let mut all = Vec::with_capacity(candidates.len());
        for (fitted, rows) in results.collect::<Vec<_>>() {
            let new = rows.iter().map(|row| self.archive.recall(&row.address, &row.values).is_none());
            let new = new.collect::<Vec<_>>();
            let simulations = rows.len();
            self.archive.keep(rows, &new)?;
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

    /// The errors of a candidate in every test one after another; none if a run could not be finished.
    fn fit_every_test(&self, generation: u32, index: usize, values: &[f64]) -> (Option<Fitted>, Vec<Row>) {
        let (mut rows, mut residuals, mut sum) = (Vec::new(), Vec::new(), Some(0.0));
        let wall = self.space.wall(values).ok();
        for &test in self.chosen {
            let address = Address { method: self.method.to_owned(), test, generation, index: index as u32 };
            let run = wall.as_ref().map(|wall| self.tests[test].residuals(wall, self.accuracy));
            let (simulated, errors) = run.map_or((None, Vec::new()), |(s, errors)| (Some(s), errors));
            residuals.extend(errors);
            sum = sum.zip(simulated.as_ref().and_then(|s| s.wme)).map(|(sum, wme)| sum + wme);
            rows.push(Row::of(address, values, simulated.as_ref()));
        }
        let factor = prior_factor(&self.space.parameters, values, self.independent_samples());
        (sum.map(|sum| Fitted { cost: sum / self.chosen.len() as f64 * factor, residuals }), rows)
    }
}

/// Runs a vector through a test; none if it makes no possible wall.
pub fn simulate(
    space: &ParameterSpace,
    test: &Test,
    values: &[f64],
    accuracy: Accuracy,
) -> Option<Simulated> {
    space.wall(values).ok().map(|wall| test.simulate(&wall, accuracy))
}

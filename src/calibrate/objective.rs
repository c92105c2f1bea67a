//! What a search minimises: the mean WME over some tests, times how unlikely the values were beforehand.

use rayon::prelude::*;

use super::archive::{Address, Archive, Row};
use super::parameter::{Parameter, ParameterSpace};
use super::search::Evaluate;
use super::trial::{Simulated, Test};
use crate::error::Result;
use crate::simulate::Accuracy;

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
    fn costs(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<f64>> {
        let jobs = (0..candidates.len() * self.chosen.len()).collect::<Vec<_>>();
        let results = jobs
            .par_iter()
            .map(|job| {
                let (index, test) = (job / self.chosen.len(), self.chosen[job % self.chosen.len()]);
                self.simulate(generation, index, test, &candidates[index])
            })
            .collect::<Vec<_>>();
        let (rows, new): (Vec<Row>, Vec<bool>) = results.into_iter().unzip();
        let costs = rows.chunks(self.chosen.len()).map(|rows| self.cost(rows)).collect::<Vec<_>>();
        let simulations = rows.len() as u64;
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

    fn simulate(&self, generation: u32, index: usize, test: usize, values: &[f64]) -> (Row, bool) {
        let address = Address { method: self.method.to_owned(), test, generation, index: index as u32 };
        if let Some(row) = self.archive.recall(&address, values) {
            return (row, false);
        }
        let simulated = simulate(self.space, &self.tests[test], values, self.accuracy);
        (Row::of(address, values, simulated.as_ref()), true)
    }

    fn cost(&self, rows: &[Row]) -> f64 {
        let wmes = rows.iter().map(|row| row.wme.unwrap_or(f64::INFINITY));
        let mean = wmes.sum::<f64>() / rows.len() as f64;
        let samples = self.chosen.iter().map(|&k| self.tests[k].target.independent_samples()).sum();
        mean * prior_factor(&self.space.parameters, &rows[0].values, samples)
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

/// exp(½ Σ z² / n), z in standard deviations known beforehand, n independent samples.
///
/// With absolute errors after Laplace, of unknown size, -ln likelihood is n ln WME; adding ½ Σ z² for the prior and
/// taking the n-th root gives this factor. One when nothing was known.
pub fn prior_factor(parameters: &[Parameter], values: &[f64], independent_samples: f64) -> f64 {
    let z = |(p, x): (&Parameter, &f64)| p.prior_sd.map_or(0.0, |sd| (x - p.nominal) / sd);
    let squares = parameters.iter().zip(values).map(|pair| z(pair).powi(2)).sum::<f64>();
    (0.5 * squares / independent_samples).exp()
}

//! Intervals and correlations: which vectors would have won had other stretches of the tests been measured.
//!
//! Every test is cut into blocks of equal length. A replicate draws as many blocks again, with replacement, and the
//! vector that fits it best wins; the spread of the winners over many replicates is the interval (B. Efron, R. Tibshirani
//! (1993), "An introduction to the bootstrap", sections 8.6 and 13.3: moving blocks, percentiles).
//! A replicate costs no simulation: all of them judge the same cloud of simulated vectors. The cloud begins with the
//! nearly best vectors of the searches, which lie along the valley of the misfit, and grows in rounds by steps between
//! its members and winners. Two things make intervals too narrow: an error that lasts from one block into the next,
//! common once a simulation has lost the phase of the measurement; and another valley the searches did not find.

use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::archive::{Address, Archive, Row};
use super::draws::Draws;
use super::misfit::{BLOCKS, Errors};
use super::objective::{prior_factor, simulate};
use super::parameter::ParameterSpace;
use super::trial::Test;
use crate::error::Result;
use crate::simulate::Accuracy;

/// Rounds of refinement.
const ROUNDS: u32 = 6;
/// Vectors added to the cloud in a round.
const PER_ROUND: usize = 64;
/// Free part of a step, as a share of the bounds: it keeps steps from being confined to a plane.
const FREE_STEP: f64 = 1e-4;

/// What the bootstrap needs to know.
#[derive(Debug, Clone, Copy)]
pub struct Bootstrap<'a> {
    /// What makes a wall of a vector.
    pub space: &'a ParameterSpace,
    /// All tests.
    pub tests: &'a [Test],
    /// Those that count.
    pub chosen: &'a [usize],
    /// Accuracy of the simulations.
    pub accuracy: Accuracy,
    /// Where simulations are kept.
    pub archive: &'a Archive,
    /// Number of replicates.
    pub replicates: usize,
}

/// A vector of the cloud and its errors in every chosen test.
#[derive(Debug, Clone)]
struct Particle {
    values: Vec<f64>,
    errors: Vec<Errors>,
}

/// How often each block of each chosen test is drawn.
type Multiplicities = Vec<[f64; BLOCKS]>;

impl Bootstrap<'_> {
    /// The winner of every replicate, beginning with the best vector and nearly best ones; only the variables in
    /// `free` move.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a simulation cannot be kept.
    pub fn winners(
        &self,
        best: &[f64],
        nearly: &[Vec<f64>],
        free: &[usize],
        draws: &Draws,
    ) -> Result<Vec<Vec<f64>>> {
        let replicates = (0..self.replicates)
            .map(|b| self.multiplicities(&mut draws.of(0, b as u32, 0)))
            .collect::<Vec<_>>();
        let start = nearly.iter().map(|other| with_free(best, other, free));
        let mut cloud = self.simulated(0, std::iter::once(best.to_vec()).chain(start).collect())?;
        if free.is_empty() || cloud.is_empty() {
            return Ok(vec![best.to_vec(); self.replicates]);
        }
        let judged = |cloud: &[Particle]| -> Vec<Vec<f64>> {
            replicates.par_iter().map(|times| self.winner(cloud, times)).collect()
        };
        for round in 1..=ROUNDS {
            let winners = judged(&cloud);
            let moved = (0..PER_ROUND).map(|k| self.moved(&winners, &cloud, free, round, k, draws)).collect();
            cloud.extend(self.simulated(round, moved)?);
        }
        Ok(judged(&cloud))
    }

    fn multiplicities(&self, rng: &mut impl Rng) -> Multiplicities {
        let of_test = |_: &usize| {
            let mut times = [0.0; BLOCKS];
            (0..BLOCKS).for_each(|_| times[rng.random_range(0..BLOCKS)] += 1.0);
            times
        };
        self.chosen.iter().map(of_test).collect()
    }

    /// A step from a winner along the difference of two members of the cloud.
    fn moved(
        &self,
        winners: &[Vec<f64>],
        cloud: &[Particle],
        free: &[usize],
        round: u32,
        k: usize,
        draws: &Draws,
    ) -> Vec<f64> {
        let mut rng = draws.of(round, k as u32, 1);
        let from = &winners[rng.random_range(0..winners.len())];
        let mut pick = || &cloud[rng.random_range(0..cloud.len())].values;
        let (a, b) = (pick(), pick());
        // The step of ter Braak (2006), which keeps the spread of a cloud of normal shape; shorter from round to round.
        let gamma = 2.38 / (2.0 * free.len() as f64 * f64::from(round)).sqrt();
        let mut values = from.clone();
        for &v in free {
            let bounds = self.space.parameters[v].bounds;
            let normal: f64 = StandardNormal.sample(&mut rng);
            let step = gamma * (a[v] - b[v]) + FREE_STEP * bounds.width() * normal;
            values[v] = bounds.clamp(from[v] + step);
        }
        values
    }

    fn winner(&self, cloud: &[Particle], times: &Multiplicities) -> Vec<f64> {
        let cost = |particle: &Particle| {
            let wme =
                |(k, errors): (usize, &Errors)| self.tests[self.chosen[k]].target.wme_of(errors, &times[k]);
            let mean = particle.errors.iter().enumerate().map(wme).sum::<f64>() / times.len() as f64;
            mean * prior_factor(&self.space.parameters, &particle.values, self.independent_samples())
        };
        let costs = cloud.iter().map(cost);
        let best = costs.enumerate().fold((0, f64::INFINITY), |b, c| if c.1 < b.1 { c } else { b });
        cloud[best.0].values.clone()
    }

    fn independent_samples(&self) -> f64 {
        self.chosen.iter().map(|&k| self.tests[k].target.independent_samples()).sum()
    }

    /// The vectors whose runs could be finished in every test.
    fn simulated(&self, round: u32, vectors: Vec<Vec<f64>>) -> Result<Vec<Particle>> {
        let runs = vectors
            .par_iter()
            .enumerate()
            .map(|(index, values)| self.simulate_all(round, index, values))
            .collect::<Vec<_>>();
        let mut cloud = Vec::with_capacity(vectors.len());
        for (values, (rows, errors)) in vectors.into_iter().zip(runs) {
            let new = vec![true; rows.len()];
            self.archive.progress.inc(rows.len() as u64);
            self.archive.keep(rows, &new)?;
            if let Some(errors) = errors {
                cloud.push(Particle { values, errors });
            }
        }
        Ok(cloud)
    }

    fn simulate_all(&self, round: u32, index: usize, values: &[f64]) -> (Vec<Row>, Option<Vec<Errors>>) {
        let mut rows = Vec::new();
        let mut errors = Some(Vec::new());
        for &test in self.chosen {
            let address =
                Address { method: "bootstrap".into(), test, generation: round, index: index as u32 };
            let run = simulate(self.space, &self.tests[test], values, self.accuracy);
            let finished = run.as_ref().filter(|run| run.wme.is_some()).map(|run| run.errors);
            errors = errors.zip(finished).map(|(mut all, one)| {
                all.push(one);
                all
            });
            rows.push(Row::of(address, values, run.as_ref()));
        }
        (rows, errors)
    }
}

/// A vector with the free variables of another.
fn with_free(best: &[f64], other: &[f64], free: &[usize]) -> Vec<f64> {
    let of = |(v, x): (usize, &f64)| if free.contains(&v) { other[v] } else { *x };
    best.iter().enumerate().map(of).collect()
}

/// Value below which a share of the values lies, linear between order statistics; NaN of no values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    low + (place - place.floor()) * (high - low)
}

/// Correlation of two variables over vectors; none where one does not vary.
pub fn correlation(vectors: &[Vec<f64>], i: usize, j: usize) -> Option<f64> {
    let n = vectors.len() as f64;
    let mean = |v: usize| vectors.iter().map(|x| x[v]).sum::<f64>() / n;
    let (mean_i, mean_j) = (mean(i), mean(j));
    let sum =
        |a: usize, ma: f64, b: usize, mb: f64| vectors.iter().map(|x| (x[a] - ma) * (x[b] - mb)).sum::<f64>();
    let r = sum(i, mean_i, j, mean_j) / (sum(i, mean_i, i, mean_i) * sum(j, mean_j, j, mean_j)).sqrt();
    r.is_finite().then_some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_quantiles_and_correlations_of_small_sets() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(&[0.0, 10.0], 0.25), 2.5);
        let line = [[0.0, 5.0, 1.0], [1.0, 3.0, 1.0], [2.0, 1.0, 1.0]].map(|x| x.to_vec());
        assert_eq!(correlation(&line, 0, 1), Some(-1.0));
        assert_eq!(correlation(&line, 0, 2), None);
    }
}

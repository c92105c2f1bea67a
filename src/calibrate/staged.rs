//! The stronger search: CMA-ES over a horizon that grows.
//!
//! A free-running impact system forgets its coefficients behind chaos: over a long record the WME has many local minima,
//! over the first impacts it has few. So the search begins with the first part of every test's motion, and its cloud,
//! widened, goes on over the next longer part.

use super::archive::Archive;
use super::cma_es::CmaEs;
use super::draws::Draws;
use super::experiment::Experiment;
use super::objective::Objective;
use super::parameter::ParameterSpace;
use super::search::Found;
use super::trial::Test;
use crate::error::Result;

/// Last searches, of which the best counts: under `whole` some one in three ends in a wrong valley.
pub const RESTARTS: usize = 2;

/// Shares of the measured motion, and shares of the budget spent on them.
pub const STAGES: [(f64, f64); 5] = [(0.1, 0.2), (0.25, 0.2), (0.5, 0.2), (0.75, 0.2), (1.0, 0.2)];

/// First size of the cloud, as a share of the bounds: it reaches all of them.
const FIRST_SIGMA: f64 = 0.3;
/// Size the cloud is widened to when the horizon grows: on twin experiments under `whole`, 0.1 led to the right minimum
/// from 6 of 6 seeds tried, 0.02 from 1 of 6.
const NEXT_SIGMA: f64 = 0.1;
/// Vectors of a generation per variable: thrice the least of the tutorial, because the valley is rough.
const VECTORS_PER_VARIABLE: usize = 3;

/// Least vectors of a generation: with few variables a small cloud shrinks before it has gone down a rough valley.
const LEAST_VECTORS: usize = 12;

/// A staged search in some tests of an experiment.
#[derive(Debug, Clone, Copy)]
pub struct Staged<'a> {
    /// The experiment.
    pub experiment: &'a Experiment,
    /// What makes a wall of a vector; the experiment's own, or under another law.
    pub space: &'a ParameterSpace,
    /// Tests that count.
    pub chosen: &'a [usize],
    /// Where simulations are kept.
    pub archive: &'a Archive,
    /// Name of the search.
    pub method: &'a str,
    /// Vectors to evaluate in all.
    pub budget: usize,
}

/// Name under which the simulations of a stage are kept; the last stage, over everything, has the search's own name.
pub fn stage_name(method: &str, share: f64) -> String {
    if share < 1.0 { format!("{method} first {}%", 100.0 * share) } else { method.to_owned() }
}

/// Name under which the simulations of a restart are kept.
pub fn restart_name(method: &str, restart: usize) -> String {
    format!("{method} start {restart}")
}

impl Staged<'_> {
    /// Searches every stage, the first in a cloud about a vector; what is found is that of the last, with all evaluations
    /// counted.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a simulation cannot be kept.
    pub fn minimise(&self, about: &[f64], draws: &Draws) -> Result<Found> {
        let bounds = self.space.bounds();
        let lambda = (VECTORS_PER_VARIABLE * bounds.len()).max(LEAST_VECTORS);
        let mut cloud = CmaEs::new(about, &bounds, FIRST_SIGMA, lambda);
        let mut spent = 0;
        let (last, earlier) = STAGES.split_last().unwrap_or((&(1.0, 1.0), &[]));
        for (share, of_budget) in earlier {
            let budget = (of_budget * self.budget as f64) as usize;
            spent += self.stage(*share, budget, &mut cloud, draws)?.evaluations;
            cloud.widen(NEXT_SIGMA);
        }
        let mut found = self.stage(last.0, self.budget.saturating_sub(spent), &mut cloud, draws)?;
        found.evaluations += spent;
        Ok(found)
    }

    /// Searches `RESTARTS` times with the whole budget each, the first time in a cloud about a vector, then about the
    /// middle of the bounds; the best counts.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a simulation cannot be kept.
    pub fn minimise_again(&self, about: &[f64], draws: &Draws) -> Result<Found> {
        let middle = self.space.bounds().iter().map(|b| b.at(0.5)).collect::<Vec<_>>();
        let start = |restart: usize, about: &[f64]| {
            let method = restart_name(self.method, restart);
            Staged { method: &method, ..*self }.minimise(about, &draws.part(&method))
        };
        let mut best = start(1, about)?;
        for restart in 2..=RESTARTS {
            let mut found = start(restart, &middle)?;
            let evaluations = best.evaluations + found.evaluations;
            if found.best().cost < best.best().cost {
                std::mem::swap(&mut best, &mut found);
            }
            best.evaluations = evaluations;
        }
        Ok(best)
    }

    fn stage(&self, share: f64, budget: usize, cloud: &mut CmaEs, draws: &Draws) -> Result<Found> {
        let shortened = |test: &Test| if share < 1.0 { test.shortened(share) } else { test.clone() };
        let tests = self.experiment.tests.iter().map(shortened).collect::<Vec<_>>();
        let method = stage_name(self.method, share);
        let mut objective = Objective {
            space: self.space,
            tests: &tests,
            chosen: self.chosen,
            accuracy: self.experiment.accuracy(),
            archive: self.archive,
            method: &method,
        };
        cloud.minimise(&self.space.bounds(), budget, &draws.part(&method), &mut objective)
    }
}

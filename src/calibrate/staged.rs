//! The stronger search: Gauss-Newton over horizons that grow, then CMA-ES about what it found.
//!
//! A free-running impact system forgets its coefficients behind chaos: over a long record the WME has many local minima.
//! So the search begins in windows that begin anew from the measured motion before each impact
//! ([`super::Test::in_windows`]): there every coefficient acts in every part of every test, and the misfit is nearly
//! smooth. From there two routes lead to the free-running tests, whose WME is Eq. 8: windows three and nine times as
//! long, the better one where the measurement has little noise, since every window's start is taken from it; and the
//! first tenth, quarter, half and three quarters of each test's motion, which start from rest and are not led astray by
//! noise. CMA-ES goes on about the better end.

use nalgebra::DMatrix;

use super::archive::Archive;
use super::cma_es::CmaEs;
use super::draws::Draws;
use super::experiment::Experiment;
use super::gauss_newton::GaussNewton;
use super::horizons::{BEGINNING, Horizon, MOST_BEGINNINGS, ROUTES, name};
use super::objective::Objective;
use super::search::{Found, Member};
use super::space::ParameterSpace;
use super::trial::Test;
use crate::error::Result;

/// The most of the budget that all beginnings take; CMA-ES has the rest.
const DESCENTS_SHARE: f64 = 0.75;
/// A misfit above that of the noise by less than this share is the noise's.
const NEAR_NOISE: f64 = 1.01;
/// The most of the budget that the windows of one beginning and each route take.
const BEGINNING_SHARE: f64 = 0.25;
const ROUTE_SHARE: f64 = 0.25;
/// Most vectors of a stage: some ten iterations with eight variables.
const STAGE_VECTORS: usize = 250;
/// Vectors tried near where the stage before ended.
const NEAR_VECTORS: usize = 16;

/// Size of the last cloud where no slopes tell its shape, as a share of the bounds.
const SIGMA: f64 = 0.02;
/// Width of the cloud at which it has told what it can, as a share of the bounds: hundred times below the accuracy sought.
const LEAST_WIDTH: f64 = 1e-4;
/// A misfit below which nothing is left to find: rotations agree to a ten-thousandth.
const GOOD_ENOUGH: f64 = 1e-4;
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

/// Where a descent ends.
#[derive(Debug, Clone)]
struct End {
    values: Vec<f64>,
    /// In the free-running tests.
    cost: f64,
    /// The shape of the valley over the last horizon before them, where it is still smooth.
    cloud: Option<DMatrix<f64>>,
}

impl Staged<'_> {
    /// Searches from these vectors on, and then from drawn ones, until one leads to what the noise alone would cost, or
    /// the budget is spent; what is found is the best of the free-running tests, with all evaluations counted.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a simulation cannot be kept.
    pub fn minimise(&self, beginnings: &[Vec<f64>], draws: &Draws) -> Result<Found> {
        let descents = self.share(DESCENTS_SHARE);
        let first = beginnings.first().cloned().unwrap_or_else(|| self.drawn(0, draws));
        let (mut best, mut spent) = self.descent(0, first, descents, draws)?;
        for number in 1..MOST_BEGINNINGS {
            let left = descents.saturating_sub(spent);
            if best.cost <= self.enough() || left < self.least_descent() {
                break;
            }
            let from = beginnings.get(number).cloned().unwrap_or_else(|| self.drawn(number, draws));
            let (end, vectors) = self.descent(number, from, left, draws)?;
            spent += vectors;
            best = if end.cost < best.cost { end } else { best };
        }
        let left = self.budget.saturating_sub(spent);
        let End { values, cost, .. } = &best;
        let alone = || Found::start(vec![Member { values: values.clone(), cost: *cost }]);
        let mut found = self.cloud(&best, left, draws)?.unwrap_or_else(alone);
        found.evaluations += spent;
        found.vectors.iter_mut().for_each(|vectors| *vectors += spent);
        Ok(found)
    }

    fn share(&self, share: f64) -> usize {
        (share * self.budget as f64) as usize
    }

    /// A vector anywhere between the bounds.
    fn drawn(&self, number: usize, draws: &Draws) -> Vec<f64> {
        let draws = draws.part("beginnings");
        let bounds = self.space.bounds();
        bounds.iter().enumerate().map(|(v, b)| b.at(draws.uniform(number as u32, 0, v as u32))).collect()
    }

    /// A cost below which no other beginning can be told from this one.
    fn enough(&self) -> f64 {
        let noise = self.chosen.iter().map(|&k| self.experiment.tests[k].target.noise_wme()).sum::<f64>();
        GOOD_ENOUGH + NEAR_NOISE * noise / self.chosen.len() as f64
    }

    /// One iteration of every stage.
    fn least_descent(&self) -> usize {
        8 * (2 * self.space.parameters.len() + 8)
    }

    /// From a vector by both routes; the better end, and the vectors of all.
    fn descent(&self, number: usize, from: Vec<f64>, budget: usize, draws: &Draws) -> Result<(End, usize)> {
        let mut beginning = GaussNewton::new(from);
        let own = budget.min(self.share(BEGINNING_SHARE));
        let spent =
            self.stage(&name(self.method, number, "", BEGINNING), BEGINNING, &mut beginning, own, draws)?;
        let each = (budget.saturating_sub(spent) / 2).min(self.share(ROUTE_SHARE));
        let [by_windows, from_rest] = ROUTES
            .map(|(route, horizons)| self.route(number, route, horizons, beginning.clone(), each, draws));
        let ((by_windows, by_windows_spent), (from_rest, from_rest_spent)) = (by_windows?, from_rest?);
        let end = if from_rest.cost < by_windows.cost { from_rest } else { by_windows };
        Ok((end, spent + by_windows_spent + from_rest_spent))
    }

    /// From stage to stage, to what the free-running tests give, and the vectors of all.
    fn route(
        &self,
        number: usize,
        route: &str,
        horizons: &[Horizon],
        mut at: GaussNewton,
        budget: usize,
        draws: &Draws,
    ) -> Result<(End, usize)> {
        let mut spent = 0;
        for horizon in horizons {
            let method = name(self.method, number, route, *horizon);
            spent += self.stage(&method, *horizon, &mut at, budget.saturating_sub(spent), draws)?;
        }
        let cloud = at.cloud.clone();
        let method = name(self.method, number, route, Horizon::Whole);
        let left = budget.saturating_sub(spent);
        let found = self.descend(&method, &self.experiment.tests, &mut at, left, draws)?;
        let Member { values, cost } = found.best().clone();
        Ok((End { values, cost, cloud }, spent + found.evaluations))
    }

    /// One stage before the whole; gives the vectors it took, none where windows would reach over the whole of every
    /// test.
    fn stage(
        &self,
        method: &str,
        horizon: Horizon,
        at: &mut GaussNewton,
        budget: usize,
        draws: &Draws,
    ) -> Result<usize> {
        let Some(tests) = self.tests(horizon, &at.values) else { return Ok(0) };
        Ok(self.descend(method, &tests, at, budget, draws)?.evaluations)
    }

    /// Gauss-Newton from where the last stage ended, or from a vector near it that is cheaper in this one: where its
    /// motion bends into another valley, slopes do not lead back.
    fn descend(
        &self,
        method: &str,
        tests: &[Test],
        at: &mut GaussNewton,
        budget: usize,
        draws: &Draws,
    ) -> Result<Found> {
        let mut objective = self.objective(method, tests);
        let bounds = self.space.bounds();
        let others = at.around(NEAR_VECTORS.min(budget / 2), &bounds, &draws.part(method));
        at.minimise(others, &bounds, budget.min(STAGE_VECTORS), &mut objective)
    }

    /// The tests over a horizon; between impacts the wall moves as the vector makes it, the best known.
    fn tests(&self, horizon: Horizon, values: &[f64]) -> Option<Vec<Test>> {
        let accuracy = self.experiment.accuracy();
        let wall = self.space.wall(values).ok()?;
        let mut tests = self.experiment.tests.clone();
        for &k in self.chosen {
            match horizon {
                Horizon::Windows(reach) => tests[k] = tests[k].in_windows(reach, &wall, accuracy),
                Horizon::First(share) => tests[k] = tests[k].shortened(share),
                Horizon::Whole => {}
            }
        }
        let in_one = |k: &usize| tests[*k].window_count() == 1;
        let no_windows = matches!(horizon, Horizon::Windows(_)) && self.chosen.iter().all(in_one);
        (!no_windows).then_some(tests)
    }

    /// CMA-ES about the best end; none where nothing is left to find, or to find it with.
    fn cloud(&self, about: &End, budget: usize, draws: &Draws) -> Result<Option<Found>> {
        let bounds = self.space.bounds();
        let lambda = (VECTORS_PER_VARIABLE * bounds.len()).max(LEAST_VECTORS);
        if about.cost <= GOOD_ENOUGH || budget <= lambda {
            return Ok(None);
        }
        let mut objective = self.objective(self.method, &self.experiment.tests);
        let round = CmaEs::new(&about.values, &bounds, SIGMA, lambda);
        let mut cloud = match &about.cloud {
            Some(root) => round.shaped(root),
            None => round,
        };
        cloud.minimise(&bounds, budget, LEAST_WIDTH, draws, &mut objective).map(Some)
    }

    fn objective<'o>(&'o self, method: &'o str, tests: &'o [Test]) -> Objective<'o> {
        Objective {
            space: self.space,
            tests,
            chosen: self.chosen,
            accuracy: self.experiment.accuracy(),
            archive: self.archive,
            method,
        }
    }
}

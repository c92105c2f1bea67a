//! The stronger search: Gauss-Newton over horizons that grow, then CMA-ES about what it found.
//!
//! A free-running impact system forgets its coefficients behind chaos: over a long record the WME has many local minima.
//! So the search begins in windows that begin anew from the measured motion before each impact
//! ([`super::Test::in_windows`]): there every coefficient acts in every part of every test, and the misfit is nearly
//! smooth. From there two routes lead to the free-running tests, whose WME is Eq. 8: windows three and nine times as
//! long, the better one where the measurement has little noise, since every window's start is taken from it; and the
//! first tenth, quarter, half and three quarters of each test's motion, which start from rest and are not led astray by
//! noise. CMA-ES goes on about the better end.

use super::archive::Archive;
use super::cma_es::CmaEs;
use super::draws::Draws;
use super::experiment::Experiment;
use super::gauss_newton::GaussNewton;
use super::objective::Objective;
use super::search::{Found, Member};
use super::space::ParameterSpace;
use super::trial::Test;
use crate::error::Result;

/// How much of the tests is simulated in one go.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Horizon {
    /// Windows from each so many-th stretch without impacts.
    Windows(usize),
    /// The first share of the motion.
    First(f64),
    /// The free-running test: Eq. 8.
    Whole,
}

/// Where both routes begin.
const BEGINNING: Horizon = Horizon::Windows(1);
/// How each route leads from there to the whole.
const ROUTES: [(&str, &[Horizon]); 2] = [
    ("by windows", &[Horizon::Windows(3), Horizon::Windows(9)]),
    ("from rest", &[Horizon::First(0.1), Horizon::First(0.25), Horizon::First(0.5), Horizon::First(0.75)]),
];

/// The most of the budget that the beginning and each route take; CMA-ES has the rest.
const BEGINNING_SHARE: f64 = 0.25;
const ROUTE_SHARE: f64 = 0.25;
/// Most vectors of a stage: some five iterations with eight variables.
const STAGE_VECTORS: usize = 125;

/// Size of the last cloud, as a share of the bounds: on twins with 1 % noise, what Gauss-Newton leaves.
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

/// Names under which the simulations of a search's stages are kept, in their order; the last, CMA-ES over the
/// free-running tests, has the search's own name.
pub fn stage_names(method: &str) -> Vec<String> {
    let of_route = |(route, horizons): &(&str, &[Horizon])| {
        let stages = horizons.iter().chain([&Horizon::Whole]);
        stages.map(|horizon| name(method, route, *horizon)).collect::<Vec<_>>()
    };
    let beginning = name(method, "", BEGINNING);
    let stages = ROUTES.iter().flat_map(of_route);
    std::iter::once(beginning).chain(stages).chain([method.to_owned()]).collect()
}

fn name(method: &str, route: &str, horizon: Horizon) -> String {
    match horizon {
        Horizon::Windows(reach) => format!("{method} windows {reach}"),
        Horizon::First(share) => format!("{method} first {}%", 100.0 * share),
        Horizon::Whole => format!("{method} {route}"),
    }
}

impl Staged<'_> {
    /// Searches from a vector on; what is found is the best of the free-running tests, with all evaluations counted.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if a simulation cannot be kept.
    pub fn minimise(&self, from: &[f64], draws: &Draws) -> Result<Found> {
        let budget = |share: f64| (share * self.budget as f64) as usize;
        let mut beginning = GaussNewton::new(from.to_vec());
        let mut spent = self.stage("", BEGINNING, &mut beginning, budget(BEGINNING_SHARE))?;
        let [by_windows, from_rest] = ROUTES
            .map(|(route, horizons)| self.route(route, horizons, beginning.clone(), budget(ROUTE_SHARE)));
        let (mut best, other) = (by_windows?, from_rest?);
        spent += best.evaluations + other.evaluations;
        if other.best().cost < best.best().cost {
            best = other;
        }
        let Member { values, cost } = best.best().clone();
        let left = self.budget.saturating_sub(spent);
        let mut found = self
            .cloud(&values, left, cost, draws)?
            .unwrap_or_else(|| Found::start(vec![Member { values, cost }]));
        found.evaluations += spent;
        found.vectors.iter_mut().for_each(|vectors| *vectors += spent);
        Ok(found)
    }

    /// From stage to stage, to what the free-running tests give, all evaluations counted.
    fn route(&self, route: &str, horizons: &[Horizon], mut at: GaussNewton, budget: usize) -> Result<Found> {
        let mut spent = 0;
        for horizon in horizons {
            spent += self.stage(route, *horizon, &mut at, budget.saturating_sub(spent))?;
        }
        let method = name(self.method, route, Horizon::Whole);
        let mut found =
            self.descend(&method, &self.experiment.tests, &mut at, budget.saturating_sub(spent))?;
        found.evaluations += spent;
        Ok(found)
    }

    /// One stage before the whole; gives the vectors it took, none where windows would reach over the whole of every
    /// test.
    fn stage(&self, route: &str, horizon: Horizon, at: &mut GaussNewton, budget: usize) -> Result<usize> {
        let Some(tests) = self.tests(horizon, &at.values) else { return Ok(0) };
        let found = self.descend(&name(self.method, route, horizon), &tests, at, budget)?;
        Ok(found.evaluations)
    }

    fn descend(&self, method: &str, tests: &[Test], at: &mut GaussNewton, budget: usize) -> Result<Found> {
        let mut objective = self.objective(method, tests);
        at.minimise(&self.space.bounds(), budget.min(STAGE_VECTORS), &mut objective)
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

    /// CMA-ES about a vector; none where nothing is left to find, or to find it with.
    fn cloud(&self, about: &[f64], budget: usize, cost: f64, draws: &Draws) -> Result<Option<Found>> {
        let bounds = self.space.bounds();
        let lambda = (VECTORS_PER_VARIABLE * bounds.len()).max(LEAST_VECTORS);
        if cost <= GOOD_ENOUGH || budget <= lambda {
            return Ok(None);
        }
        let mut objective = self.objective(self.method, &self.experiment.tests);
        let mut cloud = CmaEs::new(about, &bounds, SIGMA, lambda);
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

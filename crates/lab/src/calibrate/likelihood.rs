//! Values by likelihood: in windows whose starts are fitted too, then over whole tests.
//!
//! A search over whole runs may end in a wrong valley that is 1e-5 of a coefficient wide, and nothing about it tells. Over
//! half a second there are few. So the numbers are fitted to windows as a diagnosis fits its hypotheses, together with
//! the state at the start of every window. Where that leaves no more than noise, they lie in the right valley of whole runs
//! too, or so near that a fit from there finds it. Which of the two is told, and whether the tests are followed to their
//! noise: only then do intervals mean what they say.

use std::sync::Arc;

use nalgebra::DVector;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::doubt::doubtful;
use super::flow::Experiment;
use super::interval::{correlation, half_width, variance};
use super::search::Draws;
use crate::diagnose::certainty::{Spread, spread};
use crate::diagnose::fit::{Fit, Problem, poor_share};
use crate::diagnose::hypothesis::{Hypothesis, Unknown};
use crate::diagnose::trials::{Data, FittedHypothesis, is_noise, opened_under};
use crate::experiment::{Freedom, TestData, Window, windows};
use crate::limits::{LEAST_MOVING, MOVES};
use mrbd_statistics::normal::NINETY_FIVE_PERCENT;

/// Vectors from which a fit begins, and those that are fitted to the end, of the best at a glance.
const BEGUN: usize = 3;
const FINISHED: usize = 2;
/// Vectors drawn about what was found from which it is fitted again, and their distance in standard deviations.
const DRAWN: u32 = 3;
const DRAWN_SD: f64 = 3.0;
/// Vectors drawn anywhere between the bounds from which a fit in windows begins too: other valleys.
const ANYWHERE: u32 = 2;
/// Fits that cost no more than this above the best are no worse: in squared noise, twice the logarithm of a likelihood ratio
/// of e⁶. An interval holds those of all of them.
const AS_GOOD: f64 = 12.0;
/// Times that windows are looked through for impacts that the noise decides.
const DOUBTS: usize = 3;
/// Values over whole tests must lie within so many standard deviations of those over windows.
const CONSISTENT_SD: f64 = 5.0;
/// Samples in which the wall must stand for a test to be run from rest.
const AT_REST: usize = 20;

/// What of a test is followed at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// Half a second each, from a state that is fitted too.
    Windows,
    /// From rest to the end.
    WholeTests,
}

impl Over {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Over::Windows => "windows",
            Over::WholeTests => "whole tests",
        }
    }
}

/// What a fit by likelihood found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ByLikelihood {
    /// What was followed at a time.
    pub over: Over,
    /// How many of them.
    pub count: usize,
    /// Error over them in standard deviations of the noise; 1 is perfect.
    pub error_in_noise: f64,
    /// Share of them with more error than noise leaves.
    pub missed_share: f64,
    /// Whether what is left is noise. Only then do the intervals mean what they say.
    pub followed: bool,
    /// Values, in the order of `parameters`.
    pub values: Vec<f64>,
    /// 95 % intervals from the curvature, or from how far single tests pull where that says more; all of its bounds for a number without
    /// a trace.
    pub interval_95: Vec<[f64; 2]>,
    /// How many windows tell each number; null where what was known before tells it alone. Of few, one that errs is not
    /// found out: the fewer, the more their pulls count.
    #[serde(default)]
    pub told_by: Vec<Option<f64>>,
    /// Correlations; null where a number leaves no trace.
    pub correlation: Vec<Vec<Option<f64>>>,
}

impl ByLikelihood {
    /// Whether values lie within [`CONSISTENT_SD`] of those that were found.
    pub(super) fn is_near(&self, values: &[f64]) -> bool {
        let reach = CONSISTENT_SD / NINETY_FIVE_PERCENT;
        let near = |((value, found), [low, high]): ((&f64, &f64), &[f64; 2])| {
            (found - reach * (found - low)..=found + reach * (high - found)).contains(value)
        };
        values.iter().zip(&self.values).zip(&self.interval_95).all(near)
    }
}

/// A fit of all tests that windows can be cut from.
struct Likelihood<'a> {
    tests: &'a [TestData],
    hypothesis: Hypothesis,
    draws: Draws,
}

/// Fits the numbers of an experiment from some vectors on; `None` where too little moves, or can be read, for windows.
pub(super) fn by_likelihood(experiment: &Experiment, starts: &[Vec<f64>]) -> Option<ByLikelihood> {
    let tests = experiment.readable.iter().map(|(_, data)| data.clone()).collect::<Vec<_>>();
    // Intervals of some of the tests are none of all.
    if tests.len() < experiment.fit_tests().len() {
        return None;
    }
    let draws = Draws::new(experiment.settings.seed, "likelihood");
    let likelihood = Likelihood { tests: &tests, hypothesis: hypothesis(experiment), draws };
    let cut = windows(&tests);
    if cut.len() < LEAST_MOVING {
        return None;
    }
    let short = likelihood.opened(cut, starts)?;
    if !short.found.followed {
        return Some(short.found);
    }
    let all = [std::slice::from_ref(&short.found.values), starts].concat();
    let whole = whole_tests(&tests).and_then(|whole| likelihood.fitted(whole, &all));
    let whole = whole.filter(|whole| whole.found.followed && whole.is_near(&short));
    Some(match whole {
        Some(whole) => whole.with_intervals_of(short),
        None => short.found,
    })
}

/// The wall with the numbers of an experiment.
fn hypothesis(experiment: &Experiment) -> Hypothesis {
    let parameters = experiment.space.parameters.iter().enumerate();
    let unknown = |(i, p): (usize, &super::Parameter)| {
        Unknown::sought(i, &p.name, p.nominal, [p.bounds.lower, p.bounds.upper], p.prior_sd)
    };
    let unknowns = parameters.map(unknown).collect();
    Hypothesis::of_walls(experiment.space.base(), Arc::new(experiment.space.clone()), unknowns)
}

/// Every test as one window from rest; `None` if one does not begin at rest.
fn whole_tests(tests: &[TestData]) -> Option<Vec<Window>> {
    let whole = |(index, test): (usize, &TestData)| {
        let still = |k: usize| (0..2).all(|i| test.theta_rad[k][i].abs() < MOVES * test.noise_rad[i]);
        let readings = test.theta_rad.iter().flatten().filter(|theta| theta.is_finite()).count();
        (0..AT_REST.min(test.theta_rad.len())).all(still).then(|| Window {
            test: index,
            purpose: test.purpose,
            samples: 0..test.theta_rad.len(),
            readings,
            freedom: Freedom::Rest,
            opened: false,
            measured: Vec::new(),
            spread: Vec::new(),
        })
    };
    tests.iter().enumerate().map(whole).collect()
}

/// A fit, and how far its values may be off.
struct Fitted {
    variances: Vec<f64>,
    found: ByLikelihood,
}

impl Fitted {
    /// Widens intervals and variances to hold those of another fit that is as good.
    fn hold(&mut self, other: &Self) {
        let ends = self.found.interval_95.iter_mut().zip(&other.found.interval_95);
        ends.for_each(|(own, theirs)| *own = [own[0].min(theirs[0]), own[1].max(theirs[1])]);
        let values = self.found.values.iter().zip(&other.found.values);
        let apart = values.map(|(own, theirs)| (own - theirs).powi(2));
        let widest = self.variances.iter_mut().zip(&other.variances).zip(apart);
        widest.for_each(|((own, theirs), apart)| *own = own.max(theirs + apart));
    }

    /// These values with the intervals of another fit, widened to hold them.
    fn with_intervals_of(self, other: Self) -> ByLikelihood {
        let ends = |([low, high], value): ([f64; 2], &f64)| [low.min(*value), high.max(*value)];
        let interval_95 = other.found.interval_95.into_iter().zip(&self.found.values).map(ends).collect();
        let ByLikelihood { told_by, correlation, .. } = other.found;
        ByLikelihood { interval_95, told_by, correlation, ..self.found }
    }

    /// Whether values agree with those of another fit, within what that allows.
    fn is_near(&self, other: &Self) -> bool {
        let pairs = self.found.values.iter().zip(&other.found.values).zip(&other.variances);
        pairs
            .into_iter()
            .all(|((own, theirs), variance)| (own - theirs).abs() <= CONSISTENT_SD * variance.sqrt())
    }
}

impl Likelihood<'_> {
    /// A fit in windows, and again with joints open by less than the noise where that follows windows better.
    fn opened(&self, windows: Vec<Window>, starts: &[Vec<f64>]) -> Option<Fitted> {
        let first = self.tried(self.best_of(&self.problem(&windows), starts)?);
        let none: [Window; 0] = [];
        let data = Data { fit: self.problem(&windows), held_out: self.problem(&none) };
        let (windows, fit) = match opened_under(&data, &first) {
            Some(([opened, _], count)) if count > 0 => {
                let again = self.best_of(&self.problem(&opened), std::slice::from_ref(&first.fit.values))?;
                (opened, again)
            }
            _ => (windows, first.fit),
        };
        let (windows, fit) = self.beyond_doubt(windows, fit);
        self.with_valleys(windows, fit)
    }

    /// The windows whose impacts are beyond doubt, and what a fit of these finds.
    ///
    /// With other numbers other windows may be doubtful, so it is asked again.
    fn beyond_doubt(&self, mut windows: Vec<Window>, mut fit: Fit) -> (Vec<Window>, Fit) {
        for _ in 0..DOUBTS {
            let Some(physics) = self.hypothesis.physics(&fit.values) else { break };
            let doubtful = doubtful(self.tests, &physics, &windows, &fit);
            let clear = (0..windows.len()).filter(|k| !doubtful[*k]).collect::<Vec<_>>();
            if clear.len() == windows.len() || clear.len() < LEAST_MOVING {
                break;
            }
            let kept = clear.iter().map(|k| windows[*k].clone()).collect::<Vec<_>>();
            let states = clear.iter().map(|k| fit.windows[*k].clone()).collect();
            let start = Fit { windows: states, ..fit.clone() };
            let Some(next) = self.problem(&kept).fit_finely(&self.hypothesis, start) else { break };
            (windows, fit) = (kept, next);
        }
        (windows, fit)
    }

    /// The best of a fit and of those from other valleys, with intervals that hold all that are as good.
    ///
    /// Impacts at the crack come in bursts in which C_1 and C_2 act in turn. Exchanged they may leave the same windows within
    /// their noise.
    fn with_valleys(&self, windows: Vec<Window>, fit: Fit) -> Option<Fitted> {
        let others = self.other_valleys(&self.problem(&windows), &fit);
        let mut all = [vec![fit], others].concat();
        all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let limit = all[0].cost + AS_GOOD;
        all.retain(|fit| fit.cost <= limit);
        let mut all = all.into_iter();
        let mut best = self.judged(windows.clone(), all.next()?)?;
        for other in all {
            let other = self.told(&windows, other)?;
            best.hold(&other);
        }
        Some(best)
    }

    /// Fits from the exchanged coefficients of bursts, and from anywhere.
    fn other_valleys(&self, problem: &Problem, fit: &Fit) -> Vec<Fit> {
        let h = &self.hypothesis;
        let place = |key: &str| h.unknowns.iter().position(|unknown| unknown.key == key);
        let exchanged = place("C_1").zip(place("C_2")).map(|(one, two)| {
            let mut values = fit.values.clone();
            values[one] = h.unknowns[one].within(fit.values[two]);
            values[two] = h.unknowns[two].within(fit.values[one]);
            values
        });
        let draws = self.draws.part("anywhere");
        let anywhere = |number: u32| {
            let share = |v: usize| draws.uniform(0, number, v as u32);
            let within = |(v, u): (usize, &Unknown)| u.lower + share(v) * (u.upper - u.lower);
            h.unknowns.iter().enumerate().map(within).collect::<Vec<_>>()
        };
        let starts = exchanged.into_iter().chain((0..ANYWHERE).map(anywhere)).collect::<Vec<_>>();
        let measured = problem.measured_states();
        let from = |values: Vec<f64>| {
            let start = problem.states(h, &values, &measured, 3, false)?;
            problem.fit_finely(h, problem.fit_coarsely(h, start)?)
        };
        starts.into_par_iter().filter_map(from).collect()
    }

    fn tried(&self, fit: Fit) -> FittedHypothesis {
        let held_out = Fit { windows: Vec::new(), covariance: None, ..fit.clone() };
        FittedHypothesis { hypothesis: self.hypothesis.clone(), fit, held_out }
    }

    fn problem<'w>(&'w self, windows: &'w [Window]) -> Problem<'w> {
        Problem { tests: self.tests, windows, budget: None }
    }

    /// The best fit in windows from vectors; `None` if none of them makes a wall.
    fn fitted(&self, windows: Vec<Window>, starts: &[Vec<f64>]) -> Option<Fitted> {
        let best = self.best_of(&self.problem(&windows), starts)?;
        self.judged(windows, best)
    }

    /// The better of a fit and of those from about it, and what it says.
    fn judged(&self, windows: Vec<Window>, fit: Fit) -> Option<Fitted> {
        let again = self.again_about(&self.problem(&windows), &fit);
        let best = again.filter(|again| again.cost < fit.cost).unwrap_or(fit);
        self.told(&windows, best)
    }

    /// What a fit says.
    fn told(&self, windows: &[Window], fit: Fit) -> Option<Fitted> {
        let tried = self.tried(fit);
        let none: [Window; 0] = [];
        let data = Data { fit: self.problem(windows), held_out: self.problem(&none) };
        let spread = spread(&data, &tried)?;
        let whole = windows.iter().all(|window| window.measured.is_empty());
        let over = if whole { Over::WholeTests } else { Over::Windows };
        let found = self.found(over, &tried, &spread);
        let values = tried.fit.values.iter().enumerate();
        Some(Fitted { variances: values.map(|(i, value)| variance(&spread, i, *value)).collect(), found })
    }

    /// The best of fits from vectors: compared at a glance, the best coarsely, the best of those to the end.
    fn best_of(&self, problem: &Problem, starts: &[Vec<f64>]) -> Option<Fit> {
        let h = &self.hypothesis;
        let measured = problem.measured_states();
        let glance = |values: &Vec<f64>| problem.states(h, values, &measured, 3, false);
        let begun = lowest(starts.par_iter().filter_map(glance).collect(), BEGUN);
        let coarse = begun.into_par_iter().filter_map(|start| problem.fit_coarsely(h, start));
        let coarse = lowest(coarse.collect(), FINISHED);
        let fine = coarse.into_par_iter().filter_map(|coarse| problem.fit_finely(h, coarse));
        lowest(fine.collect(), 1).pop()
    }

    /// The best of fits from about another one.
    fn again_about(&self, problem: &Problem, best: &Fit) -> Option<Fit> {
        let h = &self.hypothesis;
        let root = best.covariance.clone()?.cholesky()?.l();
        let states = best.windows.iter().map(|window| window.x.clone()).collect::<Vec<_>>();
        let drawn = |number: u32| {
            let normal = |v: usize| StandardNormal.sample(&mut self.draws.of(0, number, v as u32));
            let step = &root * DVector::<f64>::from_fn(best.values.len(), |v, _| normal(v)) * DRAWN_SD;
            let moved = best.values.iter().zip(step.iter()).zip(&h.unknowns);
            let values =
                moved.map(|((value, step), unknown)| unknown.within(value + step)).collect::<Vec<_>>();
            problem.fit_finely(h, problem.states(h, &values, &states, 2, false)?)
        };
        lowest((0..DRAWN).into_par_iter().filter_map(drawn).collect(), 1).pop()
    }

    fn found(&self, over: Over, tried: &FittedHypothesis, spread: &Spread) -> ByLikelihood {
        let interval = |(i, value): (usize, &f64)| {
            let half = half_width(spread, i, *value);
            let unknown = &self.hypothesis.unknowns[i];
            [(value - half).max(unknown.lower), (value + half).min(unknown.upper)]
        };
        let missed_share = poor_share(&tried.fit.windows);
        // Of a handful of whole tests none may be missed; some windows hold an impact that the noise decides.
        let followed = is_noise(tried) && (over == Over::Windows || missed_share == 0.0);
        ByLikelihood {
            over,
            count: tried.fit.windows.len(),
            error_in_noise: tried.fit_error(),
            missed_share,
            followed,
            values: tried.fit.values.clone(),
            interval_95: tried.fit.values.iter().enumerate().map(interval).collect(),
            told_by: spread.told_by.iter().copied().map(windows_beside_the_prior).collect(),
            correlation: correlation(&spread.covariance),
        }
    }
}

/// A count of windows; `None` of a number that what was known before tells alone, which is no number in JSON.
fn windows_beside_the_prior(told_by: f64) -> Option<f64> {
    Some(told_by).filter(|count| count.is_finite())
}

/// The fits of lowest cost, best first.
fn lowest(mut fits: Vec<Fit>, count: usize) -> Vec<Fit> {
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits.truncate(count);
    fits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_a_number_that_the_prior_alone_tells_has_no_count_of_windows() {
        // JSON has no infinity: a calibration with one could not be read again.
        assert_eq!([2.5, f64::INFINITY].map(windows_beside_the_prior), [Some(2.5), None]);
    }
}

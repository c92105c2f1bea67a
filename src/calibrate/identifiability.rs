//! What the tests can tell about each parameter, and what they cannot.

use super::archive::{Archive, Row};
use super::bootstrap::{Bootstrap, correlation, quantile};
use super::draws::Draws;
use super::experiment::Experiment;
use super::objective::simulate;
use super::parameter::Parameter;
use super::result::{Estimate, Identifiability, ProfilePoint, Vector};
use super::staged::{RESTARTS, restart_name};
use super::trial::Simulated;
use crate::error::Result;
use crate::model::ImpactLaw;

/// An interval over more than this share of the bounds tells nothing.
const TELLS_NOTHING: f64 = 0.9;
/// A value this near a bound, as a share of the width, lies on it.
const ON_BOUND: f64 = 0.01;
/// Vectors up to this many times the lowest misfit are nearly best: on twin experiments with 1 % noise these lie
/// within some tenths of a percent of the true values, the size of the errors.
const NEARLY: f64 = 1.02;
/// Nearly best vectors the bootstrap begins with.
const NEARLY_COUNT: usize = 250;
/// Stretches between the bounds a profile is made of.
const PROFILE_POINTS: usize = 15;
/// C_7 and C_8, whose impacts end in sticking: under `contact` nothing is left to scale.
const STICKING: [usize; 2] = [6, 7];

/// Judges the parameters of an experiment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Judge<'a> {
    pub experiment: &'a Experiment,
    pub archive: &'a Archive,
    pub fit: &'a [usize],
}

/// Correlations, row by row.
type Matrix = Vec<Vec<Option<f64>>>;

impl Judge<'_> {
    /// How often each transition happens in the tests to fit.
    pub fn acting(simulated: &[Option<Simulated>], fit: &[usize]) -> [u64; 8] {
        let mut sum = [0; 8];
        for run in fit.iter().filter_map(|&k| simulated[k].as_ref()) {
            sum.iter_mut().zip(run.transitions).for_each(|(sum, n)| *sum += n);
        }
        sum
    }

    /// Why a coefficient has no effect, if it has none.
    pub fn idle(l: usize, acting: &[u64; 8], law: ImpactLaw) -> Option<Identifiability> {
        if acting[l] == 0 {
            Some(Identifiability::NeverActs)
        } else if law == ImpactLaw::Contact && STICKING.contains(&l) {
            Some(Identifiability::NothingToScale)
        } else {
            None
        }
    }

    /// An estimate of every parameter, and their correlations.
    pub fn estimates(&self, joint: &Vector, per_test: &[(Vec<f64>, f64)]) -> Result<(Vec<Estimate>, Matrix)> {
        let space = &self.experiment.space;
        let acting = Self::acting(&self.simulated(&joint.values), self.fit);
        let idle = |p: &Parameter| {
            p.coefficient().and_then(|l| Self::idle(l, &acting, space.base().restitution.law))
        };
        let free = (0..space.parameters.len()).filter(|&v| idle(&space.parameters[v]).is_none());
        let free = free.collect::<Vec<_>>();
        let bootstrap = Bootstrap {
            space,
            tests: &self.experiment.tests,
            chosen: self.fit,
            accuracy: self.experiment.accuracy(),
            archive: self.archive,
            replicates: self.experiment.settings.replicates,
        };
        let draws = Draws::new(self.experiment.settings.seed, "bootstrap");
        let nearly = nearly_best(self.joint_costs());
        let winners = bootstrap.winners(&joint.values, &nearly, &free, &draws)?;
        let costs = self.joint_costs();
        let by_test = self.by_test(per_test);
        let estimate = |(v, parameter): (usize, &Parameter)| {
            self.estimate(v, parameter, joint, idle(parameter), &winners, &by_test, &costs)
        };
        let estimates = space.parameters.iter().enumerate().map(estimate).collect::<Vec<_>>();
        let both = |i: usize, j: usize| {
            if free.contains(&i) && free.contains(&j) { correlation(&winners, i, j) } else { None }
        };
        let all = 0..space.parameters.len();
        let matrix = all.clone().map(|i| all.clone().map(|j| both(i, j)).collect()).collect();
        Ok((estimates, matrix))
    }

    #[allow(clippy::too_many_arguments, reason = "the parts of one estimate, each used once")]
    fn estimate(
        &self,
        v: usize,
        parameter: &Parameter,
        joint: &Vector,
        idle: Option<Identifiability>,
        winners: &[Vec<f64>],
        by_test: &[Vec<Option<f64>>],
        costs: &[(Vec<f64>, f64)],
    ) -> Estimate {
        let values = winners.iter().map(|w| w[v]).collect::<Vec<_>>();
        let interval = [quantile(&values, 0.025), quantile(&values, 0.975)];
        let bounds = parameter.bounds;
        let wide = interval[1] - interval[0] > TELLS_NOTHING * bounds.width();
        let told = if wide { Identifiability::NotToldByTheTests } else { Identifiability::Identified };
        let value = joint.values[v];
        let near = ON_BOUND * bounds.width();
        let by_test = by_test.iter().map(|values| values[v]).collect::<Vec<_>>();
        Estimate {
            name: parameter.name.clone(),
            lower_bound: bounds.lower,
            upper_bound: bounds.upper,
            value,
            identifiability: idle.unwrap_or(told),
            interval_95: idle.is_none().then_some(interval),
            on_bound: idle.is_none() && (value - bounds.lower < near || bounds.upper - value < near),
            spread_over_tests: spread(&by_test),
            by_test,
            profile: if idle.is_none() { profile(v, parameter, costs) } else { Vec::new() },
        }
    }

    fn simulated(&self, values: &[f64]) -> Vec<Option<Simulated>> {
        let Experiment { space, tests, .. } = self.experiment;
        tests.iter().map(|test| simulate(space, test, values, self.experiment.accuracy())).collect()
    }

    /// Each test's best vector; none for a coefficient that never acts in it.
    fn by_test(&self, per_test: &[(Vec<f64>, f64)]) -> Vec<Vec<Option<f64>>> {
        let Experiment { space, tests, .. } = self.experiment;
        let law = space.base().restitution.law;
        let of_test = |(values, &test): (&(Vec<f64>, f64), &usize)| {
            let run = simulate(space, &tests[test], &values.0, self.experiment.accuracy());
            let counts = run.map_or([0; 8], |run| run.transitions);
            let acts = |p: &Parameter| p.coefficient().is_none_or(|l| Self::idle(l, &counts, law).is_none());
            let kept = values.0.iter().zip(&space.parameters).map(|(x, p)| acts(p).then_some(*x));
            kept.collect::<Vec<_>>()
        };
        per_test.iter().zip(self.fit).map(of_test).collect()
    }

    /// Every vector that was simulated in all tests to fit, and its mean WME.
    fn joint_costs(&self) -> Vec<(Vec<f64>, f64)> {
        let mut searches = ["joint", "bootstrap"].map(str::to_owned).to_vec();
        searches.extend((1..=RESTARTS).map(|k| restart_name("refined", k)));
        let mut of_all = self
            .archive
            .rows(&searches)
            .into_iter()
            .filter(|row| searches.contains(&row.address.method))
            .collect::<Vec<_>>();
        let key = |r: &Row| (r.address.method.clone(), r.address.generation, r.address.index);
        of_all.sort_by_key(key);
        let mean = |rows: &[Row]| {
            let sum = rows.iter().map(|row| row.wme).sum::<Option<f64>>()?;
            (rows.len() == self.fit.len()).then(|| (rows[0].values.clone(), sum / rows.len() as f64))
        };
        of_all.chunk_by(|a, b| key(a) == key(b)).filter_map(mean).collect()
    }
}

/// The vectors whose misfit is nearly the lowest, thinned evenly from the cheapest to the dearest.
fn nearly_best(mut costs: Vec<(Vec<f64>, f64)>) -> Vec<Vec<f64>> {
    costs.sort_by(|a, b| a.1.total_cmp(&b.1));
    let lowest = costs.first().map_or(0.0, |(_, cost)| *cost);
    let near = costs.iter().take_while(|(_, cost)| *cost <= NEARLY * lowest).count();
    let kept = near.max(NEARLY_COUNT).min(costs.len());
    let thinned = (0..NEARLY_COUNT.min(kept)).map(|k| k * kept / NEARLY_COUNT.min(kept));
    thinned.map(|k| costs[k].0.clone()).collect()
}

fn spread(by_test: &[Option<f64>]) -> Option<f64> {
    let values = by_test.iter().flatten().copied().collect::<Vec<_>>();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (values.len() >= 2).then(|| (squares / (n - 1.0)).sqrt())
}

/// Lower envelope of the misfit over a parameter's range, from every vector simulated in all tests.
fn profile(v: usize, parameter: &Parameter, costs: &[(Vec<f64>, f64)]) -> Vec<ProfilePoint> {
    let point = |k: usize| {
        let at = |k: usize| parameter.bounds.at(k as f64 / PROFILE_POINTS as f64);
        let (from, to) = (at(k), at(k + 1));
        let inside = costs.iter().filter(|(values, _)| (from..=to).contains(&values[v]));
        let lowest = inside.map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
        ProfilePoint { from, to, mean_wme: lowest.is_finite().then_some(lowest) }
    };
    (0..PROFILE_POINTS).map(point).collect()
}

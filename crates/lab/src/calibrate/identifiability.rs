//! What the tests can tell about each parameter, and what they cannot.

use super::archive::{Archive, Row};
use super::bootstrap::Bootstrap;
use super::continuation::GOOD_ENOUGH;
use super::flow::Experiment;
use super::likelihood::ByLikelihood;
use super::objective::{Objective, simulate};
use super::parameters::Parameter;
use super::result::{Estimate, Identifiability, ProfilePoint, Vector};
use super::search::Draws;
use super::staged_search::whole_names;
use crate::experiment::Simulated;
use crate::experiment::misfit::BLOCKS;
use mrbd_files::error::Result;
use mrbd_kernel::model::ImpactLaw;
use mrbd_statistics::{correlation, quantile};

/// An interval over more than this share of the bounds tells nothing.
const TELLS_NOTHING: f64 = 0.9;
/// The same of an interval by likelihood. What is called identified is known to three times better than its bounds.
const TELLS_LITTLE: f64 = 1.0 / 3.0;
/// A mean WME by no more than this share above that of the noise alone is the noise's.
const ARRIVED: f64 = 0.1;
/// A value this near a bound, as a share of the width, lies on it.
const ON_BOUND: f64 = 0.01;
/// The most that counts of a misfit's share above the noise: beyond, it is the model's and no search's.
const MOST_ABOVE_NOISE: f64 = 0.1;
/// Half the 95 % quantile of χ² with one degree of freedom.
const HALF_CHI_SQUARED: f64 = 1.92;
/// Stretches between the bounds a profile is made of.
const PROFILE_POINTS: usize = 15;
/// C_7 and C_8, whose impacts end in sticking: under `contact` nothing is left to scale.
const STICKING: [usize; 2] = [6, 7];

/// Name of the bootstrap's simulations.
pub(super) const BOOTSTRAP: &str = "bootstrap";

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
    pub fn estimates(&self, joint: &Vector, per_test: &[Vec<f64>]) -> Result<(Vec<Estimate>, Matrix)> {
        let space = &self.experiment.space;
        let acting = Self::acting(&self.simulated(&joint.values), self.fit);
        let idle = |p: &Parameter| {
            p.coefficient().and_then(|l| Self::idle(l, &acting, space.base().restitution.law))
        };
        let free = (0..space.parameters.len()).filter(|&v| idle(&space.parameters[v]).is_none());
        let free = free.collect::<Vec<_>>();
        let told = Told {
            vectors: self.bootstrapped(&joint.values, &free)?,
            by_test: self.by_test(per_test),
            costs: self.joint_costs(),
            not_excluded: self.above_noise(joint.mean_wme).max(self.by_chance()),
        };
        let parameters = space.parameters.iter().enumerate();
        let estimate = |(v, p): (usize, &Parameter)| told.estimate(v, p, joint.values[v], idle(p));
        let estimates = parameters.map(estimate).collect::<Vec<_>>();
        let both = |i: usize, j: usize| {
            if free.contains(&i) && free.contains(&j) { correlation(&told.vectors, i, j) } else { None }
        };
        let all = 0..space.parameters.len();
        let matrix = all.clone().map(|i| all.clone().map(|j| both(i, j)).collect()).collect();
        Ok((estimates, matrix))
    }

    /// Whether a vector leaves no more of the tests over their whole length than the noise.
    pub fn has_arrived(&self, vector: &Vector) -> bool {
        let noise = self.noise_wme();
        vector.mean_wme.is_some_and(|wme| wme <= GOOD_ENOUGH || wme <= (1.0 + ARRIVED) * noise)
    }

    /// What is told where the tests are followed to their noise: intervals by likelihood.
    pub fn by_likelihood(
        (estimates, _): (Vec<Estimate>, Matrix),
        fit: &ByLikelihood,
    ) -> (Vec<Estimate>, Matrix) {
        let of = |(v, estimate): (usize, Estimate)| estimate.with_interval(fit.interval_95[v], TELLS_LITTLE);
        let estimates = estimates.into_iter().enumerate().map(of).collect::<Vec<_>>();
        let told = |v: usize| estimates[v].interval_95.is_some();
        let both = |i: usize, j: usize| fit.correlation[i][j].filter(|_| told(i) && told(j));
        let all = 0..estimates.len();
        let matrix = all.clone().map(|i| all.clone().map(|j| both(i, j)).collect()).collect();
        (estimates, matrix)
    }

    /// What is told where intervals cannot be believed.
    pub fn not_identified(
        (estimates, matrix): (Vec<Estimate>, Matrix),
        why: Identifiability,
    ) -> (Vec<Estimate>, Matrix) {
        let estimates = estimates.into_iter().map(|estimate| estimate.not_identified(why)).collect();
        match why {
            // Correlations are those of the intervals, which are not given then.
            Identifiability::SearchesDisagree => (estimates, vec![vec![None; matrix.len()]; matrix.len()]),
            _ => (estimates, matrix),
        }
    }

    fn noise_wme(&self) -> f64 {
        let noise = self.fit.iter().map(|&k| self.experiment.tests[k].target.noise_wme()).sum::<f64>();
        noise / self.fit.len() as f64
    }

    /// The share of the misfit above that of the noise alone: by so much a search may have missed the lowest.
    fn above_noise(&self, mean_wme: Option<f64>) -> f64 {
        let noise = self.noise_wme();
        mean_wme.map_or(0.0, |wme| (1.0 - noise / wme).clamp(0.0, MOST_ABOVE_NOISE))
    }

    /// The share above the lowest misfit at which a profile of the likelihood excludes a value: -ln likelihood is n ln WME,
    /// as in [`super::prior_factor`].
    fn by_chance(&self) -> f64 {
        let samples = |&k: &usize| self.experiment.tests[k].target.independent_samples();
        (HALF_CHI_SQUARED / self.fit.iter().map(samples).sum::<f64>()).min(MOST_ABOVE_NOISE)
    }

    /// The vectors of the bootstrap's replicates.
    fn bootstrapped(&self, best: &[f64], free: &[usize]) -> Result<Vec<Vec<f64>>> {
        let Experiment { space, tests, settings, .. } = self.experiment;
        let of_test = |(k, &test): (usize, &usize)| {
            tests[test].target.error_blocks().map(move |block| k * BLOCKS + block).collect::<Vec<_>>()
        };
        let blocks = self.fit.iter().enumerate().flat_map(of_test).collect::<Vec<_>>();
        let bounds = space.bounds();
        let replicates = settings.replicates;
        let bootstrap = Bootstrap { bounds: &bounds, free, blocks: &blocks, replicates };
        let mut objective = Objective {
            space,
            tests,
            chosen: self.fit,
            accuracy: self.experiment.accuracy(),
            archive: self.archive,
            method: BOOTSTRAP,
        };
        bootstrap.vectors(best, &Draws::new(settings.seed, BOOTSTRAP), &mut objective)
    }

    fn simulated(&self, values: &[f64]) -> Vec<Option<Simulated>> {
        let Experiment { space, tests, .. } = self.experiment;
        tests.iter().map(|test| simulate(space, test, values, self.experiment.accuracy())).collect()
    }

    /// Each test's best vector; `None` for a coefficient that never acts in it.
    fn by_test(&self, per_test: &[Vec<f64>]) -> Vec<Vec<Option<f64>>> {
        let Experiment { space, tests, .. } = self.experiment;
        let law = space.base().restitution.law;
        let of_test = |(values, &test): (&Vec<f64>, &usize)| {
            let run = simulate(space, &tests[test], values, self.experiment.accuracy());
            let counts = run.map_or([0; 8], |run| run.transitions);
            let acts = |p: &Parameter| p.coefficient().is_none_or(|l| Self::idle(l, &counts, law).is_none());
            let kept = values.iter().zip(&space.parameters).map(|(x, p)| acts(p).then_some(*x));
            kept.collect::<Vec<_>>()
        };
        per_test.iter().zip(self.fit).map(of_test).collect()
    }

    /// Every vector that was simulated in all tests to fit, and its mean WME.
    fn joint_costs(&self) -> Vec<(Vec<f64>, f64)> {
        let mut searches = ["joint", "refined"].iter().flat_map(|m| whole_names(m)).collect::<Vec<_>>();
        searches.push(BOOTSTRAP.to_owned());
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

/// What is known of the parameters beside the best vector.
struct Told {
    /// The bootstrap's vectors.
    vectors: Vec<Vec<f64>>,
    /// Each test's best vector; `None` for a coefficient that never acts in it.
    by_test: Vec<Vec<Option<f64>>>,
    /// Every vector simulated in all tests, and its mean WME.
    costs: Vec<(Vec<f64>, f64)>,
    /// Vectors that cost by no more than this share above the lowest are not excluded.
    not_excluded: f64,
}

impl Told {
    /// From the lowest to the highest value of the replicates' middle 95 % and of the vectors that are not excluded.
    /// The former know the noise, the latter the other local minima of a rough misfit.
    fn interval(&self, v: usize, value: f64) -> [f64; 2] {
        let values = self.vectors.iter().map(|w| w[v]).collect::<Vec<_>>();
        // No replicates widen nothing.
        let at = |share: f64| quantile(&values, share).unwrap_or(value);
        let bootstrapped = [at(0.025).min(value), at(0.975).max(value)];
        let lowest = self.costs.iter().map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
        let near = self.costs.iter().filter(|(_, cost)| *cost <= (1.0 + self.not_excluded) * lowest);
        near.fold(bootstrapped, |[a, b], (values, _)| [a.min(values[v]), b.max(values[v])])
    }

    fn estimate(
        &self,
        v: usize,
        parameter: &Parameter,
        value: f64,
        idle: Option<Identifiability>,
    ) -> Estimate {
        let interval = self.interval(v, value);
        let bounds = parameter.bounds;
        let wide = interval[1] - interval[0] > TELLS_NOTHING * bounds.width();
        let told = if wide { Identifiability::NotToldByTheTests } else { Identifiability::Identified };
        let near = ON_BOUND * bounds.width();
        let by_test = self.by_test.iter().map(|values| values[v]).collect::<Vec<_>>();
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
            profile: if idle.is_none() { profile(v, parameter, &self.costs) } else { Vec::new() },
        }
    }
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

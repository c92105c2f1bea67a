//! Everything one sample tells: fragility, intervals, fit, shares.

use super::bootstrap::{Bootstrap, left_out};
use super::cloud::residuals;
use super::components::components;
use super::goodness::{Goodness, goodness};
use super::interval::{Interval, Replicates, expanded_level};
use super::method::Unknown;
use super::method::{Fitted, Method};
use super::outcomes::{OutcomeFit, fit_outcomes};
use super::profile::profile_intervals;
use super::sample::Sample;
use super::shares::{Share, outcome_shares};

/// What to ask of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How the fragility is told.
    pub method: Method,
    /// Replicates and seed; 0 replicates for no bootstrap.
    pub bootstrap: Bootstrap,
    /// Confidence level of the intervals, above 0 and below 1.
    pub level: f64,
}

/// Median and β, each as an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Of the median, in the unit of the intensity.
    pub median: Interval,
    /// Of β.
    pub beta: Interval,
}

/// What the bootstrap found.
#[derive(Debug, Clone, PartialEq)]
pub struct BootstrapResult {
    /// Every replicate, none where it told no fragility.
    pub replicates: Vec<Option<Fitted>>,
    /// Level the percentiles are taken at, wider than asked for with few clusters; none with fewer than two.
    pub level: Option<f64>,
    /// Replicates that told none; in an interval they count as below its lower and above its upper bound.
    pub unknown: usize,
    /// Percentile intervals.
    pub percentile: Bounds,
    /// Bias-corrected and accelerated intervals, where they exist.
    pub bias_corrected: Option<Bounds>,
}

/// A fragility and what stands behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// The fragility.
    pub fitted: Fitted,
    /// Standard errors from the information, of outcomes only; they take outcomes as independent.
    pub errors: Option<OutcomeFit>,
    /// Profile-likelihood intervals, of outcomes only; they take outcomes as independent.
    pub profile: Option<Bounds>,
    /// The bootstrap, unless it was not asked for.
    pub bootstrap: Option<BootstrapResult>,
    /// Fit of outcomes; none for incremental analyses, whose rows are not trials at an intensity chosen beforehand.
    pub goodness: Option<Goodness>,
    /// Shares of the variance of ln capacity (outcomes; incremental analyses that all ended in failure) or of ln demand about
    /// its line (cloud) by kind of cluster.
    pub shares: Option<Vec<Share>>,
}

/// What a sample tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Failures.
    pub failures: f64,
    /// Trials.
    pub trials: f64,
    /// Lowest and highest intensity.
    pub range: Option<[f64; 2]>,
    /// The fragility, or why there is none.
    pub result: Result<Known, Unknown>,
}

impl Analysis {
    /// Whether an interval to quote has an end that the data do not set.
    pub fn has_open_ends(&self) -> bool {
        let best = self.result.as_ref().ok().and_then(Known::best);
        best.is_some_and(|(_, Bounds { median, beta, .. })| {
            [median.lower, median.upper, beta.lower, beta.upper].contains(&None)
        })
    }

    /// Whether the median lies outside the intensities that were observed, so that it rests on the log-normal shape.
    pub fn extrapolates(&self) -> bool {
        match (&self.result, self.range) {
            (Ok(known), Some([low, high])) => !(low..=high).contains(&known.fitted.curve.median()),
            _ => false,
        }
    }
}

/// Fits a sample and asks everything that its kind of data can answer.
pub fn analyse(sample: &Sample, settings: &Settings) -> Analysis {
    let (failures, trials) = sample.totals();
    let x = sample.ln_intensity();
    let low = x.iter().copied().reduce(f64::min);
    let high = x.iter().copied().reduce(f64::max);
    let range = low.zip(high).map(|(low, high)| [low.exp(), high.exp()]);
    Analysis { failures, trials, range, result: known(sample, settings) }
}

fn known(sample: &Sample, settings: &Settings) -> Result<Known, Unknown> {
    let fitted = settings.method.fit(sample, &sample.unit_weights())?;
    let errors = match settings.method {
        Method::Outcomes => Some(fit_outcomes(sample)?),
        _ => None,
    };
    let profile = errors.as_ref().map(|fit| {
        let [median, beta] = profile_intervals(sample, fit, settings.level);
        Bounds { median, beta }
    });
    Ok(Known {
        fitted,
        errors,
        profile,
        bootstrap: (settings.bootstrap.replicates > 0).then(|| bootstrap(sample, settings, &fitted)),
        goodness: goodness_of(sample, settings.method, &fitted),
        shares: shares(sample, settings.method, &fitted),
    })
}

/// A cloud's failures are collapses, not exceedances, unless every row that stood is compared with the limit.
fn goodness_of(sample: &Sample, method: Method, fitted: &Fitted) -> Option<Goodness> {
    (method == Method::Outcomes).then(|| goodness(sample, fitted))
}

fn shares(sample: &Sample, method: Method, fitted: &Fitted) -> Option<Vec<Share>> {
    let kinds = sample.clusters();
    match (method, fitted.cloud) {
        _ if kinds.is_empty() => None,
        (Method::Outcomes, _) => outcome_shares(sample, fitted.curve.ln_median(), fitted.curve.beta()),
        (_, Some(cloud)) => {
            let (rows, values): (Vec<usize>, Vec<f64>) = residuals(sample, &cloud).into_iter().unzip();
            components(&rows, &values, kinds).map(|found| found.shares(kinds))
        }
        // Of capacities that are all known.
        (Method::Incremental, _) if sample.failures() == sample.trials() => {
            let rows: Vec<usize> = (0..sample.len()).collect();
            components(&rows, sample.ln_intensity(), kinds).map(|found| found.shares(kinds))
        }
        _ => None,
    }
}

fn bootstrap(sample: &Sample, settings: &Settings, fitted: &Fitted) -> BootstrapResult {
    let Settings { method, bootstrap, .. } = *settings;
    let level = expanded_level(settings.level, independent(sample));
    let replicates = bootstrap.run(method, sample);
    let of = |value: fn(&Fitted) -> f64| Replicates::new(replicates.iter().map(|r| r.as_ref().map(value)));
    let (ln_median, beta) = (of(|fit| fit.curve.ln_median()), of(|fit| fit.curve.beta()));
    let [without_ln_median, without_beta] = left_out(method, sample);
    let corrected = level.and_then(|level| {
        ln_median
            .bias_corrected(fitted.curve.ln_median(), &without_ln_median, level)
            .zip(beta.bias_corrected(fitted.curve.beta(), &without_beta, level))
    });
    let percentile = |of: &Replicates| level.map_or(Interval::default(), |level| of.percentile(level));
    let bounds = |ln_median: Interval, beta| Bounds { median: exponential(ln_median), beta };
    BootstrapResult {
        unknown: ln_median.unknown(),
        percentile: bounds(percentile(&ln_median), percentile(&beta)),
        bias_corrected: corrected.map(|(ln_median, beta)| bounds(ln_median, beta)),
        level,
        replicates,
    }
}

/// How many independent things were observed: clusters of the kind with the fewest, or trials without clusters.
fn independent(sample: &Sample) -> usize {
    let fewest = sample.clusters().iter().map(|clusters| clusters.count).min();
    fewest.unwrap_or_else(|| sample.totals().1 as usize)
}

fn exponential(ln: Interval) -> Interval {
    Interval { lower: ln.lower.map(f64::exp), upper: ln.upper.map(f64::exp) }
}

impl BootstrapResult {
    /// Pointwise percentile interval of the probability at an intensity given by its logarithm.
    pub fn probability_at_ln(&self, ln_intensity: f64) -> Interval {
        let Some(level) = self.level else { return Interval::default() };
        let values =
            self.replicates.iter().map(|r| r.as_ref().map(|fit| fit.probability_at_ln(ln_intensity)));
        Replicates::new(values).percentile(level)
    }

    /// The bounds to quote: bias-corrected where they exist.
    pub fn best(&self) -> (&'static str, Bounds) {
        match self.bias_corrected {
            Some(bounds) => ("bca", bounds),
            None => ("percentile", self.percentile),
        }
    }
}

impl Known {
    /// The intervals to quote and what they are: the bootstrap's, or else those of the profile likelihood.
    pub fn best(&self) -> Option<(&'static str, Bounds)> {
        let bootstrap = self.bootstrap.as_ref().map(BootstrapResult::best);
        bootstrap.or(self.profile.map(|bounds| ("profile", bounds)))
    }
}

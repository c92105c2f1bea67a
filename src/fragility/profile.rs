//! Profile-likelihood intervals: the values a likelihood-ratio test does not reject.
//!
//! The bounds of ln θ and of β are where twice the fall of the log-likelihood, maximised over the other parameter,
//! reaches the χ² quantile of one degree of freedom (Venzon & Moolgavkar 1988, Applied Statistics 37). They hold for
//! independent outcomes; outcomes that share a record or a façade need the bootstrap.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::binomial::Link;
use super::interval::Interval;
use super::outcomes::{OutcomeFit, counts};
use super::sample::Sample;

/// How far out a bound is sought, in doublings of a standard error: 2²⁰ of them.
const DOUBLINGS: usize = 20;

/// Halvings of the bracket of a bound: to rounding.
const HALVINGS: usize = 60;

/// Intervals of the median and of β at a confidence level; a bound that no fall of the likelihood sets is none.
pub fn profile_intervals(sample: &Sample, fit: &OutcomeFit, level: f64) -> [Interval; 2] {
    let weights = sample.unit_weights();
    let counts = counts(sample, &weights);
    let limit = fit.log_likelihood - 0.5 * chi_squared_quantile(level);
    let slope = 1.0 / fit.curve.beta();
    let ln_median = fit.curve.ln_median();
    let of_median = |t: f64| counts.profile_through(Link::Probit, t, slope).ok();
    let of_slope = |b: f64| counts.profile_with_slope(Link::Probit, b, ln_median).ok();
    let median = [-1.0, 1.0].map(|side| {
        bound(|s| of_median(ln_median + side * s), limit, fit.ln_median_error)
            .map(|s| (ln_median + side * s).exp())
    });
    // On ln b, so that β = 1/b stays above 0; a slope of 0 is an infinite β.
    let step = fit.beta_error / fit.curve.beta();
    let beta = [1.0, -1.0].map(|side| {
        bound(|s| of_slope(slope * (side * s).exp()), limit, step).map(|s| (-side * s).exp() / slope)
    });
    [Interval { lower: median[0], upper: median[1] }, Interval { lower: beta[0], upper: beta[1] }]
}

/// Quantile of χ² with one degree of freedom.
fn chi_squared_quantile(level: f64) -> f64 {
    // One degree of freedom is always allowed.
    ChiSquared::new(1.0).map_or(f64::NAN, |chi| chi.inverse_cdf(level))
}

/// The distance at which `profile` falls below `limit`: doubled until it does, then halved.
fn bound(profile: impl Fn(f64) -> Option<f64>, limit: f64, step: f64) -> Option<f64> {
    let below = |s: f64| profile(s).map(|value| value < limit);
    let mut outside = step;
    let mut doublings = 0;
    while !below(outside)? {
        outside *= 2.0;
        doublings += 1;
        if doublings > DOUBLINGS {
            return None;
        }
    }
    let mut inside = if doublings == 0 { 0.0 } else { 0.5 * outside };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if below(middle)? {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    Some(0.5 * (inside + outside))
}

#[cfg(test)]
mod tests {
    use super::super::outcomes::fit_outcomes;
    use super::*;

    #[test]
    fn verified_bounds_against_an_independent_search() {
        // tests/python/fragility_reference.py, "stripes": scipy's root finder on scipy's own profile.
        let stripes = [(0.2, 0, 40), (0.4, 2, 40), (0.6, 8, 40), (0.8, 17, 40), (1.0, 24, 40), (1.5, 36, 40)];
        let sample = Sample::from_stripes(stripes).expect("valid");
        let fit = fit_outcomes(&sample).expect("fits");
        let [median, beta] = profile_intervals(&sample, &fit, 0.95);
        let found = [median.lower, median.upper, beta.lower, beta.upper].map(|b| b.expect("a bound"));
        for (found, expected) in
            found.into_iter().zip([0.794_417_996, 0.959_882_806, 0.357_063_208, 0.584_993_701])
        {
            // scipy's minimiser inside the root finder is good to about 1e-6.
            assert!((found - expected).abs() < 1e-5, "{found} against {expected}");
        }
    }

    #[test]
    fn analytic_a_slope_that_may_be_zero_leaves_beta_without_an_upper_bound() {
        let sample = Sample::from_stripes([(0.5, 2, 6), (1.0, 3, 6)]).expect("valid");
        let fit = fit_outcomes(&sample).expect("fits");
        let [median, beta] = profile_intervals(&sample, &fit, 0.95);
        assert!(beta.upper.is_none() && beta.lower.is_some(), "{beta:?}");
        assert!(median.lower.is_none(), "a flat curve has its median anywhere: {median:?}");
    }
}

//! The log-normal fragility of outcomes: probit regression on ln x by maximum likelihood.
//!
//! Baker (2015), "Efficient analytical fragility function fitting using dynamic structural analysis", Earthquake
//! Spectra 31(1), Eq. 11: maximise Σ ln [C(n, k) p^k (1 - p)^(n - k)] with p = Φ(ln(x/θ)/β). With a = -ln θ/β and
//! b = 1/β this is probit regression, whose likelihood is concave. The binomial coefficients C(n, k) do not depend on
//! θ and β and are left out of log-likelihoods.

use super::binomial::{Counts, Line, Link};
use super::method::LogNormal;
use super::method::Unknown;
use super::sample::Sample;

/// A fragility of maximum likelihood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutcomeFit {
    /// The fragility.
    pub curve: LogNormal,
    /// Log-likelihood, without the binomial coefficients.
    pub log_likelihood: f64,
    /// Standard error of ln θ from the observed information.
    pub ln_median_error: f64,
    /// Standard error of β from the observed information.
    pub beta_error: f64,
}

/// The rows of a sample as counts over ln x.
pub(super) fn counts<'a>(sample: &'a Sample, weights: &'a [f64]) -> Counts<'a> {
    Counts { x: sample.ln_intensity(), failures: sample.failures(), trials: sample.trials(), weights }
}

/// The fragility of largest likelihood, each row with a weight (1 for the data themselves), and its log-likelihood.
///
/// A fragility that is `near` saves steps and changes nothing else.
///
/// # Errors
/// [`Unknown`] where the data do not tell one.
pub fn fit_curve(
    sample: &Sample,
    weights: &[f64],
    near: Option<&LogNormal>,
) -> Result<(LogNormal, f64), Unknown> {
    let near = near.map(line_of);
    let line = counts(sample, weights).fit_from(Link::Probit, near.as_ref())?;
    curve_of(&line).map(|curve| (curve, line.log_likelihood))
}

/// The same of the data themselves, with standard errors.
///
/// # Errors
/// As [`fit_curve`].
pub fn fit_outcomes(sample: &Sample) -> Result<OutcomeFit, Unknown> {
    let weights = sample.unit_weights();
    let counts = counts(sample, &weights);
    let line = counts.fit(Link::Probit)?;
    let curve = curve_of(&line)?;
    // At x0 = ln θ the value of η is -(ln θ' - ln θ)/β to first order, and β = 1/b.
    let [at_median, slope] = counts.standard_errors(Link::Probit, &line, curve.ln_median());
    Ok(OutcomeFit {
        curve,
        log_likelihood: line.log_likelihood,
        ln_median_error: at_median * curve.beta(),
        beta_error: slope * curve.beta() * curve.beta(),
    })
}

fn line_of(curve: &LogNormal) -> Line {
    let slope = 1.0 / curve.beta();
    Line { intercept: -curve.ln_median() * slope, slope, log_likelihood: f64::NAN }
}

fn curve_of(line: &Line) -> Result<LogNormal, Unknown> {
    if line.slope <= 0.0 {
        return Err(Unknown::NotIncreasing);
    }
    LogNormal::new(-line.intercept / line.slope, 1.0 / line.slope).ok_or(Unknown::NotIncreasing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verified_stripes_against_an_independent_fit() {
        // tests/python/fragility_reference.py, "stripes": probit of statsmodels.
        let stripes = [(0.2, 0, 40), (0.4, 2, 40), (0.6, 8, 40), (0.8, 17, 40), (1.0, 24, 40), (1.5, 36, 40)];
        let fit = fit_outcomes(&Sample::from_stripes(stripes).expect("valid")).expect("fits");
        // statsmodels stops its own Newton steps at about 1e-8.
        assert!((fit.curve.median() - 0.870_581_096_015).abs() < 1e-7, "{fit:?}");
        assert!((fit.curve.beta() - 0.449_521_986_644).abs() < 1e-7, "{fit:?}");
        assert!((fit.log_likelihood + 95.282_273_960_3).abs() < 1e-7, "{fit:?}");
        assert!((fit.ln_median_error - 0.047_241_353_169_6).abs() < 1e-6, "{fit:?}");
        assert!((fit.beta_error - 0.056_314_706_678_7).abs() < 1e-6, "{fit:?}");
    }

    #[test]
    fn analytic_the_unit_of_the_intensity_scales_the_median_alone() {
        let stripes = [(0.1, 1, 20), (0.2, 6, 20), (0.4, 15, 20)];
        let fit = |unit: f64| {
            let sample = Sample::from_stripes(stripes.map(|(x, k, n)| (x * unit, k, n))).expect("valid");
            fit_outcomes(&sample).expect("fits").curve
        };
        let (m, cm) = (fit(1.0), fit(100.0));
        // Both end within the decrement of the optimiser, about 1e-7 of a standard error.
        assert!((cm.median() / m.median() / 100.0 - 1.0).abs() < 1e-7);
        assert!((cm.beta() / m.beta() - 1.0).abs() < 1e-7);
    }

    #[test]
    fn rejects_to_name_a_fragility_that_falls() {
        let sample = Sample::from_stripes([(0.1, 15, 20), (0.2, 6, 20), (0.4, 3, 20)]).expect("valid");
        assert_eq!(fit_outcomes(&sample), Err(Unknown::NotIncreasing));
    }
}

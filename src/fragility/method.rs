//! The three ways to a log-normal fragility, behind one call that takes weights, and why data may not tell one.

use super::cloud::{CloudFit, fit_cloud};
use super::incremental::fit_incremental;
use super::outcomes::fit_curve;
use super::sample::Sample;
use mrbd_statistics::normal;

/// How a fragility is told from a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Outcomes at intensities, single or in stripes: maximum likelihood.
    Outcomes,
    /// Collapse intensities, some truncated: a row that did not fail stood at the highest intensity that was run.
    Incremental,
    /// Demands against a limit, in the unit of the demands, with collapses apart.
    Cloud {
        /// The limit.
        limit: f64,
    },
}

/// A fragility and the curve it came as.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Median and β; for a cloud with collapses, those of the log-normal of the same 16, 50 and 84 % fractiles.
    pub curve: LogNormal,
    /// The cloud behind it.
    pub cloud: Option<CloudFit>,
    /// Log-likelihood of what was maximised; none for a cloud.
    pub log_likelihood: Option<f64>,
}

impl Method {
    /// Name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Method::Outcomes => "outcomes",
            Method::Incremental => "incremental",
            Method::Cloud { .. } => "cloud",
        }
    }

    /// The fragility of a sample, each row with a weight.
    ///
    /// # Errors
    /// [`Unknown`] where the sample does not tell one.
    pub fn fit(&self, sample: &Sample, weights: &[f64]) -> Result<Fitted, Unknown> {
        self.fit_from(sample, weights, None)
    }

    /// The same; a fragility that is `near` saves steps.
    ///
    /// # Errors
    /// As [`Method::fit`].
    pub fn fit_from(
        &self,
        sample: &Sample,
        weights: &[f64],
        near: Option<&Fitted>,
    ) -> Result<Fitted, Unknown> {
        match self {
            Method::Outcomes => {
                fit_curve(sample, weights, near.map(|near| &near.curve)).map(Fitted::lognormal)
            }
            Method::Incremental => fit_incremental(sample, weights).map(Fitted::lognormal),
            Method::Cloud { limit } => {
                let cloud = fit_cloud(sample, weights, limit.ln())?;
                let curve = cloud.equivalent().ok_or(Unknown::NotIncreasing)?;
                Ok(Fitted { curve, cloud: Some(cloud), log_likelihood: None })
            }
        }
    }
}

impl Fitted {
    fn lognormal((curve, log_likelihood): (LogNormal, f64)) -> Self {
        Self { curve, cloud: None, log_likelihood: Some(log_likelihood) }
    }

    /// Probability of failure at an intensity given by its logarithm.
    pub fn probability_at_ln(&self, ln_intensity: f64) -> f64 {
        match self.cloud {
            Some(cloud) => cloud.probability_at_ln(ln_intensity),
            None => self.curve.probability_at_ln(ln_intensity),
        }
    }
}

/// What the data lack.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Unknown {
    /// Nothing was observed.
    #[error("no observations")]
    NoData,
    /// Not one failed: the data only say that the median is high.
    #[error("no failures among the observations")]
    NoFailures,
    /// All failed: the data only say that the median is low.
    #[error("failures only, nothing stood")]
    FailuresOnly,
    /// All observations share one intensity.
    #[error("one intensity only")]
    OneIntensity,
    /// A threshold parts what stood from what failed: the likelihood grows for ever as β falls to 0.
    #[error(
        "a threshold between intensities {below} and {above} separates all that stood from all that failed"
    )]
    Separated {
        /// The highest intensity on the lower side.
        below: f64,
        /// The lowest intensity on the upper side.
        above: f64,
    },
    /// Failures do not become more likely with intensity.
    #[error("failures do not become more likely with the intensity")]
    NotIncreasing,
    /// Fewer than two collapse intensities that differ.
    #[error("fewer than two different collapse intensities")]
    TooFewCollapses,
    /// The demands of what stood do not scatter, so that their regression is exact.
    #[error("fewer than three demands, or demands without scatter")]
    TooFewDemands,
    /// The optimiser gave up.
    #[error("the likelihood could not be maximised")]
    NotConverged,
}

impl Unknown {
    /// A name for scripts.
    pub fn name(&self) -> &'static str {
        match self {
            Unknown::NoData => "no_data",
            Unknown::NoFailures => "no_failures",
            Unknown::FailuresOnly => "failures_only",
            Unknown::OneIntensity => "one_intensity",
            Unknown::Separated { .. } => "separated",
            Unknown::NotIncreasing => "not_increasing",
            Unknown::TooFewCollapses => "too_few_collapses",
            Unknown::TooFewDemands => "too_few_demands",
            Unknown::NotConverged => "not_converged",
        }
    }
}

/// A log-normal fragility that exists: median and dispersion finite and above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogNormal {
    ln_median: f64,
    beta: f64,
}

impl LogNormal {
    /// From ln θ and β; none unless θ and β are finite and above 0.
    pub fn new(ln_median: f64, beta: f64) -> Option<Self> {
        let exists = ln_median.exp().is_normal() && beta.is_finite() && beta > 0.0;
        exists.then_some(Self { ln_median, beta })
    }

    /// Median θ, in the unit of the intensity.
    pub fn median(&self) -> f64 {
        self.ln_median.exp()
    }

    /// ln θ.
    pub fn ln_median(&self) -> f64 {
        self.ln_median
    }

    /// Dispersion β, the standard deviation of the logarithm.
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Probability of failure at an intensity given by its logarithm.
    pub fn probability_at_ln(&self, ln_intensity: f64) -> f64 {
        normal::cdf((ln_intensity - self.ln_median) / self.beta)
    }

    /// Intensity at which the probability is `p`.
    pub fn intensity_at(&self, p: f64) -> f64 {
        (self.ln_median + self.beta * normal::quantile(p)).exp()
    }

    /// Mean of the intensity of failure, θ exp(β²/2), in the unit of the intensity.
    pub fn mean(&self) -> f64 {
        (self.ln_median + 0.5 * self.beta * self.beta).exp()
    }

    /// Standard deviation of the intensity of failure, mean √(exp β² - 1), in the unit of the intensity.
    pub fn standard_deviation(&self) -> f64 {
        self.mean() * (self.beta * self.beta).exp_m1().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_median_and_moments() {
        let curve = LogNormal::new(0.2f64.ln(), 0.5).expect("valid");
        // Rounding of one exponential.
        assert!((curve.probability_at_ln(0.2f64.ln()) - 0.5).abs() < 1e-15);
        assert!((curve.intensity_at(0.5) - 0.2).abs() < 1e-15);
        // Back as OpenQuake does it: σ² = ln(1 + s²/m²), median = m²/√(m² + s²).
        let (m, s) = (curve.mean(), curve.standard_deviation());
        assert!(((1.0 + s * s / (m * m)).ln().sqrt() - 0.5).abs() < 1e-14);
        assert!((m * m / (m * m + s * s).sqrt() - 0.2).abs() < 1e-15);
    }

    #[test]
    fn rejects_what_is_no_distribution() {
        assert!(LogNormal::new(0.0, 0.0).is_none());
        assert!(LogNormal::new(0.0, f64::INFINITY).is_none());
        assert!(LogNormal::new(1e4, 0.5).is_none());
        assert!(LogNormal::new(f64::NAN, 0.5).is_none());
    }
}

//! The three ways to a fragility, behind one call that takes weights, so that a bootstrap serves them all.

use super::cloud::{CloudFit, fit_cloud};
use super::incremental::fit_incremental;
use super::lognormal::LogNormal;
use super::outcomes::fit_curve;
use super::sample::Sample;
use super::unknown::Unknown;

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

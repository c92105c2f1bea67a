//! The fragility of a cloud: demands that grow with the intensity, and collapses that have no demand.
//!
//! Jalayer et al. (2017), "Bayesian Cloud Analysis: efficient structural fragility assessment using linear regression"
//! and "Analytical fragility assessment using unscaled ground motion records", Earthquake Engng Struct. Dyn. 46:
//! ln EDP = a + b ln IM with a standard deviation s over the runs that stood, and the probability of collapse by
//! logistic regression over all runs; P(EDP > limit | IM) = Φ((a + b ln IM - ln limit)/s) (1 - P_C) + P_C.

use super::binomial::{Line, Link};
use super::method::LogNormal;
use super::method::Unknown;
use super::sample::Sample;
use mrbd_statistics::normal;

/// A cloud's fragility for one limit of the demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudFit {
    /// Intercept a of ln EDP.
    pub intercept: f64,
    /// Slope b.
    pub slope: f64,
    /// Standard deviation s of ln EDP about the line, over n - 2.
    pub scatter: f64,
    /// Collapse as a logistic line over ln IM; none where nothing collapsed.
    pub collapse: Option<Line>,
    /// ln of the limit of the demand.
    pub ln_limit: f64,
}

impl CloudFit {
    /// Probability that the limit is exceeded at an intensity given by its logarithm.
    pub fn probability_at_ln(&self, ln_intensity: f64) -> f64 {
        let mean = self.intercept + self.slope * ln_intensity;
        let exceeds = normal::cdf((mean - self.ln_limit) / self.scatter);
        let collapses = self
            .collapse
            .map_or(0.0, |line| Link::Logit.probability(line.intercept + line.slope * ln_intensity));
        exceeds * (1.0 - collapses) + collapses
    }

    /// The log-normal of the same 16 %, 50 % and 84 % fractiles: its median, and β = ½ ln(x84/x16).
    ///
    /// Without collapses this is exact: θ = exp((ln limit - a)/b), β = s/b.
    pub fn equivalent(&self) -> Option<LogNormal> {
        let [low, median, high] = [-1.0, 0.0, 1.0].map(|z| self.ln_intensity_at(normal::cdf(z)));
        LogNormal::new(median?, 0.5 * (high? - low?))
    }

    /// Inverse of the probability, which grows with the intensity, by halving.
    fn ln_intensity_at(&self, p: f64) -> Option<f64> {
        let middle = (self.ln_limit - self.intercept) / self.slope;
        // Collapse only raises the probability, so the intensity lies at or below that of the line alone.
        let mut high = middle + self.scatter / self.slope * normal::quantile(p);
        let mut width = self.scatter / self.slope;
        while self.probability_at_ln(high - width) > p {
            width *= 2.0;
            if width > 1e3 {
                return None;
            }
        }
        let mut low = high - width;
        // 60 halvings of a width below 1000 end at rounding.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.probability_at_ln(middle) > p {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}

/// Fits a cloud: a failure of the sample is a collapse, and a row that stood has a demand.
///
/// # Errors
/// [`Unknown`] where demands or collapses do not tell their lines.
pub fn fit_cloud(sample: &Sample, weights: &[f64], ln_limit: f64) -> Result<CloudFit, Unknown> {
    let [intercept, slope, scatter] = demand_line(sample, weights)?;
    let counts = super::outcomes::counts(sample, weights);
    let collapse = match counts.fit(Link::Logit) {
        Ok(line) if line.slope > 0.0 => Some(line),
        Ok(_) => return Err(Unknown::NotIncreasing),
        Err(Unknown::NoFailures) => None,
        Err(unknown) => return Err(unknown),
    };
    Ok(CloudFit { intercept, slope, scatter, collapse, ln_limit })
}

/// a, b and s by weighted least squares.
fn demand_line(sample: &Sample, weights: &[f64]) -> Result<[f64; 3], Unknown> {
    let rows = || {
        let data = sample.ln_intensity().iter().zip(sample.ln_demand()).zip(weights);
        data.filter_map(|((&x, y), &w)| y.map(|y| (x, y, w)))
    };
    let total: f64 = rows().map(|(_, _, w)| w).sum();
    let [x0, y0] = [rows().map(|(x, _, w)| w * x).sum::<f64>(), rows().map(|(_, y, w)| w * y).sum()]
        .map(|sum| sum / total);
    let xx: f64 = rows().map(|(x, _, w)| w * (x - x0).powi(2)).sum();
    let xy: f64 = rows().map(|(x, y, w)| w * (x - x0) * (y - y0)).sum();
    let slope = xy / xx;
    let squares: f64 = rows().map(|(x, y, w)| w * (y - y0 - slope * (x - x0)).powi(2)).sum();
    let scatter = (squares / (total - 2.0)).sqrt();
    if !(total > 2.0 && xx > 0.0 && scatter > 0.0) {
        return Err(Unknown::TooFewDemands);
    }
    if slope <= 0.0 {
        return Err(Unknown::NotIncreasing);
    }
    Ok([y0 - slope * x0, slope, scatter])
}

/// ln EDP minus the line, for the rows that have a demand, with their positions.
pub(super) fn residuals(sample: &Sample, fit: &CloudFit) -> Vec<(usize, f64)> {
    let rows = sample.ln_intensity().iter().zip(sample.ln_demand()).enumerate();
    rows.filter_map(|(i, (x, y))| y.map(|y| (i, y - fit.intercept - fit.slope * x))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::sample::Observation;
    use super::*;

    const CLOUD: [(f64, f64); 7] =
        [(0.1, 0.012), (0.15, 0.03), (0.2, 0.02), (0.3, 0.06), (0.45, 0.05), (0.6, 0.14), (0.8, 0.12)];

    fn cloud(collapsed: &[f64]) -> Sample {
        let mut sample = Sample::default();
        for (intensity, demand) in CLOUD {
            let row = Observation { intensity, failures: 0, trials: 1, demand: Some(demand) };
            sample.push(row).expect("valid");
        }
        for &intensity in collapsed {
            let row = Observation { intensity, failures: 1, trials: 1, demand: None };
            sample.push(row).expect("valid");
        }
        sample
    }

    #[test]
    fn verified_line_and_fragility_against_least_squares() {
        // tests/python/fragility_reference.py, "cloud at 0.1": OLS of statsmodels.
        let sample = cloud(&[]);
        let fit = fit_cloud(&sample, &sample.unit_weights(), 0.1f64.ln()).expect("fits");
        let curve = fit.equivalent().expect("exists");
        let found = [fit.intercept, fit.slope, fit.scatter, curve.median(), curve.beta()];
        let expected =
            [-1.744_551_876_4, 1.114_619_682_03, 0.351_699_981_92, 0.606_137_155_869, 0.315_533_618_857];
        for (found, expected) in found.into_iter().zip(expected) {
            // The reference is printed with 12 digits.
            assert!((found - expected).abs() < 1e-10, "{found} against {expected}");
        }
    }

    #[test]
    fn analytic_collapses_raise_the_probability_by_their_share_of_what_is_left() {
        let sample = cloud(&[0.4, 0.7, 0.9]);
        let fit = fit_cloud(&sample, &sample.unit_weights(), 0.1f64.ln()).expect("fits");
        let collapse = fit.collapse.expect("collapses");
        let x = 0.5f64.ln();
        let line_alone = CloudFit { collapse: None, ..fit }.probability_at_ln(x);
        let p_c = 1.0 / (1.0 + (-collapse.intercept - collapse.slope * x).exp());
        // Rounding of a sum of products below 1.
        assert!((1.0 - fit.probability_at_ln(x) - (1.0 - line_alone) * (1.0 - p_c)).abs() < 1e-15);
        let curve = fit.equivalent().expect("exists");
        assert!((fit.probability_at_ln(curve.ln_median()) - 0.5).abs() < 1e-12, "halved to rounding");
    }

    #[test]
    fn rejects_a_cloud_without_scatter_or_growth() {
        let mut sample = Sample::default();
        for intensity in [0.1, 0.2] {
            let row = Observation { intensity, failures: 0, trials: 1, demand: Some(intensity) };
            sample.push(row).expect("valid");
        }
        assert_eq!(fit_cloud(&sample, &[1.0; 2], 0.0), Err(Unknown::TooFewDemands));
        let collapsed_low = cloud(&[0.11, 0.12]);
        let fit = fit_cloud(&collapsed_low, &collapsed_low.unit_weights(), 0.0);
        assert_eq!(fit, Err(Unknown::NotIncreasing));
    }
}

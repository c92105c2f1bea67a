//! The log-normal fragility P(failure | x) = Φ(ln(x/θ)/β) (Baker 2015, Eq. 1).

use mrbd_statistics::normal;

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

//! Distributions of single variables: log-normal, truncated log-normal, constant.

use mrbd_statistics::normal;

use super::Refused;

/// Probability that must be left between truncations: below it the inverse loses its digits.
const LEAST_PROBABILITY: f64 = 1e-9;

/// Limits of a truncated variable, in its unit; none where there is none.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Truncation {
    /// No value below it.
    pub lower: Option<f64>,
    /// No value above it.
    pub upper: Option<f64>,
}

/// A distribution that exists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Marginal {
    /// Always this value.
    Constant(f64),
    /// ln x ~ N(ln median, β) between the truncations.
    LogNormal {
        /// ln of the median before truncation.
        ln_median: f64,
        /// Standard deviation of the logarithm before truncation, above 0.
        beta: f64,
        /// Probabilities below and above the truncations.
        cut: [f64; 2],
        /// The truncations.
        truncation: Truncation,
    },
}

impl Marginal {
    /// The distribution of three levels μ - σ, μ, μ + σ of a logarithm, given as values of the variable in either order:
    /// median = μ, β = ½ |ln(upper/lower)|. Three equal levels are a constant, which truncations must allow.
    ///
    /// # Errors
    /// [`Refused`] under `key` for levels out of order or not above 0, and for truncations that leave nothing.
    pub fn from_levels(key: &str, levels: [f64; 3], truncation: Truncation) -> Result<Self, Refused> {
        let [low, median, high] = levels;
        check_truncation(key, truncation)?;
        if low == median && median == high && median.is_finite() {
            return Self::constant(key, median, truncation);
        }
        let ordered = (low < median && median < high) || (low > median && median > high);
        if !(ordered && low > 0.0 && high > 0.0 && low.is_finite() && high.is_finite()) {
            let allowed = "three equal values, or three different ones above 0 in rising or falling order";
            return Err(Refused::new(key, format!("{levels:?}"), allowed));
        }
        let beta = 0.5 * (high / low).ln().abs();
        Self::log_normal(key, median.ln(), beta, truncation)
    }

    fn constant(key: &str, value: f64, truncation: Truncation) -> Result<Self, Refused> {
        let Truncation { lower, upper } = truncation;
        if lower.is_some_and(|lower| value < lower) || upper.is_some_and(|upper| value > upper) {
            let found = format!("the constant {value} outside {}", range(truncation));
            return Err(Refused::new(key, found, "truncations that leave the value"));
        }
        Ok(Marginal::Constant(value))
    }

    fn log_normal(key: &str, ln_median: f64, beta: f64, truncation: Truncation) -> Result<Self, Refused> {
        let z = |x: f64| (x.max(0.0).ln() - ln_median) / beta;
        let below = truncation.lower.map_or(0.0, |lower| normal::cdf(z(lower)));
        let above = truncation.upper.map_or(0.0, |upper| normal::cdf(-z(upper)));
        if below + above > 1.0 - LEAST_PROBABILITY {
            let found = format!("a probability below {LEAST_PROBABILITY} in {}", range(truncation));
            return Err(Refused::new(key, found, "truncations that leave some of the distribution"));
        }
        Ok(Marginal::LogNormal { ln_median, beta, cut: [below, above], truncation })
    }

    /// The value below which lies the fraction `u` of the (truncated) distribution; 0 < u < 1.
    pub fn quantile(&self, u: f64) -> f64 {
        match *self {
            Marginal::Constant(value) => value,
            Marginal::LogNormal { ln_median, beta, cut: [below, above], truncation } => {
                let left = 1.0 - below - above;
                // From the nearer tail, so that neither loses its digits.
                let z = match below + u * left {
                    p if p <= 0.5 => normal::quantile(p),
                    _ => -normal::quantile(above + (1.0 - u) * left),
                };
                let value = (ln_median + beta * z).exp();
                // Rounding must not step over a limit.
                value.max(truncation.lower.unwrap_or(0.0)).min(truncation.upper.unwrap_or(f64::INFINITY))
            }
        }
    }

    /// Whether the variable varies.
    pub fn varies(&self) -> bool {
        matches!(self, Marginal::LogNormal { .. })
    }

    /// Probability that the truncations took away; 0 for a constant.
    pub fn cut_probability(&self) -> f64 {
        match self {
            Marginal::Constant(_) => 0.0,
            Marginal::LogNormal { cut, .. } => cut[0] + cut[1],
        }
    }
}

fn check_truncation(key: &str, truncation: Truncation) -> Result<(), Refused> {
    let Truncation { lower, upper } = truncation;
    let finite = lower.is_none_or(f64::is_finite) && upper.is_none_or(f64::is_finite);
    let ordered = lower.zip(upper).is_none_or(|(lower, upper)| lower < upper);
    if finite && ordered {
        return Ok(());
    }
    Err(Refused::new(key, range(truncation), "finite truncations, the lower one below the upper one"))
}

fn range(Truncation { lower, upper }: Truncation) -> String {
    let limit = |limit: Option<f64>| limit.map_or("none".to_owned(), |limit| limit.to_string());
    format!("truncations {} and {}", limit(lower), limit(upper))
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ContinuousCDF, LogNormal};

    use super::*;

    const FREE: Truncation = Truncation { lower: None, upper: None };

    #[test]
    fn published_stiffness_of_table_3() {
        let marginal = Marginal::from_levels("k", [400e3, 1400e3, 4600e3], FREE).expect("valid");
        // The median is the table's; one β up and down is a factor of √(4600/400) = √11.5, not the table's columns
        // themselves, whose logarithms are not symmetric about the median.
        let at = |z: f64| marginal.quantile(normal::cdf(z)) / 1400e3;
        // Rounding of Φ and its inverse.
        assert!((at(0.0) - 1.0).abs() < 1e-12);
        assert!((at(1.0) - 11.5f64.sqrt()).abs() < 1e-12 && (at(-1.0) * 11.5f64.sqrt() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn verified_quantiles_against_the_library() {
        let marginal = Marginal::from_levels("h", [0.73, 0.62, 0.52], FREE).expect("falling is allowed");
        let library = LogNormal::new(0.62f64.ln(), 0.5 * (0.73f64 / 0.52).ln()).expect("valid");
        for u in [0.001, 0.1, 0.5, 0.77, 0.999] {
            // The library's inverse is good to about 1e-10.
            assert!((marginal.quantile(u) / library.inverse_cdf(u) - 1.0).abs() < 1e-9, "{u}");
        }
    }

    #[test]
    fn analytic_truncation_is_the_conditional_distribution() {
        let truncation = Truncation { lower: Some(0.5), upper: Some(0.95) };
        let marginal = Marginal::from_levels("h", [0.73, 0.62, 0.52], truncation).expect("valid");
        let free = LogNormal::new(0.62f64.ln(), 0.5 * (0.73f64 / 0.52).ln()).expect("valid");
        let (low, high) = (free.cdf(0.5), free.cdf(0.95));
        for u in [0.0001, 0.2, 0.5, 0.9, 0.9999] {
            let found = (free.cdf(marginal.quantile(u)) - low) / (high - low);
            // The library's distribution is good to about 1e-10.
            assert!((found - u).abs() < 1e-9, "{found} for {u}");
        }
        assert!((marginal.cut_probability() - low - 1.0 + high).abs() < 1e-9);
        // Ends, at the extremes of what a draw can be.
        assert!(marginal.quantile(2f64.powi(-53)) >= 0.5 && marginal.quantile(1.0 - 2f64.powi(-53)) <= 0.95);
    }

    #[test]
    fn analytic_equal_levels_are_a_constant_even_0() {
        let marginal = Marginal::from_levels("m", [0.0; 3], FREE).expect("valid");
        assert_eq!((marginal, marginal.quantile(0.3)), (Marginal::Constant(0.0), 0.0));
    }

    #[test]
    fn rejects_impossible_distributions() {
        let refused = |levels, lower, upper| {
            Marginal::from_levels("wall.b", levels, Truncation { lower, upper })
                .expect_err("refused")
                .to_string()
        };
        assert!(refused([1.0, 3.0, 2.0], None, None).starts_with("wall.b: found [1.0, 3.0, 2.0]"));
        assert!(refused([0.0, 1.0, 2.0], None, None).contains("above 0"));
        assert!(refused([1.0, f64::NAN, 2.0], None, None).contains("NaN"));
        assert!(refused([1.0, 1.0, 2.0], None, None).contains("three equal values"));
        assert!(refused([1.0, 2.0, 3.0], Some(3.0), Some(2.0)).contains("the lower one below the upper"));
        assert!(refused([1.0, 2.0, 3.0], Some(1e9), None).contains("leave some of the distribution"));
        assert!(refused([2.0, 2.0, 2.0], Some(3.0), None).contains("the constant 2"));
    }
}

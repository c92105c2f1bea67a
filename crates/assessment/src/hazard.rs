//! A hazard curve, and with a fragility the annual rate of a limit state.

use mrbd_statistics::normal;
use serde::{Deserialize, Serialize};

/// A point of a hazard curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HazardPoint {
    /// Intensity, in the unit of the fragility.
    pub intensity: f64,
    /// Annual rate at which it is exceeded, 1/year.
    pub annual_rate: f64,
}

/// A hazard curve: rates at rising intensities, a power law between two points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hazard {
    points: Vec<HazardPoint>,
}

/// Why points are no hazard curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoHazard {
    /// Fewer than two points.
    #[error("fewer than two points")]
    Few,
    /// An intensity or rate that is not above 0.
    #[error("point {0}: an intensity or rate that is not a number above 0")]
    NotPositive(usize),
    /// Intensities that do not rise, or rates that do.
    #[error("point {0}: an intensity that does not rise, or a rate that does")]
    NotFalling(usize),
}

/// The annual rate of a limit state, and what of it lies beyond the hazard curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// 1/year.
    pub annual_rate: f64,
    /// Share of it from intensities beyond the last point, where the last power law goes on.
    pub above_share: f64,
    /// Share from intensities below the first point, where the rate is taken as that of the first point: no less than that.
    pub below_share: f64,
}

impl Hazard {
    /// A curve through points.
    ///
    /// # Errors
    /// [`NoHazard`] with the number of the point, from 1.
    pub fn new(points: Vec<HazardPoint>) -> Result<Self, NoHazard> {
        if points.len() < 2 {
            return Err(NoHazard::Few);
        }
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let wrong = points.iter().position(|p| !(positive(p.intensity) && positive(p.annual_rate)));
        if let Some(at) = wrong {
            return Err(NoHazard::NotPositive(at + 1));
        }
        let turned = points.windows(2).position(|pair| {
            pair[1].intensity <= pair[0].intensity || pair[1].annual_rate > pair[0].annual_rate
        });
        turned.map_or(Ok(Self { points }), |at| Err(NoHazard::NotFalling(at + 2)))
    }

    /// The points.
    pub fn points(&self) -> &[HazardPoint] {
        &self.points
    }

    /// All rates times a factor.
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |p: &HazardPoint| HazardPoint { annual_rate: factor * p.annual_rate, ..*p };
        Self { points: self.points.iter().map(scaled).collect() }
    }
}

/// ∫ λ(s) dF(s) of a log-normal fragility F with median θ and dispersion β.
///
/// On a stretch where λ = k_0 s^-k the integral is k_0 θ^-k exp(k²β²/2) times what a normal distribution moved by -kβ²
/// has there: no quadrature. Over all s that is the closed form of a power law (Cornell et al. 2002).
pub fn annual_rate(hazard: &Hazard, median: f64, beta: f64) -> Rate {
    let points = &hazard.points;
    let z = |intensity: f64| (intensity / median).ln() / beta;
    let stretch = |pair: &[HazardPoint], to: f64| {
        let k =
            -(pair[1].annual_rate / pair[0].annual_rate).ln() / (pair[1].intensity / pair[0].intensity).ln();
        // k_0 θ^-k by the first point, so that nothing overflows.
        let at_median = pair[0].annual_rate * (pair[0].intensity / median).powf(k);
        let from = if to.is_finite() { pair[0].intensity } else { pair[1].intensity };
        at_median * (0.5 * (k * beta).powi(2)).exp() * between(z(from) + k * beta, z(to) + k * beta)
    };
    let within: f64 = points.windows(2).map(|pair| stretch(pair, pair[1].intensity)).sum();
    let above = stretch(&points[points.len() - 2..], f64::INFINITY);
    let below = points[0].annual_rate * normal::cdf(z(points[0].intensity));
    let annual_rate = within + above + below;
    let share = |part: f64| if annual_rate > 0.0 { part / annual_rate } else { 0.0 };
    Rate { annual_rate, above_share: share(above), below_share: share(below) }
}

/// Probability of a standard normal between two values, from the tail that keeps its digits.
fn between(low: f64, high: f64) -> f64 {
    if low > 0.0 { normal::cdf(-low) - normal::cdf(-high) } else { normal::cdf(high) - normal::cdf(low) }
}

/// Median, dispersion and hazard as far as they are known: standard deviations of ln θ, ln β and of ln λ.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Of ln θ: records, façades.
    pub ln_median: f64,
    /// Of ln β.
    pub ln_beta: f64,
    /// Of ln λ, the same at all intensities.
    pub ln_rate: f64,
}

/// Quantiles of each of the three that are combined: 31 middles of equal shares.
const QUANTILES: u32 = 31;

/// Quantiles of the annual rate over what is not known, the three taken as independent and log-normal.
///
/// Every combination of 31 quantiles of θ and β counts the same; the factor of the hazard multiplies them.
pub fn rate_quantiles(
    hazard: &Hazard,
    median: f64,
    beta: f64,
    unknown: &Uncertainty,
    at: [f64; 2],
) -> [f64; 2] {
    let middles = || (0..QUANTILES).map(|i| normal::quantile((f64::from(i) + 0.5) / f64::from(QUANTILES)));
    let few = |deviation: f64| if deviation > 0.0 { middles().collect() } else { vec![0.0] };
    let (of_median, of_beta): (Vec<f64>, Vec<f64>) = (few(unknown.ln_median), few(unknown.ln_beta));
    let factors: Vec<f64> = few(unknown.ln_rate).iter().map(|z| (unknown.ln_rate * z).exp()).collect();
    let mut rates = Vec::new();
    for z_median in &of_median {
        for z_beta in &of_beta {
            let theta = median * (unknown.ln_median * z_median).exp();
            let rate = annual_rate(hazard, theta, beta * (unknown.ln_beta * z_beta).exp()).annual_rate;
            rates.extend(factors.iter().map(|factor| factor * rate));
        }
    }
    at.map(|p| mrbd_statistics::quantile(&rates, p).unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// λ = k_0 s^-k from 1e-4 to 1e4 in so many points.
    fn power_law(k_0: f64, k: f64, points: u32) -> Hazard {
        let at = |i: u32| 10f64.powf(-4.0 + 8.0 * f64::from(i) / f64::from(points - 1));
        let point = |s: f64| HazardPoint { intensity: s, annual_rate: k_0 * s.powf(-k) };
        Hazard::new((0..points).map(at).map(point).collect()).expect("a curve")
    }

    #[test]
    fn analytic_a_power_law_has_its_closed_form() {
        for (k, theta, beta) in [(2.5, 0.4, 0.5), (1.0, 0.2, 0.3), (4.0, 1.5, 0.7)] {
            let closed = 3e-4 * f64::powf(theta, -k) * f64::exp(0.5 * (k * beta) * (k * beta));
            for points in [2, 9, 200] {
                let found = annual_rate(&power_law(3e-4, k, points), theta, beta);
                // Roundings of powers over eight decades; nothing of the fragility lies outside them.
                assert!((found.annual_rate / closed - 1.0).abs() < 1e-11, "{k} {points}: {found:?}");
                assert!(found.above_share < 1e-12 && found.below_share < 1e-12);
            }
        }
    }

    #[test]
    fn analytic_a_sharp_fragility_has_the_hazard_at_its_median() {
        let hazard = power_law(1e-3, 2.0, 9);
        let found = annual_rate(&hazard, 0.5, 1e-4).annual_rate;
        // exp(k²β²/2) is 1 + 2e-8.
        assert!((found / (1e-3 * 4.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn analytic_uncertainty_of_the_hazard_alone_is_its_own() {
        let hazard = power_law(1e-3, 2.0, 9);
        let rate = annual_rate(&hazard, 0.5, 0.4).annual_rate;
        let unknown = Uncertainty { ln_rate: 0.5, ..Uncertainty::default() };
        let [low, high] = rate_quantiles(&hazard, 0.5, 0.4, &unknown, [0.16, 0.84]);
        // 31 middles tell a quantile to a few hundredths of a deviation.
        for (found, z) in [(low, -1.0), (high, 1.0)] {
            assert!(((found / rate).ln() / 0.5 - z).abs() < 0.05_f64, "{found} {z}");
        }
        // And of the median alone k times that of ln θ.
        let unknown = Uncertainty { ln_median: 0.2, ..Uncertainty::default() };
        let [low, high] = rate_quantiles(&hazard, 0.5, 0.4, &unknown, [0.16, 0.84]);
        assert!(((high / low).ln() / (2.0 * 2.0 * 0.2) - 1.0).abs() < 0.05);
    }

    #[test]
    fn rejects_what_is_no_hazard_curve() {
        let curve = |points: &[(f64, f64)]| {
            Hazard::new(
                points
                    .iter()
                    .map(|&(intensity, annual_rate)| HazardPoint { intensity, annual_rate })
                    .collect(),
            )
        };
        assert_eq!(curve(&[(0.1, 0.1)]), Err(NoHazard::Few));
        assert_eq!(curve(&[(0.1, 0.1), (0.2, 0.0)]), Err(NoHazard::NotPositive(2)));
        assert_eq!(curve(&[(0.1, 0.1), (0.1, 0.05)]), Err(NoHazard::NotFalling(2)));
        assert_eq!(curve(&[(0.1, 0.1), (0.2, 0.05), (0.3, 0.06)]), Err(NoHazard::NotFalling(3)));
    }
}

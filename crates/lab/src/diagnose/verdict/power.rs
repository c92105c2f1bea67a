//! How large an effect must be to show in these tests.

use crate::diagnose::trials::{Data, Tried, kinds};
use crate::limits::{DETECTED_SD, LEAST_SIZE, WORTH_A_NAME};

/// What the tests can tell of a single effect, by its first number and in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Standard deviation.
    pub sd: f64,
    /// Smallest size that differs from nothing by more than chance.
    pub detected_from: f64,
    /// Smallest size that would be named: what is smaller may be there all the same.
    pub named_from: f64,
    /// Size that would matter.
    pub matters: f64,
}

/// Whether at least half of the effects would have been named at a size that matters.
pub fn could_show(data: &Data, without: &Tried, singles: &[Tried]) -> bool {
    let powers = singles.iter().filter_map(|t| power(data, without, t)).collect::<Vec<_>>();
    2 * powers.iter().filter(|power| power.named_from < power.matters).count() >= powers.len()
}

/// What the tests can tell of a single effect, beside the wall `without` it; `None` where its fit leaves no covariance, or it is
/// no effect.
pub fn power(data: &Data, without: &Tried, tried: &Tried) -> Option<Power> {
    let h = &tried.hypothesis;
    let i = h.nuisances;
    kinds(tried)?;
    let variance = tried.fit.covariance.as_ref()?[(i, i)];
    let unknown = h.unknowns.get(i)?;
    let size = tried.fit.values[i] - unknown.start;
    let gain = (h.unknowns.len() == i + 1).then(|| without.unpriced() - tried.unpriced());
    let sd = spread(variance.max(0.0).sqrt(), size, gain);
    // An effect gains half of its squared size in standard deviations.
    let named = (2.0 * (WORTH_A_NAME + tried.price(data))).sqrt();
    let named_from = (named * sd).max(LEAST_SIZE * unknown.scale);
    Some(Power { sd, detected_from: DETECTED_SD * sd, named_from, matters: unknown.scale })
}

/// The standard deviation of a size from the curvature of likelihood at it, and from what it gains over nothing, where it is
/// one number alone and gains too little to be named. Near impacts that the noise decides likelihood has many valleys, each of
/// them sharp: how wide they lie shows in a size that gains less than its curvature says.
fn spread(curved: f64, size: f64, gain: Option<f64>) -> f64 {
    match gain {
        // One more, for by chance a size of one standard deviation is found where there is none.
        Some(gain) if gain < WORTH_A_NAME => curved.max(size.abs() / (2.0 * gain.max(0.0) + 1.0).sqrt()),
        _ => curved,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_size_that_gains_less_than_its_curvature_says_is_less_sure() {
        // Two standard deviations gain two natural logarithms, and one by chance half of one.
        assert_eq!(spread(0.1, 0.2, Some(2.0)), 0.1);
        assert_eq!(spread(0.1, 0.05, Some(0.0)), 0.1);
        // Thirty of them that gain 12: a fifth of the size.
        assert_eq!(spread(0.1, -3.0, Some(12.0)), 0.6);
        assert_eq!(spread(0.1, 3.0, Some(-4.0)), 3.0);
        // What is named, whose windows are at their bound, and what has other numbers too.
        assert_eq!(spread(0.1, 30.0, Some(300.0)), 0.1);
        assert_eq!(spread(0.1, 3.0, None), 0.1);
    }
}

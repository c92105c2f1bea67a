//! The standard normal distribution where its tails matter: logarithms that do not underflow.

use std::f64::consts::{PI, SQRT_2};

use libm::erfc;
use statrs::function::erf::erfc_inv;

/// Below this argument erfc nears underflow in relative precision and the continued fraction has converged.
const TAIL: f64 = -6.0;

/// Terms of the continued fraction of Mills' ratio; at 6 and beyond 40 terms are exact to rounding.
const FRACTION_TERMS: u32 = 40;

/// Half widths of the intervals about the mean that hold 90 and 95 %, in standard deviations: Φ⁻¹(0.95) and Φ⁻¹(0.975).
pub const NINETY_PERCENT: f64 = 1.644_853_626_951_472_2;
/// See [`NINETY_PERCENT`].
pub const NINETY_FIVE_PERCENT: f64 = 1.959_963_984_540_054;

/// Φ(z).
pub fn cdf(z: f64) -> f64 {
    0.5 * erfc(-z / SQRT_2)
}

/// φ(z).
pub fn pdf(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

/// Φ⁻¹(p); infinite at 0 and 1, NaN outside.
pub fn quantile(p: f64) -> f64 {
    if !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    if p > 0.5 {
        // 1 - p is exact here, and the lower tail keeps its digits.
        return -quantile(1.0 - p);
    }
    let z = -SQRT_2 * erfc_inv(2.0 * p);
    // The library's inverse is good to about 1e-10; a Newton step squares that.
    if z.is_finite() { z - (cdf(z) - p) / pdf(z) } else { z }
}

/// ln Φ(z) and its derivative φ(z)/Φ(z), for any finite z.
pub fn ln_cdf(z: f64) -> (f64, f64) {
    if z > TAIL {
        let p = cdf(z);
        return (p.ln(), pdf(z) / p);
    }
    let mills = mills_ratio(-z);
    (-0.5 * z * z - 0.5 * (2.0 * PI).ln() + mills.ln(), 1.0 / mills)
}

/// Φ(-x)/φ(x) for large x as Laplace's continued fraction 1/(x + 1/(x + 2/(x + 3/(x + …)))).
fn mills_ratio(x: f64) -> f64 {
    let rest = (1..=FRACTION_TERMS).rev().fold(0.0, |rest, k| f64::from(k) / (x + rest));
    1.0 / (x + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verified_logarithms_in_the_tails() {
        // scipy.special.log_ndtr (1.17).
        let known = [
            (-40.0, -804.608_442_013_753_9),
            (-10.0, -53.231_285_150_512_48),
            (-6.0, -20.736_768_949_974_706),
            (-1.0, -1.841_021_645_009_263_7),
            (0.0, -std::f64::consts::LN_2),
            (3.0, -0.001_350_809_964_748_192_5),
        ];
        for (z, expected) in known {
            // Relative rounding of erfc, about 1e-15, and of one logarithm.
            assert!((ln_cdf(z).0 / expected - 1.0).abs() < 1e-12, "{} at {z}", ln_cdf(z).0);
        }
    }

    #[test]
    fn analytic_the_two_branches_meet_and_the_derivative_is_one() {
        let (left, right) = (ln_cdf(TAIL), ln_cdf(TAIL + 1e-12));
        // The step of 1e-12 moves the logarithm by 6e-12; rounding adds some 1e-14.
        assert!((left.0 - right.0).abs() < 1e-11 && (left.1 - right.1).abs() < 1e-10);
        for z in [-30.0, -8.0, -2.0, 0.5, 4.0] {
            let h = 1e-5;
            let slope = (ln_cdf(z + h).0 - ln_cdf(z - h).0) / (2.0 * h);
            // Rounding of values up to 450 over 2e-5.
            assert!((slope - ln_cdf(z).1).abs() < 1e-8, "{slope} at {z}");
        }
    }

    #[test]
    fn analytic_the_quantile_inverts() {
        for p in [1e-12, 0.025, 0.5, 0.84, 0.999] {
            // Rounding of p, z and erfc; in the tail a rounding of z counts z² times.
            assert!((cdf(quantile(p)) / p - 1.0).abs() < 1e-13, "{p}");
        }
        assert!(quantile(1.5).is_nan());
        for (half_width, p) in [(NINETY_PERCENT, 0.95), (NINETY_FIVE_PERCENT, 0.975)] {
            assert!((cdf(half_width) / p - 1.0).abs() < 1e-13, "{p}");
        }
    }
}

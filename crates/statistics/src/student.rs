//! Student's t where a scatter is known from few.

use statrs::distribution::{Continuous, ContinuousCDF, StudentsT};

/// Half width of the interval about the mean that holds 95 %, in estimated standard deviations.
///
/// Degrees of freedom need not be whole; with none left it is infinite.
pub fn ninety_five_percent(degrees_of_freedom: f64) -> f64 {
    // Below a twentieth of a degree it is beyond 1e20, where the inverse no longer converges.
    let t = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok().filter(|_| degrees_of_freedom > 0.05);
    t.map_or(f64::INFINITY, |t| {
        let half = t.inverse_cdf(0.975);
        // The library's inverse loses digits where degrees are many; a Newton step squares what is left.
        half - (t.cdf(half) - 0.975) / t.pdf(half)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::NINETY_FIVE_PERCENT;

    #[test]
    fn published_half_widths_are_those_of_the_tables() {
        // Tables give three digits after the point.
        for (degrees, half) in [(1.0, 12.706), (2.0, 4.303), (4.0, 2.776), (30.0, 2.042)] {
            assert!((ninety_five_percent(degrees) - half).abs() < 5e-4, "{degrees}");
        }
        // Of many degrees it is z + z (1 + z²)/(4 n), but for terms of 1/n², which are 3e-8 here.
        let z = NINETY_FIVE_PERCENT;
        assert!((ninety_five_percent(1e4) - z - z * (1.0 + z * z) / 4e4).abs() < 1e-6);
    }

    #[test]
    fn analytic_without_degrees_of_freedom_nothing_is_known() {
        assert_eq!([-1.0, 0.0, f64::NAN].map(ninety_five_percent), [f64::INFINITY; 3]);
        let rising = [0.1, 0.5, 1.0, 2.5].map(ninety_five_percent);
        assert!(rising.windows(2).all(|pair| pair[0] > pair[1]), "{rising:?}");
    }
}

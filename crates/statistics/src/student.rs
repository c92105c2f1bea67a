//! Student's t where a scatter is known from few.

use statrs::distribution::{Continuous, ContinuousCDF, StudentsT};

use crate::normal::NINETY_FIVE_PERCENT;

/// Degrees of freedom above which the first terms of the expansion about the normal distribution are exact to 1e-11. The library's inverse
/// no longer converges from some 1e7 on.
const MANY: f64 = 1e4;

/// Half width of the interval about the mean that holds 95 %, in estimated standard deviations.
///
/// Degrees of freedom need not be whole; with none left it is infinite.
pub fn ninety_five_percent(degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom > MANY {
        return of_many(degrees_of_freedom);
    }
    // Below a twentieth of a degree it is beyond 1e20, where the inverse no longer converges.
    let t = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok().filter(|_| degrees_of_freedom > 0.05);
    t.map_or(f64::INFINITY, |t| {
        let half = t.inverse_cdf(0.975);
        // The library's inverse loses digits where degrees are many; a Newton step squares what is left.
        half - (t.cdf(half) - 0.975) / t.pdf(half)
    })
}

/// Abramowitz and Stegun, "Handbook of mathematical functions" (1964), 26.7.5, up to the square of one over the degrees.
fn of_many(degrees_of_freedom: f64) -> f64 {
    let (z, share) = (NINETY_FIVE_PERCENT, 1.0 / degrees_of_freedom);
    let square = z * z;
    let first = z * (square + 1.0) / 4.0;
    let second = z * ((5.0 * square + 16.0) * square + 3.0) / 96.0;
    z + share * (first + share * second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_half_widths_are_those_of_the_tables() {
        // Tables give three digits after the point.
        for (degrees, half) in [(1.0, 12.706), (2.0, 4.303), (4.0, 2.776), (30.0, 2.042)] {
            assert!((ninety_five_percent(degrees) - half).abs() < 5e-4, "{degrees}");
        }
    }

    #[test]
    fn analytic_of_many_degrees_it_is_that_of_the_normal_distribution_however_many() {
        // By the library on one side and by the expansion on the other.
        let ends = [MANY, MANY.next_up()].map(ninety_five_percent);
        assert!((ends[0] - ends[1]).abs() < 1e-11, "{ends:?}");
        let all = [2e4, 1e7, 5e7, 1e12, 1e300, f64::INFINITY].map(ninety_five_percent);
        assert!(all.windows(2).all(|pair| pair[0] >= pair[1]), "{all:?}");
        assert_eq!(all[5], NINETY_FIVE_PERCENT);
    }

    #[test]
    fn analytic_without_degrees_of_freedom_nothing_is_known() {
        assert_eq!([-1.0, 0.0, f64::NAN].map(ninety_five_percent), [f64::INFINITY; 3]);
        let rising = [0.1, 0.5, 1.0, 2.5].map(ninety_five_percent);
        assert!(rising.windows(2).all(|pair| pair[0] > pair[1]), "{rising:?}");
    }
}

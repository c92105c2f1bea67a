//! Quantiles of rotations among which some are collapses.
//!
//! A collapsed wall has no largest rotation, only one larger than that of any wall that stood. It therefore ranks
//! above all of them, and a quantile that lands among collapsed runs does not exist as a number.

use mrbd_statistics::censored_quantile;

/// Levels of the quantiles that are kept.
pub const LEVELS: [f64; 7] = [0.05, 0.16, 0.25, 0.50, 0.75, 0.84, 0.95];

/// Position of the median in [`LEVELS`].
pub(super) const MEDIAN: usize = 3;

/// Quantiles at [`LEVELS`] of the values of walls that stood, in increasing order, and of `collapsed` more above them.
///
/// Linear between order statistics at q (n - 1), the rule of numpy and R's type 7. `None` where a statistic with any
/// weight is a collapse: no infinity stands in for it, so none can cancel another.
pub fn quantiles(standing: &[f64], collapsed: usize) -> [Option<f64>; 7] {
    LEVELS.map(|level| censored_quantile(standing, collapsed, level))
}

/// The median of values in increasing order and of `collapsed` more above them, by the same rule.
///
/// `None` of nothing, and where it lands among collapses or between a value and one.
pub fn median(standing: &[f64], collapsed: usize) -> Option<f64> {
    censored_quantile(standing, collapsed, LEVELS[MEDIAN])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEVEN: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

    #[test]
    fn published_type_7_of_seven_values() {
        // numpy.quantile(range(1, 8), …) = 1 + 6 q.
        for (level, value) in LEVELS.iter().zip(quantiles(&SEVEN, 0)) {
            let value = value.expect("no collapses");
            assert!((value - (1.0 + 6.0 * level)).abs() < 1e-14, "rounding only: {value} at {level}");
        }
    }

    #[test]
    fn analytic_collapses_rank_above_all_and_are_no_number() {
        // Three of seven collapsed: the median is the largest that stood, everything above does not exist.
        let values = quantiles(&SEVEN[..4], 3);
        assert_eq!(values[MEDIAN], Some(4.0));
        assert!(values[..MEDIAN].iter().all(Option::is_some));
        assert!(values[MEDIAN + 1..].iter().all(Option::is_none));
        assert_eq!(quantiles(&SEVEN[..3], 4)[MEDIAN], None);
        assert_eq!(quantiles(&[], 7), [None; 7]);
    }

    #[test]
    fn analytic_a_median_between_standing_and_collapsed_does_not_exist() {
        assert_eq!(quantiles(&SEVEN[..1], 1)[MEDIAN], None);
        assert_eq!(quantiles(&SEVEN[..2], 0)[MEDIAN], Some(1.5));
        assert_eq!((median(&SEVEN[..1], 1), median(&SEVEN[..2], 0)), (None, Some(1.5)));
    }

    #[test]
    fn rejects_to_make_a_quantile_of_nothing() {
        assert_eq!(quantiles(&[], 0), [None; 7]);
    }
}

//! Order statistics and correlations.
//!
//! An order statistic is `None` of no values, and of values among which one is NaN: a number that is missing has no rank.
//! Infinities have theirs.

/// The quantile at a share from 0 to 1: linear between order statistics at `share` (n - 1), type 7 of R and numpy.
///
/// ```
/// assert_eq!(mrbd_statistics::quantile(&[3.0, 1.0, 2.0, 10.0], 0.75), Some(4.75));
/// ```
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    censored_quantile(&sorted(values)?, 0, share)
}

/// The median: of an even number of values the middle between the two in the middle.
///
/// ```
/// assert_eq!(mrbd_statistics::median(&[3.0, 1.0, 2.0, 10.0]), Some(2.5));
/// ```
pub fn median(values: &[f64]) -> Option<f64> {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        return None;
    }
    // Selecting takes time in proportion to the number of values, sorting more: searches ask for many medians.
    let mut values = values.to_vec();
    let (middle, is_even) = (values.len() / 2, values.len().is_multiple_of(2));
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().reduce(f64::max).filter(|_| is_even);
    Some(between(lower.unwrap_or(upper), upper, 0.5))
}

/// The quantile of values in increasing order, none of them NaN, and of `above` more that are no numbers but rank above
/// all of them, as collapsed walls do; `None` where one of these has any weight.
pub fn censored_quantile(increasing: &[f64], above: usize, share: f64) -> Option<f64> {
    let last = (increasing.len() + above).checked_sub(1)?;
    let rank = share * last as f64;
    // Of what is not negative this cuts the fraction off, without the call of a library that `floor` is on older processors.
    let below = rank as usize;
    let weight = rank - below as f64;
    let lower = *increasing.get(below)?;
    // Without weight the next value need not be a number.
    let upper = if weight == 0.0 { lower } else { *increasing.get(below + 1)? };
    Some(between(lower, upper, weight))
}

/// A share of the way from one value to another; two infinite ones of a sign are one value.
fn between(lower: f64, upper: f64, share: f64) -> f64 {
    if lower == upper { lower } else { lower + share * (upper - lower) }
}

/// Values in increasing order; `None` if one is NaN.
fn sorted(values: &[f64]) -> Option<Vec<f64>> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.iter().all(|value| !value.is_nan()).then_some(sorted)
}

/// Correlation of two variables over vectors; `None` where one does not vary.
pub fn correlation(vectors: &[Vec<f64>], i: usize, j: usize) -> Option<f64> {
    let n = vectors.len() as f64;
    let mean = |v: usize| vectors.iter().map(|x| x[v]).sum::<f64>() / n;
    let (mean_i, mean_j) = (mean(i), mean(j));
    let sum =
        |a: usize, ma: f64, b: usize, mb: f64| vectors.iter().map(|x| (x[a] - ma) * (x[b] - mb)).sum::<f64>();
    let r = sum(i, mean_i, j, mean_j) / (sum(i, mean_i, i, mean_i) * sum(j, mean_j, j, mean_j)).sqrt();
    r.is_finite().then_some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verified_quantiles_of_type_7() {
        // numpy 2.4: quantile([7, 15, 36, 39, 40, 41], …), of which the products are exact or rounded once.
        let values = [39.0, 7.0, 40.0, 15.0, 41.0, 36.0];
        for (share, expected) in
            [(0.0, 7.0), (0.1, 11.0), (0.25, 20.25), (0.5, 37.5), (0.75, 39.75), (1.0, 41.0)]
        {
            assert_eq!(quantile(&values, share), Some(expected), "{share}");
        }
    }

    #[test]
    fn analytic_the_median_of_an_even_number_lies_in_the_middle() {
        assert_eq!(median(&[4.0, 1.0]), Some(2.5));
        assert_eq!(median(&[4.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(median(&[f64::INFINITY, 1.0, f64::NEG_INFINITY]), Some(1.0));
        assert_eq!(median(&[f64::INFINITY; 2]), Some(f64::INFINITY));
    }

    #[test]
    fn rejects_no_values_and_values_that_are_missing() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[1.0, f64::NAN, 2.0]), None);
        // NaN with its sign set sorts first, not last.
        assert_eq!(quantile(&[1.0, -f64::NAN, 2.0], 1.0), None);
    }

    #[test]
    fn analytic_what_ranks_above_all_is_no_number() {
        assert_eq!(censored_quantile(&[1.0, 2.0], 1, 0.5), Some(2.0));
        assert_eq!(censored_quantile(&[1.0, 2.0], 2, 0.5), None);
        assert_eq!(censored_quantile(&[], 3, 0.0), None);
    }

    #[test]
    fn analytic_correlations_of_a_line_and_of_a_constant() {
        let line = [[0.0, 5.0, 1.0], [1.0, 3.0, 1.0], [2.0, 1.0, 1.0]].map(|x| x.to_vec());
        assert_eq!(correlation(&line, 0, 1), Some(-1.0));
        assert_eq!(correlation(&line, 0, 2), None);
    }
}

//! Confidence intervals from bootstrap replicates, some of which may tell no fragility.

use statrs::distribution::{ContinuousCDF, StudentsT};

use mrbd_statistics::normal;

/// A confidence interval; a bound the data do not set is none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Interval {
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
}

/// Values of one parameter over the replicates.
#[derive(Debug, Clone, PartialEq)]
pub struct Replicates {
    sorted: Vec<f64>,
    unknown: usize,
}

impl Replicates {
    /// The replicates' values; none for those that told no fragility.
    pub fn new(values: impl IntoIterator<Item = Option<f64>>) -> Self {
        let mut unknown = 0;
        let known = values.into_iter().filter_map(|value| {
            unknown += usize::from(value.is_none());
            value
        });
        let mut sorted: Vec<f64> = known.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        Self { sorted, unknown }
    }

    /// Number of replicates without a value.
    pub fn unknown(&self) -> usize {
        self.unknown
    }

    /// Percentile interval at a confidence level (Efron & Tibshirani 1993, Eq. 13.5).
    pub fn percentile(&self, level: f64) -> Interval {
        let tail = 0.5 * (1.0 - level);
        Interval { lower: self.lower(tail), upper: self.upper(1.0 - tail) }
    }

    /// Bias-corrected and accelerated interval (Efron & Tibshirani 1993, Eq. 14.9 to 14.15).
    ///
    /// `estimate` is the value of the data, `left_out` its values with each cluster left out. None where every
    /// replicate lies on one side of the estimate, or where leaving out a cluster leaves no fragility.
    pub fn bias_corrected(
        &self,
        estimate: f64,
        left_out: &[Vec<Option<f64>>],
        level: f64,
    ) -> Option<Interval> {
        let below = self.sorted.iter().filter(|&&value| value < estimate).count() as f64;
        let equal = self.sorted.iter().filter(|&&value| value == estimate).count() as f64;
        let bias = normal::quantile((below + 0.5 * equal) / self.sorted.len() as f64);
        let acceleration = acceleration(left_out)?;
        let corrected = |p: f64| {
            let z = bias + normal::quantile(p);
            normal::cdf(bias + z / (1.0 - acceleration * z))
        };
        let tail = 0.5 * (1.0 - level);
        let (low, high) = (corrected(tail), corrected(1.0 - tail));
        // An acceleration so strong that the bounds change places has no meaning.
        (bias.is_finite() && low < high).then(|| Interval { lower: self.lower(low), upper: self.upper(high) })
    }

    /// Quantile with every unknown replicate below all values, so that it is never too high.
    fn lower(&self, p: f64) -> Option<f64> {
        self.quantile(p, self.unknown)
    }

    /// Quantile with every unknown replicate above all values, so that it is never too low.
    fn upper(&self, p: f64) -> Option<f64> {
        self.quantile(p, 0)
    }

    /// Quantile at rank p (n + 1), linear between neighbours; none where it lands outside the values.
    fn quantile(&self, p: f64, below: usize) -> Option<f64> {
        let count = self.sorted.len() + self.unknown;
        if count == 0 {
            return None;
        }
        let rank = (p * (count + 1) as f64).clamp(1.0, count as f64) - 1.0;
        let at = |i: usize| i.checked_sub(below).and_then(|i| self.sorted.get(i)).copied();
        let (floor, weight) = (rank.floor() as usize, rank.fract());
        let first = at(floor)?;
        if weight == 0.0 { Some(first) } else { Some(first + weight * (at(floor + 1)? - first)) }
    }
}

/// The level to take percentiles at so that intervals over `clusters` hold at `level`; none for fewer than two.
///
/// A bootstrap of few clusters scatters by √((n - 1)/n) too little and has normal tails where a t has wider ones:
/// tails of Φ(-√(n/(n - 1)) t) make up for both (Hesterberg 2015, "What teachers should know about the bootstrap",
/// The American Statistician 69(4), section 3.3).
pub fn expanded_level(level: f64, clusters: usize) -> Option<f64> {
    let degrees = clusters.checked_sub(1).filter(|&degrees| degrees > 0)? as f64;
    let t = StudentsT::new(0.0, 1.0, degrees).ok()?.inverse_cdf(0.5 + 0.5 * level);
    Some(1.0 - 2.0 * normal::cdf(-((degrees + 1.0) / degrees).sqrt() * t))
}

/// Acceleration Σd³ / (6 (Σd²)^1.5) with d the mean minus each value left out, over all kinds of clusters.
fn acceleration(left_out: &[Vec<Option<f64>>]) -> Option<f64> {
    let (mut squares, mut cubes) = (0.0, 0.0);
    for kind in left_out {
        let values: Vec<f64> = kind.iter().copied().collect::<Option<_>>()?;
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        squares += values.iter().map(|v| (mean - v).powi(2)).sum::<f64>();
        cubes += values.iter().map(|v| (mean - v).powi(3)).sum::<f64>();
    }
    let acceleration = cubes / (6.0 * squares.powf(1.5));
    acceleration.is_finite().then_some(acceleration)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_to_999() -> Vec<f64> {
        (1..1000).map(f64::from).collect()
    }

    fn assert_near(found: Interval, lower: f64, upper: f64) {
        let [low, high] = [found.lower, found.upper].map(|bound| bound.expect("a bound"));
        // 1 - 0.95 is rounded, and a rank is a thousand times as much.
        assert!((low - lower).abs() < 1e-12 && (high - upper).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn analytic_percentiles_of_whole_numbers() {
        let replicates = Replicates::new(one_to_999().into_iter().rev().map(Some));
        // Ranks 25 and 975 of 999 + 1.
        assert_near(replicates.percentile(0.95), 25.0, 975.0);
    }

    #[test]
    fn analytic_unknown_replicates_widen_until_nothing_is_known() {
        let with = |unknown: usize| {
            let values = one_to_999().into_iter().skip(unknown).map(Some);
            Replicates::new(values.chain(std::iter::repeat_n(None, unknown))).percentile(0.95)
        };
        // Ten replaced: the lower bound skips them, the upper one counts them above.
        assert_near(with(10), 25.0, 985.0);
        assert_eq!(with(30), Interval { lower: None, upper: None });
    }

    #[test]
    fn analytic_no_bias_and_no_skewness_is_the_percentile_interval() {
        let replicates = Replicates::new(one_to_999().into_iter().map(Some));
        let left_out = vec![vec![Some(1.0), Some(2.0), Some(3.0)]];
        let corrected = replicates.bias_corrected(500.0, &left_out, 0.95).expect("exists");
        let (lower, upper) = (corrected.lower.expect("a bound"), corrected.upper.expect("a bound"));
        // Φ(Φ⁻¹(p)) returns p within 1e-12, and a rank is 1000 p.
        assert!((lower - 25.0).abs() < 1e-8 && (upper - 975.0).abs() < 1e-8, "{corrected:?}");
        // Replicates mostly below the estimate move both bounds up.
        let moved = replicates.bias_corrected(600.0, &left_out, 0.95).expect("exists");
        assert!(moved.lower > corrected.lower && moved.upper > corrected.upper);
    }

    #[test]
    fn published_expanded_levels_for_few_clusters() {
        // t_{0.975} is 2.5706 with 5 degrees and 2.0930 with 19: 2 Φ(-2.8160) and 2 Φ(-2.1474).
        for (clusters, tails) in [(6, 0.004_863), (20, 0.031_763)] {
            let level = expanded_level(0.95, clusters).expect("enough clusters");
            // The quantiles are tabulated with five digits.
            assert!((1.0 - level - tails).abs() < 2e-5, "{level} for {clusters}");
        }
        assert_eq!(expanded_level(0.95, 1), None);
        let many = expanded_level(0.95, 1_000_000).expect("enough clusters");
        // The correction falls as 1/n.
        assert!((many - 0.95).abs() < 1e-5);
    }

    #[test]
    fn rejects_a_correction_it_cannot_make() {
        let replicates = Replicates::new(one_to_999().into_iter().map(Some));
        let left_out = vec![vec![Some(1.0), Some(2.0), Some(4.0)]];
        assert!(replicates.bias_corrected(0.0, &left_out, 0.95).is_none(), "all on one side");
        assert!(replicates.bias_corrected(500.0, &[vec![Some(1.0), None]], 0.95).is_none());
        assert_eq!(Replicates::new([]).percentile(0.95), Interval::default());
    }
}

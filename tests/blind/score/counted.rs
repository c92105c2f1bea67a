//! Shares of cases with their binomial intervals.

use statrs::distribution::{Beta, ContinuousCDF};

/// In the place of a share where there is nothing to count.
pub const NO_CASES: &str = "no cases";

/// So many of so many.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counted {
    pub hits: usize,
    pub of: usize,
}

impl Counted {
    /// How many of the items are so.
    pub fn of<T>(items: impl IntoIterator<Item = T>, is_so: impl Fn(&T) -> bool) -> Self {
        items.into_iter().fold(Self::default(), |counted, item| Self {
            hits: counted.hits + usize::from(is_so(&item)),
            of: counted.of + 1,
        })
    }

    /// The share; none of none.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.hits as f64 / self.of as f64)
    }

    /// The 95 % interval of Clopper and Pearson (1934).
    pub fn interval(self) -> [f64; 2] {
        let (k, n) = (self.hits as f64, self.of as f64);
        let quantile =
            |a: f64, b: f64, p: f64| Beta::new(a, b).expect("positive shape parameters").inverse_cdf(p);
        let low = if self.hits == 0 { 0.0 } else { quantile(k, n - k + 1.0, 0.025) };
        let high = if self.hits == self.of { 1.0 } else { quantile(k + 1.0, n - k, 0.975) };
        [low, high]
    }

    /// `93 % (88 to 96), 28 of 30`.
    pub fn told(self) -> String {
        let Some(share) = self.share() else { return NO_CASES.into() };
        let [low, high] = self.interval().map(|p| 100.0 * p);
        format!("{:.0} % ({low:.0} to {high:.0}), {} of {}", 100.0 * share, self.hits, self.of)
    }
}

//! What speaks for another law than the one that is about to be named, though it closes the gap.

use serde::{Deserialize, Serialize};

use super::amplitude::{Trend, trends_with_amplitude};
use super::names;
use crate::diagnose::force::{curve_left, force_points};
use crate::diagnose::trials::{Data, Tried};
use crate::limits::{BENT_FORCE, TREND_NATS, TREND_SHARE};

/// Signs of a law outside the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OtherLaw {
    /// The effects it would be taken for.
    pub looks_like: Vec<String>,
    /// See [`curve_left`].
    pub curve_left: Option<f64>,
    /// How a size differs in large motion, and what that gains: of the sizes that differ by more than 4 %, or else of
    /// all, that which gains most.
    pub trend_with_amplitude: Option<Trend>,
}

impl OtherLaw {
    /// Looks at a fitted hypothesis.
    pub fn beside(data: &Data, named: &Tried) -> Self {
        let physics = named.hypothesis.physics(&named.fit.values);
        let points = physics.map(|physics| force_points(data.fit.tests, &physics));
        Self {
            looks_like: names(named),
            curve_left: points.and_then(|points| curve_left(&points)),
            trend_with_amplitude: trends_with_amplitude(data, named).and_then(largest),
        }
    }

    /// Whether the law cannot be the named one.
    pub fn speaks(&self) -> bool {
        let bent = self.curve_left.is_some_and(|found| found > BENT_FORCE);
        bent || self
            .trend_with_amplitude
            .is_some_and(|trend| trend.nats > TREND_NATS && trend.share > TREND_SHARE)
    }
}

fn largest(trends: Vec<Trend>) -> Option<Trend> {
    let clear = |trend: &Trend| trend.share > TREND_SHARE;
    trends.into_iter().max_by(|a, b| clear(a).cmp(&clear(b)).then(a.nats.total_cmp(&b.nats)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speaks(trends: &[(f64, f64)]) -> bool {
        let trends = trends.iter().map(|&(nats, share)| Trend { nats, share }).collect();
        OtherLaw { looks_like: Vec::new(), curve_left: None, trend_with_amplitude: largest(trends) }.speaks()
    }

    #[test]
    fn analytic_a_trend_speaks_where_it_is_both_sure_and_large() {
        assert!(speaks(&[(240.0, 0.56)]));
        assert!(!speaks(&[(51.0, 0.004)]) && !speaks(&[(9.0, 0.5)]) && !speaks(&[]));
        // Of two numbers, the one that is surer does not hide the other.
        assert!(speaks(&[(100.0, 0.01), (40.0, 0.3)]));
    }
}

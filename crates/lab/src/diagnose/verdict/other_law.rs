//! What speaks for another law than the one that is about to be named, though it closes the gap.

use serde::{Deserialize, Serialize};

use super::amplitude::{Trend, trends_with_amplitude};
use super::names;
use crate::diagnose::force::{curve_left, force_points};
use crate::diagnose::trials::{Data, Tried};

/// Squared standard deviations of the force left at the top that a bend with velocity may explain beside a named effect.
/// Right names leave 6 and less, once 28; friction under stiff corners left 63 and 73, and is not named; a quadratic drag called
/// a damper leaves 101 and 400, a loose mass 169.
const BENT: f64 = 50.0;
/// Gain in natural logarithms of likelihood that a trend of a named size with the amplitude may have. Right names have 9 and
/// less, but at a noise of 1e-5 rad 27, 51 and 57; damping that grows with displacement called
/// a damper, or a damper with other impacts, 37, 55 and 313; a spring that saturates called a cubic one 274.
const TREND: f64 = 25.0;
/// Share of its size by which a named size may differ in large motion: right names that gain so much have 0.4 to 2 % (the finer
/// points of a contact), a spring that saturates called a cubic one 8 %, a quadratic drag called a damper 56 %.
const TREND_SHARE: f64 = 0.04;

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
        let bent = self.curve_left.is_some_and(|found| found > BENT);
        bent || self.trend_with_amplitude.is_some_and(|trend| trend.nats > TREND && trend.share > TREND_SHARE)
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

//! What speaks for another law than the one that is about to be named, though it closes the gap.

use serde::Serialize;

use super::amplitude::trend_with_amplitude;
use super::force::{curve_left, force_points};
use super::search::{Data, Tried};
use super::verdict::names;

/// Squared standard deviations of the force left at the top that a bend with velocity may explain beside a named effect.
/// Right names leave 6 and less, once 28; a quadratic drag called a damper 101 and 400, a loose mass 169.
const BENT: f64 = 50.0;
/// Gain in natural logarithms of likelihood that a trend of a named size with the amplitude may have. Right names have 9 and
/// less, once 27; damping that grows with displacement called a damper, or a damper with other impacts, 37, 55 and 313.
const TREND: f64 = 32.0;

/// Signs of a law outside the catalogue.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherLaw {
    /// The effects it would be taken for.
    pub looks_like: Vec<String>,
    /// See [`curve_left`].
    pub curve_left: Option<f64>,
    /// See [`trend_with_amplitude`].
    pub trend_with_amplitude_nats: Option<f64>,
}

impl OtherLaw {
    /// Looks at a fitted hypothesis.
    pub fn beside(data: &Data, named: &Tried) -> Self {
        let physics = named.hypothesis.physics(&named.fit.values);
        let points = physics.map(|physics| force_points(data.fit.tests, &physics));
        Self {
            looks_like: names(named),
            curve_left: points.and_then(|points| curve_left(&points)),
            trend_with_amplitude_nats: trend_with_amplitude(data, named),
        }
    }

    /// Whether the law cannot be the named one.
    pub fn speaks(&self) -> bool {
        let beyond = |found: Option<f64>, limit: f64| found.is_some_and(|found| found > limit);
        beyond(self.curve_left, BENT) || beyond(self.trend_with_amplitude_nats, TREND)
    }
}

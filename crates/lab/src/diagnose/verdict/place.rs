//! Where a force is missing that no law of the catalogue follows.

use crate::diagnose::trials::{Data, Tried, against, joint_error, kinds};
use crate::limits::{PLACE_NATS, PLACE_SQUARED_ERROR};

/// What a hypothesis leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Left {
    /// What speaks against it, in natural logarithms of likelihood.
    nats: f64,
    /// Its windowed error, in standard deviations of the noise.
    error: f64,
}

impl Left {
    fn of(data: &Data, tried: &Tried) -> Option<Self> {
        Some(Self { nats: against(data, tried), error: joint_error(tried)? })
    }

    /// Whether another hypothesis takes away a good part of it.
    fn shrinks_to(self, best: Self) -> bool {
        let of_nats = (self.nats - best.nats) / self.nats;
        let excess = |error: f64| error * error - 1.0;
        let of_squared_error = 1.0 - excess(best.error) / excess(self.error);
        of_nats > PLACE_NATS || (self.error > 1.0 && of_squared_error > PLACE_SQUARED_ERROR)
    }
}

/// The place whose effects take away a good part of what speaks against the wall, if there is one.
pub fn place(data: &Data, recalibrated: &Tried, tried: &[Tried]) -> Option<&'static str> {
    let answers = tried.iter().filter(|t| kinds(t).is_some());
    let best = answers.min_by(|a, b| against(data, a).total_cmp(&against(data, b)))?;
    let shrinks = Left::of(data, recalibrated)?.shrinks_to(Left::of(data, best)?);
    shrinks.then(|| best.hypothesis.additions[0].place())
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn left(nats: f64, error: f64) -> Left {
        Left { nats, error }
    }

    #[test]
    fn analytic_a_place_shows_by_likelihood_or_where_that_is_at_its_bound_by_error() {
        // 31 and 29 % of the logarithms.
        assert!(left(1000.0, 1.2).shrinks_to(left(690.0, 1.19)));
        assert!(!left(1000.0, 1.2).shrinks_to(left(710.0, 1.19)));
        // Far above the noise: from 12² to 8² − 55 %, and to 9² − 44 %.
        assert!(left(10_700.0, 12.0).shrinks_to(left(10_000.0, 8.0)));
        assert!(!left(10_700.0, 12.0).shrinks_to(left(10_000.0, 9.0)));
        // No more than noise, by error: nothing to take away, and no share of it.
        assert!(!left(300.0, 0.99).shrinks_to(left(290.0, 0.97)));
        assert!(!left(300.0, 0.99).shrinks_to(left(290.0, 0.999)));
    }
}

//! Laws that are told with round exponents, with these set free: how far from round they may be.
//!
//! A law with a round exponent is told where the same with another does no better. That is no measurement of the exponent: at 3e-4 rad a
//! damper told as |v|^1.5 may go with |v|^1.6 as well, and the interval of its coefficient supposes the round one.

use super::equals::law_of;
use crate::Progress;
use crate::diagnose::formula::{Atom, Law};
use crate::diagnose::trials::{FittedHypothesis, Trials, refit};

impl<P: Progress> Trials<'_, P> {
    /// A law that is told with round exponents, fitted on from there with these free. `None` of one that has none, and where such a fit
    /// takes more work than it may.
    pub fn with_exponents_free(&self, told: &FittedHypothesis) -> Option<FittedHypothesis> {
        let law = freed(&law_of(told)?)?;
        let (hypothesis, values) = self.law_beside(told, &law);
        self.within_budget(&law.name(), values.len(), |data| refit(data, hypothesis, told, &values))
    }
}

/// A law with exponents free that stand as round ones; `None` where none does.
pub fn freed(law: &Law) -> Option<Law> {
    let free = law.map(|_, atom| Atom { is_exact: false, ..atom });
    (free.slots().len() > law.slots().len()).then_some(free)
}

#[cfg(test)]
mod tests {
    use super::super::twin::{DRAG, DRAG_N, Twin, drag, wall_with};
    use super::*;
    use crate::diagnose::certainty::intervals;
    use crate::diagnose::formula::Shape;

    #[test]
    fn analytic_round_exponents_alone_are_set_free() {
        let round = |shape: Shape, n: f64| {
            Law::of(Atom { shape, is_exact: true, numbers: [n, 0.0], ..drag(n, DRAG_N).first })
        };
        assert!(freed(&round(Shape::Drag, 1.5)).is_some());
        assert!(freed(&drag(1.5, DRAG_N)).is_none(), "free already");
        assert!(freed(&round(Shape::Saturation, 0.5)).is_none(), "it has no exponent");
        assert!(freed(&round(Shape::Drag, 0.0)).is_none(), "friction stays friction");
    }

    #[test]
    fn analytic_an_exponent_set_free_stays_near_the_true_one_and_is_less_sure_where_noise_is_larger() {
        let width = |noise_rad: f64| {
            let twin = Twin::new(&wall_with(DRAG), noise_rad);
            let trials = twin.trials();
            let wall = trials.wall_fits(None).expect("windows").recalibrated;
            let two = Law::of(Atom { is_exact: true, ..drag(2.0, DRAG_N).first });
            let (h, values) = trials.law_beside(&wall, &two);
            let told = refit(&trials.data, h, &wall, &values).expect("a fit");
            let free = trials.with_exponents_free(&told).expect("a round exponent");
            let n = free.hypothesis.unknowns.len() - 1;
            let [low, high] = intervals(&trials.data, &free)[n];
            assert!((low..=high).contains(&2.0), "{low} to {high} at {noise_rad} rad");
            high - low
        };
        let [quiet, loud] = [1e-5, 1e-4].map(width);
        // A fifth of the way to the next round exponent; ten times the noise widens less what single tests pull.
        assert!(quiet < 0.1 && loud > 3.0 * quiet, "{quiet} and {loud}");
    }
}

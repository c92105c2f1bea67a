//! Laws that are told with round exponents, with these set free: whether they are round, and how far from it they may be.
//!
//! A law with a round exponent is told where the same with another does no better. That is no measurement of the exponent: at 3e-4 rad a
//! damper told as |v|^1.5 may go with |v|^1.6 as well, and the interval of its coefficient supposes the round one.
//!
//! What parts the two is often less than what valleys of windows do in which a fit ends. So both are fitted again from about themselves
//! where the free one seems to do better.

use super::asked::{AskedOfLaws, OpenGap};
use super::equals::law_of;
use super::fitted::{Fitted, exact_law};
use super::search::Searched;
use crate::Progress;
use crate::diagnose::certainty::intervals;
use crate::diagnose::formula::{Atom, Law, leaves_exponents_open};
use crate::diagnose::trials::{FittedHypothesis, Trials, against, refit};
use crate::limits::{EQUIVALENT, EXPONENT_SEEMS, EXPONENT_SHOWS};

impl<P: Progress> Trials<'_, P> {
    /// Laws that hold, the simplest first: that with its exponents free where these show, and the others that cannot be told from it then.
    pub(super) fn with_exponents_that_show(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        equals: Vec<Fitted>,
        asked: &impl AskedOfLaws,
    ) -> Vec<Fitted> {
        let told = equals.first().filter(|one| one.moved.is_none());
        let free = told.and_then(|told| self.free_where_it_shows(&told.law));
        let holds = |free: &Fitted| self.guards(gap, searched, free, None, asked).is_empty();
        let Some(free) = free.filter(holds) else { return equals };
        let limit = against(&self.data, &free.law) + EQUIVALENT;
        let others = equals.into_iter().skip(1).filter(|one| against(&self.data, one.judged()) < limit);
        std::iter::once(free).chain(others).collect()
    }

    /// A law with its round exponents free where windows say so: that seems to do better, and does once both are fitted again; or with those
    /// that tests held out tell.
    fn free_where_it_shows(&self, told: &FittedHypothesis) -> Option<Fitted> {
        let free = self.with_exponents_free(told)?;
        if self.gain(told, &free) < EXPONENT_SEEMS {
            return self.with_exponents_of_held_out(told, &free);
        }
        let (round, free) = rayon::join(|| self.refined(told.clone()), || self.refined(free));
        let shows = self.gain(&round, &free) > EXPONENT_SHOWS;
        shows.then(|| Fitted { is_refined: true, ..Fitted::new(free) })
    }

    /// A law with other exponents, where the tests fitted leave open which of the round ones it has and those held out do not: round ones if
    /// these are near. Its numbers are of the tests fitted.
    fn with_exponents_of_held_out(&self, told: &FittedHypothesis, free: &FittedHypothesis) -> Option<Fitted> {
        let intervals = intervals(&self.data, free);
        let own = &intervals[free.hypothesis.nuisances..];
        if !leaves_exponents_open(&law_of(free)?, own) {
            return None;
        }
        let all = self.moved_in_what_is_open(free)?;
        if self.gain(told, &all) < EQUIVALENT {
            return None;
        }
        let law = exact_law(&all).or_else(|| law_of(&all))?;
        if law.name() == law_of(told)?.name() {
            return None;
        }
        let (h, values) = self.law_beside(&all, &law);
        let found = self.within_budget(&law.name(), values.len(), |data| refit(data, h, &all, &values))?;
        (self.gain(told, &found) > EQUIVALENT).then(|| Fitted::new(found))
    }

    /// What a law says more than another, in natural logarithms of likelihood.
    fn gain(&self, one: &FittedHypothesis, other: &FittedHypothesis) -> f64 {
        against(&self.data, one) - against(&self.data, other)
    }

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
    use crate::diagnose::formula::{Shape, Site};

    /// A drag that goes with a power of velocity.
    fn dragging(n: f64) -> String {
        let drag = DRAG.replace("v*abs(v)", &format!("sign(v)*abs(v)**{n}"));
        assert!(drag != DRAG);
        drag.replace("(s/m)**2", &format!("(s/m)**{n}"))
    }

    /// A law with round exponents as tests tell it.
    fn told(trials: &Trials<()>, law: Law) -> FittedHypothesis {
        let wall = trials.wall_fits(None).expect("windows").recalibrated;
        let (h, values) = trials.law_beside(&wall, &law.map(|_, atom| Atom { is_exact: true, ..atom }));
        refit(&trials.data, h, &wall, &values).expect("a fit")
    }

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
            let free =
                trials.with_exponents_free(&told(&trials, drag(2.0, DRAG_N))).expect("a round exponent");
            let n = free.hypothesis.unknowns.len() - 1;
            let [low, high] = intervals(&trials.data, &free)[n];
            assert!((low..=high).contains(&2.0), "{low} to {high} at {noise_rad} rad");
            high - low
        };
        let [quiet, loud] = [1e-5, 1e-4].map(width);
        // A fifth of the way to the next round exponent; ten times the noise widens less what single tests pull.
        assert!(quiet < 0.1 && loud > 3.0 * quiet, "{quiet} and {loud}");
    }

    #[test]
    fn analytic_an_exponent_shows_where_it_is_not_round_and_not_where_it_is() {
        let shown = |n: f64| {
            let twin = Twin::new(&wall_with(&dragging(n)), 1e-5);
            let trials = twin.trials();
            let free = trials.free_where_it_shows(&told(&trials, drag(2.0, DRAG_N)))?;
            Some(law_of(&free.law)?.first.numbers[0])
        };
        let n = shown(1.94).expect("an exponent that is not round");
        assert!((n - 1.94).abs() < 0.01, "{n}");
        assert_eq!(shown(2.0), None);
    }

    #[test]
    fn analytic_tests_held_out_tell_an_exponent_that_those_fitted_leave_open() {
        let spring = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*x**5\"\n\
                      [effects.parameters]\nk = { value = 1e8, unit = \"N/m**5\" }\n";
        let twin = Twin::farthest_held_out(&wall_with(spring), 1e-4);
        let trials = twin.trials();
        let power = |n: f64| {
            let shape = Shape::Spring;
            told(&trials, Law::of(Atom { site: Site::Top, shape, numbers: [n, 0.0], ..drag(n, 500.0).first }))
        };
        let told = |n: f64| {
            let round = power(n);
            let free = trials.with_exponents_free(&round).expect("a round exponent");
            let found = trials.with_exponents_of_held_out(&round, &free)?;
            Some(law_of(&found.law)?.first.numbers[0])
        };
        assert_eq!(told(3.0), Some(5.0));
        assert_eq!(told(5.0), None);
    }
}

//! What was found: the verdict, the walls that it compares, and everything that was tried.

use super::{OtherLaw, Remainder, Verdict};
use crate::diagnose::discovery::{Discovered, law_of};
use crate::diagnose::trials::{Data, FittedHypothesis, against, all_but_closes, is_noise, joint_error};
use crate::limits::{HELD_OUT_ERROR, NOISE_AFTER};

/// What was found in given windows.
#[derive(Debug)]
pub struct Found {
    /// The answer.
    pub verdict: Verdict,
    /// The wall as it was given.
    pub before: FittedHypothesis,
    /// Its uncertain numbers fitted.
    pub recalibrated: FittedHypothesis,
    /// The wall of the answer.
    pub after: FittedHypothesis,
    /// What cannot be told from it.
    pub equivalent: Vec<String>,
    /// Where a force is missing, when no law is named.
    pub place: Option<&'static str>,
    /// What a named effect leaves, where that is more than noise.
    pub remainder: Option<Remainder>,
    /// What speaks for another law than the best of the catalogue, where that closes the gap.
    pub other_law: Option<OtherLaw>,
    /// Laws outside the catalogue, where they were looked for and points speak of one.
    pub discovered: Option<Discovered>,
    /// Everything tried, best first.
    pub tried: Vec<FittedHypothesis>,
}

impl Found {
    /// Everything tried: effects of the catalogue, and laws outside it, best first.
    pub fn rivals<'f>(&'f self, data: &Data) -> Vec<&'f FittedHypothesis> {
        let laws = self.discovered.iter().flat_map(|discovered| &discovered.tried);
        let mut all = self.tried.iter().chain(laws).collect::<Vec<_>>();
        all.sort_by(|a, b| against(data, a).total_cmp(&against(data, b)));
        all
    }

    /// The laws outside the catalogue that are told: that of the answer, and those that cannot be told from it.
    pub fn told_laws(&self) -> Vec<&FittedHypothesis> {
        let others = self.discovered.as_ref().and_then(|found| found.equals.get(1..)).unwrap_or_default();
        let told = self.verdict.is_formula().then_some(&self.after).into_iter();
        told.flat_map(|first| std::iter::once(first).chain(others)).collect()
    }

    /// The law of one atom that the tests fitted tell, of which those held out may ask more: the one that is told, or that these alone refuse.
    pub fn asked_for_more(&self) -> Option<&FittedHypothesis> {
        if !self.verdict.is_formula() {
            return self.discovered.as_ref()?.asked_for_more();
        }
        let of_one = law_of(&self.after).is_some_and(|law| law.second.is_none());
        of_one.then_some(&self.after)
    }

    /// The best law outside the catalogue that was tried, where nothing is told and it all but closes the gap.
    pub fn nearest_of_laws_refused(&self) -> Option<&FittedHypothesis> {
        let error = joint_error(&self.before).filter(|_| self.verdict.is_left_open())?;
        let best = self.discovered.as_ref()?.tried.first()?;
        all_but_closes(best, error).then_some(best)
    }

    /// Whether nothing is said to be missing because all windows together leave noise, and the tests held out are missed: what their larger
    /// motion shows is no noise. Where windows leave more, and that only what impacts of another formulation do, these are what shows.
    pub fn says_nothing_of_what_is_held_out(&self) -> bool {
        let says_nothing = matches!(self.verdict, Verdict::None | Verdict::Recalibrated);
        says_nothing
            && is_noise(&self.after)
            && self.after.errors()[1].is_some_and(|error| error >= HELD_OUT_ERROR)
    }

    /// The same, or `unknown` where nothing would be said of what tests held out show.
    pub fn or_unknown(self) -> Self {
        match self.says_nothing_of_what_is_held_out() {
            true => Self { verdict: Verdict::Unknown, after: self.before.clone(), ..self },
            false => self,
        }
    }

    /// What the wall without effects leaves of tests fitted and held out, where nothing more is known than that it misses the latter alone.
    pub fn missed_held_out(&self) -> Option<[f64; 2]> {
        if self.verdict != Verdict::Unknown {
            return None;
        }
        let alone = |wall: &FittedHypothesis| {
            let [Some(fitted), Some(held_out)] = wall.errors() else { return None };
            (fitted < NOISE_AFTER && held_out >= HELD_OUT_ERROR).then_some([fitted, held_out])
        };
        [&self.before, &self.recalibrated].into_iter().find_map(alone)
    }

    /// A verdict where the wall was fitted so, and this law was tried in vain.
    #[cfg(test)]
    pub fn in_vain(verdict: Verdict, wall: &FittedHypothesis, law: FittedHypothesis) -> Self {
        let [before, recalibrated, after] = [wall, wall, wall].map(Clone::clone);
        Self {
            verdict,
            before,
            recalibrated,
            after,
            equivalent: Vec::new(),
            place: None,
            remainder: None,
            other_law: None,
            discovered: Some(Discovered::in_vain(vec![law])),
            tried: Vec::new(),
        }
    }

    /// The hypothesis that leaves least, where what it leaves is more than noise: that of a name with a remainder, or of all that
    /// was tried in vain.
    pub fn least_leaving(&self) -> Option<&FittedHypothesis> {
        let error = |tried: &FittedHypothesis| joint_error(tried).unwrap_or(f64::INFINITY);
        match self.verdict {
            Verdict::PlaceOnly | Verdict::Unknown => {
                let all = self.tried.iter().chain([&self.recalibrated]);
                all.min_by(|a, b| error(a).total_cmp(&error(b)))
            }
            _ => (self.remainder.is_some() || !is_noise(&self.after)).then_some(&self.after),
        }
    }

    /// The hypothesis whose wall is written: that of the answer, or the wall as given where there is none.
    pub fn kept(&self) -> &FittedHypothesis {
        match self.verdict {
            Verdict::Named
            | Verdict::Class
            | Verdict::Formula
            | Verdict::FormulaClass
            | Verdict::Curve
            | Verdict::Recalibrated => &self.after,
            _ => &self.before,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{DRAG_N, Twin, drag, wall_with};
    use crate::diagnose::fit::Fit;
    use crate::diagnose::formula::Law;

    /// A wall that leaves so much in every window fitted and held out, squared error over squared noise.
    fn leaving([fitted, held_out]: [f64; 2]) -> FittedHypothesis {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let mut tried = twin.trials().wall_fits(None).expect("windows").recalibrated;
        for (side, reduced) in [(&mut tried.fit, fitted), (&mut tried.held_out, held_out)] {
            side.windows.iter_mut().for_each(|window| window.squares = reduced * window.freedom);
        }
        tried
    }

    #[test]
    fn analytic_the_nearest_law_is_one_that_all_but_closes_a_gap_of_which_nothing_is_told() {
        let wall = leaving([100.0; 2]);
        let found = |verdict: Verdict, left: f64| Found::in_vain(verdict, &wall, leaving([left; 2]));
        for open in [Verdict::PlaceOnly, Verdict::Unknown, Verdict::Curve] {
            assert!(found(open, 1.0).nearest_of_laws_refused().is_some());
        }
        assert!(found(Verdict::PlaceOnly, 9.0).nearest_of_laws_refused().is_none(), "it leaves too much");
        for told in [Verdict::Named, Verdict::Formula, Verdict::None] {
            assert!(found(told, 1.0).nearest_of_laws_refused().is_none());
        }
        let none = Found { discovered: None, ..found(Verdict::Unknown, 1.0) };
        assert!(none.nearest_of_laws_refused().is_none());
    }

    #[test]
    fn analytic_more_is_asked_of_a_law_of_one_atom_that_is_told() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let wall = twin.trials().wall_fits(None).expect("windows").recalibrated;
        let one = drag(2.0, DRAG_N);
        let asked = |verdict: Verdict, law: Law| {
            let (hypothesis, values) = twin.trials().law_beside(&wall, &law);
            let after =
                FittedHypothesis { hypothesis, fit: Fit { values, ..wall.fit.clone() }, ..wall.clone() };
            Found { after, ..Found::in_vain(verdict, &wall, wall.clone()) }.asked_for_more().is_some()
        };
        let two = Law { second: Some(drag(1.0, DRAG_N).first), ..one };
        assert_eq!([one, two].map(|law| asked(Verdict::Formula, law)), [true, false]);
        assert!(!asked(Verdict::PlaceOnly, one), "nothing refused a law for the tests held out alone");
    }

    #[test]
    fn analytic_what_shows_in_tests_held_out_alone_is_unknown() {
        let said = |verdict: Verdict, error: f64| {
            let mut wall = leaving([1.0, error * error]);
            // So many that those held out hardly show among all.
            wall.fit.windows = vec![wall.fit.windows; 50].concat();
            Found::in_vain(verdict, &wall, wall.clone()).or_unknown().verdict
        };
        for nothing in [Verdict::None, Verdict::Recalibrated] {
            assert_eq!([1.4, 1.6].map(|error| said(nothing, error)), [nothing, Verdict::Unknown]);
        }
        assert_eq!(said(Verdict::Named, 2.0), Verdict::Named);
        // What impacts of another formulation leave shows in the tests fitted too.
        let other_impacts = leaving([4.0; 2]);
        let other_impacts = Found::in_vain(Verdict::None, &other_impacts, other_impacts.clone());
        assert_eq!(other_impacts.or_unknown().verdict, Verdict::None);
    }

    #[test]
    fn analytic_tests_held_out_alone_are_missed_where_nothing_is_known_of_them() {
        let missed = |verdict: Verdict, left: [f64; 2]| {
            let wall = leaving(left);
            Found::in_vain(verdict, &wall, wall.clone()).missed_held_out()
        };
        assert_eq!(missed(Verdict::Unknown, [1.0, 4.0]), Some([1.0, 2.0]));
        assert_eq!(missed(Verdict::Unknown, [100.0; 2]), None, "those fitted are missed too");
        assert_eq!(missed(Verdict::Unknown, [1.0; 2]), None, "those held out are followed");
        assert_eq!(missed(Verdict::None, [1.0, 4.0]), None);
    }
}

//! What was found: the verdict, the walls that it compares, and everything that was tried.

use super::{OtherLaw, Remainder, Verdict};
use crate::diagnose::discovery::Discovered;
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
        let walls =
            [&self.before, &self.recalibrated].into_iter().filter(|_| self.verdict == Verdict::Unknown);
        let errors = walls.filter_map(|wall| wall.errors()[0].zip(wall.errors()[1]));
        let mut alone =
            errors.filter(|(fitted, held_out)| *fitted < NOISE_AFTER && *held_out >= HELD_OUT_ERROR);
        alone.next().map(|(fitted, held_out)| [fitted, held_out])
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
    use crate::diagnose::discovery::twin::{Twin, wall_with};

    #[test]
    fn analytic_the_nearest_law_is_one_that_all_but_closes_a_gap_of_which_nothing_is_told() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let wall = twin.trials().wall_fits(None).expect("windows").recalibrated;
        let leaving = |reduced: f64| {
            let mut tried = wall.clone();
            let windows = tried.fit.windows.iter_mut().chain(&mut tried.held_out.windows);
            windows.for_each(|window| window.squares = reduced * window.freedom);
            tried
        };
        let found = |verdict: Verdict, left: f64| Found {
            verdict,
            before: leaving(100.0),
            recalibrated: leaving(100.0),
            after: leaving(100.0),
            equivalent: Vec::new(),
            place: None,
            remainder: None,
            other_law: None,
            discovered: Some(Discovered::in_vain(vec![leaving(left)])),
            tried: Vec::new(),
        };
        for open in [Verdict::PlaceOnly, Verdict::Unknown, Verdict::Curve] {
            assert!(found(open, 1.0).nearest_of_laws_refused().is_some());
        }
        assert!(found(Verdict::PlaceOnly, 9.0).nearest_of_laws_refused().is_none(), "it leaves too much");
        for told in [Verdict::Named, Verdict::Formula, Verdict::None] {
            assert!(found(told, 1.0).nearest_of_laws_refused().is_none());
        }
        let none = Found { discovered: None, ..found(Verdict::Unknown, 1.0) };
        assert!(none.nearest_of_laws_refused().is_none());
        // Nothing is missing where the tests held out are followed too, and is not known where they are not.
        let held_out = |verdict: Verdict, left: f64| {
            let mut after = leaving(1.0);
            // So many that those held out hardly show among all.
            after.fit.windows = vec![after.fit.windows; 50].concat();
            after.held_out.windows.iter_mut().for_each(|window| window.squares = left * window.freedom);
            Found { after, ..found(verdict, 1.0) }.or_unknown().verdict
        };
        for nothing in [Verdict::None, Verdict::Recalibrated] {
            assert_eq!(
                [1.4_f64, 1.6].map(|error| held_out(nothing, error * error)),
                [nothing, Verdict::Unknown]
            );
        }
        assert_eq!(held_out(Verdict::Named, 4.0), Verdict::Named);
        let other_impacts = Found { after: leaving(4.0), ..found(Verdict::None, 1.0) };
        assert_eq!(other_impacts.or_unknown().verdict, Verdict::None);
        let mut before = leaving(1.0);
        before.held_out.windows.iter_mut().for_each(|window| window.squares = 4.0 * window.freedom);
        let unknown = Found { before, ..found(Verdict::Unknown, 1.0) };
        assert_eq!(unknown.missed_held_out(), Some([1.0, 2.0]));
        assert_eq!(found(Verdict::Unknown, 1.0).missed_held_out(), None, "those fitted are missed too");
        assert_eq!(Found { verdict: Verdict::None, ..unknown }.missed_held_out(), None);
    }
}

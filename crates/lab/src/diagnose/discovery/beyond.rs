//! A second atom that only the larger motion of the tests held out reaches, beside the law that the tests fitted tell.
//!
//! Where such a law misses the tests held out, every other window of these is fitted too. A law of one atom that is fitted to all of them
//! takes up a part of what the larger motion shows, and points, most of which lie in the smaller, see little of the other atom. So that one
//! is looked for beside the law as the tests fitted alone tell it.

use super::asked::{AskedOfLaws, OpenGap};
use super::beside_best::seconds_of;
use super::by_windows::Discovered;
use super::equals::{law_of, simplest_of_equals};
use super::fitted::{Fitted, Start};
use super::points::Points;
use super::refused::Guard;
use super::search::search;
use super::stability::Stability;
use crate::Progress;
use crate::diagnose::fit::nats;
use crate::diagnose::formula::{Atom, Law, Site};
use crate::diagnose::trials::{Few, FittedHypothesis, Trials, all_windows, judged, refit};
use crate::limits::{COARSE_WINDOWS, SECONDS_FITTED_BEYOND, WORTH_WINDOWS};
use rayon::prelude::*;

impl Discovered {
    /// The best law of one atom that follows the tests fitted, and of which the tests held out alone ask more.
    pub fn asked_for_more(&self) -> Option<&FittedHypothesis> {
        let by_held_out = |law: &FittedHypothesis| {
            self.refused.iter().any(|one| one.guards == [Guard::HeldOut] && one.is_of(law))
        };
        let of_one = |law: &FittedHypothesis| law_of(law).is_some_and(|law| law.second.is_none());
        self.tried.iter().find(|law| of_one(law) && by_held_out(law))
    }

    /// What a law says more than the best of one atom that was tried beside it, in natural logarithms of likelihood over all windows.
    pub fn says_more_than_one_atom(&self, law: &FittedHypothesis) -> f64 {
        let left = |law: &FittedHypothesis| nats(&all_windows(law));
        let of_one = self.singles.iter().map(|one| left(&one.law)).fold(f64::INFINITY, f64::min);
        if of_one.is_finite() { of_one - left(law) } else { 0.0 }
    }

    /// Laws that were tried, without those that more refuses than the tests held out: these alone, or with the gap that they leave.
    pub fn unless_tests_fitted_refuse(&self) -> impl Iterator<Item = &FittedHypothesis> {
        let of_held_out = |guard: &Guard| matches!(guard, Guard::HeldOut | Guard::Gap);
        let refuse = move |law: &FittedHypothesis| {
            self.refused.iter().any(|one| one.is_of(law) && !one.guards.iter().all(of_held_out))
        };
        self.tried.iter().filter(move |law| !refuse(law))
    }
}

impl<P: Progress> Trials<'_, P> {
    /// A law that other windows tell, with a second atom that these show. `None` where none holds that is worth it beside the law fitted to
    /// these, and beside each of its atoms alone.
    pub fn discover_beyond(
        &self,
        told: &FittedHypothesis,
        gap: &OpenGap,
        asked: &impl AskedOfLaws,
    ) -> Option<Discovered> {
        let wall = self.hypothesis(&self.experiment.nuisances, &[]);
        let points = Points::new(self.data.fit.tests, &wall)?;
        let searched = search(&points)?;
        let FittedHypothesis { hypothesis, fit, .. } = told;
        let alone = self.within_budget(&hypothesis.name(), fit.values.len(), |data| {
            refit(data, hypothesis.clone(), gap.nearest, &fit.values)
        })?;
        let one = self.with_numbers_of(told, &alone)?;
        let gap = OpenGap { nearest: &one, ..*gap };
        let starts = self.seconds_beyond(&one, points.reach[law_of(told)?.first.site as usize]);
        let mut pairs = self.laws_in_windows(&gap, starts, WHAT);
        // The one that is told should not hang on the valley that its fit has ended in.
        self.refine_best(&gap, &mut pairs);
        let (of_two, mut refused) = self.closing(&gap, &searched, &mut pairs, Some(&alone), asked);
        let (of_two, worth_less) = self.or_an_atom_alone(&gap, &searched, of_two, asked);
        let lacked = match of_two.is_empty() {
            true => self.of_two_that_one_lacks(&alone, &pairs, &refused),
            false => None,
        };
        refused.retain(|one| !lacked.as_ref().is_some_and(|two| one.is_of(&two.law)));
        refused.extend(worth_less);
        let has_two = |one: &Fitted| law_of(one.judged()).is_some_and(|law| law.second.is_some());
        let closing = of_two.into_iter().chain(lacked).filter(has_two).collect();
        let equals = simplest_of_equals(&self.data, &points, self.in_order(closing));
        let moved = equals.first()?.moved.clone();
        let equals = equals.into_iter().map(|one| one.law).collect::<Vec<_>>();
        let laws = equals.iter().filter_map(law_of).collect::<Vec<_>>();
        let tried = pairs.iter().map(|fitted| fitted.law.clone()).chain([alone.clone()]).collect();
        Some(Discovered {
            stability: Stability::of(&searched, &laws),
            second_says_more: searched.second_says_more(laws.first()?),
            equals,
            moved,
            tried: self.ordered(tried),
            refused,
            curve: None,
            excited: Site::ALL.map(|site| points.range(site)),
            singles: vec![Fitted::new(alone)],
            pairs,
            windows_chose: true,
            second_shows: false,
        })
    }

    /// A law of one atom with second ones, fitted coarsely to few windows where it follows worst: the best of each shape of those that do
    /// better by what is worth a fit to all. Windows that it misses by far are felt, or a little of any atom would gain nothing there.
    fn seconds_beyond(&self, one: &FittedHypothesis, reach: [f64; 2]) -> Vec<Start> {
        let Some(law) = law_of(one) else { return Vec::new() };
        let few = Few::felt(self.data.fit, COARSE_WINDOWS, &one.fit);
        let (data, own) = (few.data(), few.of(one));
        let seconds = seconds_of(&law.first, reach);
        self.progress.begin(&format!("{WHAT}, in few windows"), seconds.len());
        let look = |second: &Atom| {
            let both = Law { second: Some(*second), ..law };
            let taken = self.taken_by_second(&data, one, &own.fit.windows, both);
            let start = taken.and_then(|(_, pair)| {
                let (hypothesis, values) = self.law_beside(one, &pair);
                let fit = self.coarsely(&data, &pair, &hypothesis, &values, &own)?;
                Some((pair, Start { nats: nats(&fit.windows), hypothesis, values: fit.values }))
            });
            self.progress.advance(1);
            start
        };
        let worth = nats(&own.fit.windows) - WORTH_WINDOWS;
        let found = seconds.par_iter().filter_map(look).filter(|(_, start)| start.nats < worth);
        let mut found = found.collect::<Vec<_>>();
        found.sort_by(|a, b| a.1.nats.total_cmp(&b.1.nats));
        let mut starts: Vec<(Law, Start)> = Vec::new();
        for (pair, start) in found {
            if !starts.iter().any(|(known, _)| known.is_like(&pair)) {
                starts.push((pair, start));
            }
        }
        starts.into_iter().map(|(_, start)| start).take(SECONDS_FITTED_BEYOND).collect()
    }

    /// A law with its numbers as other windows tell them, in these.
    fn with_numbers_of(
        &self,
        told: &FittedHypothesis,
        nearest: &FittedHypothesis,
    ) -> Option<FittedHypothesis> {
        let (hypothesis, values) = (&told.hypothesis, &told.fit.values);
        let begun = self.data.fit.states_to_begin(hypothesis, values, &nearest.states(), TOLD_STEPS)?;
        judged(&self.data, hypothesis.clone(), begun, nearest, false)
    }
}

const WHAT: &str = "a second atom that the tests held out reach";
/// Steps in which the states of windows follow a law whose numbers stay.
const TOLD_STEPS: usize = 3;

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::refused::Refused;
    use super::super::twin::{AskedOfGain, DRAG, DRAG_N, Twin, drag, open_gap, wall_with};
    use super::*;
    use crate::diagnose::formula::{Shape, Side};
    use crate::diagnose::shared::{as_fitted, every_other};
    use crate::diagnose::trials::{Data, Unfinished};
    use crate::limits::WORTH_A_SECOND_SEEN;

    /// A stop on one side that only the test held out reaches.
    const STOP: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*max(x-g,0)\"\n\
                        [effects.parameters]\nk = { value = 2e5, unit = \"N/m\" }\n\
                        g = { value = 0.06, unit = \"m\" }\n";

    /// What is found beside a drag, as the tests fitted tell it, in windows that the test held out shares; and what the drag leaves of the former
    /// and of the latter.
    fn beyond_a_drag(effects: &str) -> (Option<Law>, [f64; 2]) {
        let twin = Twin::farthest_held_out(&wall_with(effects), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let (h, values) = trials.law_beside(&wall.recalibrated, &drag(2.0, DRAG_N));
        let told = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        let windows = every_other(twin.windows().clone(), &told);
        let experiment = twin.experiment();
        let tests = as_fitted(&experiment.tests);
        let unfinished = Unfinished::default();
        let trials = Trials::new(experiment, Data::new(&tests, &windows), &(), &unfinished);
        let wall = trials.wall_fits(None).expect("windows");
        let gap = open_gap(&wall, Scope::TwoAtoms);
        let asked = AskedOfGain { data: trials.data, least: WORTH_A_SECOND_SEEN };
        let found = trials.discover_beyond(&told, &gap, &asked);
        let errors = told.errors().map(|error| error.expect("windows"));
        (found.and_then(|found| law_of(&found.equals[0])), errors)
    }

    #[test]
    fn analytic_a_stop_that_only_the_larger_motion_reaches_is_found_beside_the_law_that_the_tests_fitted_tell()
     {
        let (law, [fitted, held_out]) = beyond_a_drag(&[DRAG, STOP].concat());
        assert!(fitted < 1.03 && held_out > 1.2, "{fitted} and {held_out}");
        let second = law.and_then(|law| law.second).expect("a second atom");
        assert_eq!(second.shape, Shape::Stop(Side::Positive), "{law:?}");
        let gap_m = second.numbers[0] * second.reach[0];
        assert!((gap_m - 0.06).abs() < 0.1 * 0.06, "{gap_m}");
    }

    #[test]
    fn analytic_the_law_that_nothing_but_tests_held_out_refuses_asks_for_more() {
        let twin = Twin::new(&wall_with(DRAG), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let (h, values) = trials.law_beside(&wall.recalibrated, &drag(2.0, DRAG_N));
        let law = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        let refused = |guards: &[Guard]| Discovered {
            refused: vec![Refused::in_windows(&law, guards.to_vec())],
            ..Discovered::in_vain(vec![law.clone()])
        };
        let asks = |guards: &[Guard]| refused(guards).asked_for_more().is_some();
        assert!(asks(&[Guard::HeldOut]) && !asks(&[Guard::HeldOut, Guard::Bend]) && !asks(&[]));
        let is_kept = |guards: &[Guard]| refused(guards).unless_tests_fitted_refuse().count() == 1;
        assert!(is_kept(&[Guard::HeldOut, Guard::Gap]) && !is_kept(&[Guard::HeldOut, Guard::Bend]));
        // The wall without it says less.
        let said = refused(&[]).says_more_than_one_atom(&wall.recalibrated);
        assert!(said < -WORTH_A_SECOND_SEEN, "{said}");
    }

    #[test]
    fn analytic_nothing_is_found_beside_a_law_that_is_all() {
        assert_eq!(beyond_a_drag(DRAG).0, None);
    }
}

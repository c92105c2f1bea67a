//! Laws fitted to windows: where they start, what they come to, the same with exact exponents, and once more from about themselves.

use super::asked::OpenGap;
use super::equals::law_of;
use super::guards::{holds_in_each_test, lies_inside};
use super::search::{Candidate, Searched};
use crate::Progress;
use crate::diagnose::fit::nats;
use crate::diagnose::formula::{Law, nearest_exact};
use crate::diagnose::hypothesis::{Addition, Hypothesis};
use crate::diagnose::trials::{
    Data, FittedHypothesis, Trials, against, all_but_closes, judged, refit, shared_states,
};
use crate::limits::{CLOSING_REFINED, LAWS_FITTED, LAWS_IN_WINDOWS, MORE_WORK, NEAR_BEST, WORTH_WINDOWS};
use nalgebra::DVector;
use rayon::prelude::*;

/// A law fitted to windows.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub law: FittedHypothesis,
    /// Whether its fit ended by itself, and not because it had worked as much as it may.
    pub is_done: bool,
    /// So many times the work of others its fits may take.
    pub work: usize,
    /// Whether it was fitted again from about itself.
    pub is_refined: bool,
    /// The same with numbers that the tests fitted leave open, with which those held out are followed, where they are not without.
    pub moved: Option<FittedHypothesis>,
    /// Whether such numbers were looked for.
    pub is_asked_to_move: bool,
}

impl Fitted {
    /// As a fit came to it.
    pub fn new(law: FittedHypothesis) -> Self {
        Self { law, is_done: true, work: 1, is_refined: false, moved: None, is_asked_to_move: false }
    }

    /// What it is judged by.
    pub fn judged(&self) -> &FittedHypothesis {
        self.moved.as_ref().unwrap_or(&self.law)
    }

    /// Whether its fit came to an end, and that at numbers inside what was looked at.
    pub fn means_something(&self) -> bool {
        self.is_done && law_of(&self.law).is_some_and(|law| lies_inside(&law))
    }
}

impl<P: Progress> Trials<'_, P> {
    /// Laws that are known to be near and the best of those found over points, as windows follow them from there: the best.
    pub(super) fn starts_by_look(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        kin: &[Law],
        laws: &[Candidate],
        what: &str,
    ) -> Vec<Start> {
        let sound = |c: &&Candidate| {
            c.evidence > WORTH_WINDOWS
                && lies_inside(&c.law)
                && holds_in_each_test(&searched.equations, &c.law)
        };
        let found = laws.iter().filter(sound).take(LAWS_IN_WINDOWS).map(|c| c.law);
        let laws = kin.iter().copied().chain(found).collect::<Vec<_>>();
        self.progress.begin(&format!("{what}, a first look"), laws.len());
        let look = |law: &Law| {
            let start = self.start_in_windows(gap, searched, law);
            self.progress.advance(1);
            start
        };
        let mut starts = laws.par_iter().filter_map(look).collect::<Vec<_>>();
        starts.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        starts.truncate(LAWS_FITTED);
        starts
    }

    /// Laws fitted to windows from where they start; the first of these with exact exponents too.
    pub(super) fn laws_in_windows(&self, gap: &OpenGap, starts: Vec<Start>, what: &str) -> Vec<Fitted> {
        let free = self.fitted(gap, starts, what);
        let exact = self.exactly(&free);
        self.in_order([free, exact].concat())
    }

    /// Laws fitted from where they start; one whose fit ends before it is done stays as it started.
    fn fitted(&self, gap: &OpenGap, starts: Vec<Start>, what: &str) -> Vec<Fitted> {
        self.progress.begin(what, starts.len());
        let fit = |start: Start| {
            let Start { hypothesis, values, .. } = start;
            let name = law_name(&hypothesis, &values);
            let found = self.within_budget(&name, values.len(), |data| {
                refit(data, hypothesis.clone(), gap.nearest, &values)
            });
            self.progress.advance(1);
            match found {
                Some(law) => Some(Fitted::new(law)),
                None => {
                    let fit = self.data.fit.states(&hypothesis, &values, &gap.nearest.states(), 0, false)?;
                    let law = judged(&self.data, hypothesis, fit, gap.nearest, false)?;
                    Some(Fitted { is_done: false, ..Fitted::new(law) })
                }
            }
        };
        self.in_order(starts.into_par_iter().filter_map(fit).collect())
    }

    /// Laws fitted to windows, the best of which may work more where it ended for its work: a damper that goes with a root of a velocity
    /// takes many short steps wherever that turns back. The same with exact exponents, too.
    pub(super) fn with_more_work(&self, gap: &OpenGap, mut fitted: Vec<Fitted>) -> Vec<Fitted> {
        let inside = |one: &Fitted| law_of(&one.law).is_some_and(|law| lies_inside(&law));
        let Some(best) = fitted.first().filter(|one| !one.is_done && inside(one)) else { return fitted };
        let FittedHypothesis { hypothesis, fit, .. } = best.law.clone();
        let name = law_name(&hypothesis, &fit.values);
        let start = Start { nats: nats(&fit.windows), hypothesis, values: fit.values };
        let at_ease = self.with_work(MORE_WORK);
        let found = at_ease.laws_in_windows(gap, vec![start], &format!("{name}, which takes more work"));
        let done = found.into_iter().filter(|one| one.is_done).collect::<Vec<_>>();
        if done.is_empty() {
            return fitted;
        }
        self.unfinished.take_back(&name);
        fitted.swap_remove(0);
        let done = done.into_iter().map(|one| Fitted { work: MORE_WORK, ..one });
        self.in_order(done.chain(fitted).collect())
    }

    /// Fitted laws in the order of what speaks against them.
    pub(super) fn in_order(&self, mut fitted: Vec<Fitted>) -> Vec<Fitted> {
        let of = |fitted: &Fitted| against(&self.data, fitted.judged());
        fitted.sort_by(|a, b| of(a).total_cmp(&of(b)));
        self.ordered(fitted.iter().map(|fitted| fitted.law.clone()).collect());
        fitted
    }

    /// The best of fitted laws once more, with exact exponents where theirs are near.
    fn exactly(&self, free: &[Fitted]) -> Vec<Fitted> {
        let Some(best) = free.first().map(|best| against(&self.data, &best.law)) else { return Vec::new() };
        let near = free.iter().filter(|t| t.is_done && against(&self.data, &t.law) < best + NEAR_BEST);
        let exact = near.filter_map(|t| Some((&t.law, exact_law(&t.law)?))).collect::<Vec<_>>();
        self.progress.begin("laws with exact exponents", exact.len());
        let fit = |(from, law): &(&FittedHypothesis, Law)| {
            let (h, values) = self.law_beside(from, law);
            let name = law_name(&h, &values);
            // Near impacts that the noise decides a fit may end in another valley than the one it set out from.
            let found = self.within_budget(&name, values.len(), |data| {
                let found = refit(data, h, from, &values)?;
                Some(shared_states(data, &found, &[from]))
            });
            self.progress.advance(1);
            // What the same law with free exponents is judged by stays.
            Some(Fitted::new(found?))
        };
        exact.par_iter().filter_map(fit).collect()
    }

    /// A law with its own numbers, and the wall's as another fit has them.
    pub(in crate::diagnose) fn law_beside(
        &self,
        fitted: &FittedHypothesis,
        law: &Law,
    ) -> (Hypothesis, Vec<f64>) {
        let hypothesis = self.hypothesis(&self.experiment.nuisances, &[Addition::Formula(*law)]);
        let own = fitted.fit.values.iter().take(hypothesis.nuisances).copied();
        let values = own.chain(law.values()).collect();
        (hypothesis, values)
    }

    /// A law with the numbers that points give it and the wall.
    pub(super) fn of_points(&self, searched: &Searched, law: &Law) -> Option<(Hypothesis, Vec<f64>)> {
        let hypothesis = self.hypothesis(&self.experiment.nuisances, &[Addition::Formula(*law)]);
        let steps = searched.equations.wall_steps(law)?;
        let values = beside(&hypothesis, &steps).chain(law.values()).zip(&hypothesis.unknowns);
        let values = values.map(|(value, unknown)| unknown.within(value)).collect::<Vec<_>>();
        Some((hypothesis, values))
    }

    /// The same, and how well windows follow it so, their states fitted.
    fn start_in_windows(&self, gap: &OpenGap, searched: &Searched, law: &Law) -> Option<Start> {
        let (hypothesis, values) = self.of_points(searched, law)?;
        let look =
            |data: &Data| data.fit.states_to_begin(&hypothesis, &values, &gap.nearest.states(), LOOK_STEPS);
        let fit = self.within_budget(&law.name(), values.len(), look)?;
        Some(Start { nats: nats(&fit.windows), hypothesis, values })
    }

    /// Laws that were fitted before. What follows best by now has states that they have not tried.
    pub(super) fn with_states_since(&self, gap: &OpenGap, fitted: &[Fitted]) -> Vec<Fitted> {
        let sharing = |fitted: &Fitted| Fitted {
            law: shared_states(&self.data, &fitted.law, &[gap.nearest]),
            ..fitted.clone()
        };
        fitted.par_iter().map(sharing).collect()
    }

    /// Fits the best law whose numbers mean something again from about itself, where it all but closes the gap: such a fit has ended in
    /// another valley of some windows than the right one. Whether there was one, and not refined before.
    pub(super) fn refine_best(&self, gap: &OpenGap, fitted: &mut Vec<Fitted>) -> bool {
        let best = fitted.iter().position(Fitted::means_something);
        best.is_some_and(|best| self.refine(gap, fitted, &[best]))
    }

    /// The same of laws that close the gap, the best of them: which is told should not hang on the valleys that their fits have ended in.
    pub(super) fn refine_closing(&self, gap: &OpenGap, fitted: &mut Vec<Fitted>, closing: &[Fitted]) -> bool {
        let closes = |one: &Fitted| closing.iter().any(|other| law_of(&other.law) == law_of(&one.law));
        let which = (0..fitted.len()).filter(|i| closes(&fitted[*i])).take(CLOSING_REFINED);
        let which = which.collect::<Vec<_>>();
        self.refine(gap, fitted, &which)
    }

    /// Fits those of laws again from about themselves that all but close the gap and were not before. Whether there was one.
    fn refine(&self, gap: &OpenGap, fitted: &mut Vec<Fitted>, which: &[usize]) -> bool {
        let may = |one: &Fitted| !one.is_refined && all_but_closes(&one.law, gap.error);
        let which = which.iter().filter(|i| may(&fitted[**i])).collect::<Vec<_>>();
        for i in &which {
            let one = &mut fitted[**i];
            let refined = self.with_work(one.work).refined(one.law.clone());
            *one = Fitted { is_refined: true, work: one.work, ..Fitted::new(refined) };
        }
        if !which.is_empty() {
            *fitted = self.in_order(std::mem::take(fitted));
        }
        !which.is_empty()
    }
}

/// The law of a hypothesis by its formula.
fn law_name(h: &Hypothesis, values: &[f64]) -> String {
    h.laws(values).iter().map(Law::name).collect::<Vec<_>>().join(" + ")
}

/// The wall's numbers after steps in standard deviations of what was known.
pub(super) fn beside<'h>(
    hypothesis: &'h Hypothesis,
    steps: &'h DVector<f64>,
) -> impl Iterator<Item = f64> + use<'h> {
    let own = hypothesis.unknowns.iter().take(hypothesis.nuisances).zip(steps.iter());
    own.map(|(unknown, step)| unknown.within(unknown.start + step * unknown.prior_sd.unwrap_or(0.0)))
}

/// Steps of the states of windows at a first look.
pub(super) const LOOK_STEPS: usize = 2;

/// A law at a first look.
pub(super) struct Start {
    /// The law beside the wall.
    pub hypothesis: Hypothesis,
    /// Its numbers.
    pub values: Vec<f64>,
    /// What windows say against it.
    pub nats: f64,
}

/// The law of a fitted hypothesis with exact exponents, where all of them are near such.
pub(super) fn exact_law(tried: &FittedHypothesis) -> Option<Law> {
    let h = &tried.hypothesis;
    let sd = |i: usize| tried.fit.covariance.as_ref().map_or(0.0, |c| c[(i, i)].max(0.0).sqrt());
    let deviations = (h.nuisances..h.unknowns.len()).map(sd).collect::<Vec<_>>();
    nearest_exact(h.laws(&tried.fit.values).first()?, &deviations)
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::twin::{DRAG, DRAG_N, Twin, drag, open_gap, wall_with};
    use super::*;
    use crate::diagnose::trials::with_values;

    #[test]
    fn analytic_a_law_that_all_but_closes_a_gap_is_fitted_again_once() {
        let twin = Twin::new(&wall_with(DRAG), 1e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        // As a fit in a wrong valley leaves it.
        let stuck = |n: f64, off: f64| {
            let law = drag(n, off * DRAG_N);
            let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Formula(law)]);
            let values = h.start().into_iter().take(h.nuisances).chain(law.values()).collect::<Vec<_>>();
            let law = with_values(&trials.data, h, &wall.recalibrated, &values).expect("a wall");
            Fitted::new(law)
        };
        let gap = open_gap(&wall, Scope::OneAtom);
        let mut near = vec![stuck(2.0, 1.03)];
        let before = against(&trials.data, &near[0].law);
        assert!(trials.refine_best(&gap, &mut near));
        let after = against(&trials.data, &near[0].law);
        let size = law_of(&near[0].law).expect("a law").first.size / DRAG_N;
        assert!((size - 1.0).abs() < 0.01 && after < before - 30.0, "{size}, {before} to {after}");
        assert!(!trials.refine_best(&gap, &mut near), "once");
        assert!(!trials.refine_best(&gap, &mut vec![stuck(2.0, 3.0)]), "it leaves too much");
        // Of laws that close a gap more than the best.
        let closing = [stuck(2.0, 1.02), stuck(2.01, 1.03)];
        let mut all = [&closing[..], &[stuck(1.99, 1.03)]].concat();
        assert!(trials.refine_closing(&gap, &mut all, &closing));
        assert_eq!(all.iter().filter(|one| one.is_refined).count(), CLOSING_REFINED);
        let left = all.iter().find(|one| !one.is_refined).expect("one that does not close");
        assert_eq!(law_of(&left.law), law_of(&stuck(1.99, 1.03).law));
        assert!(!trials.refine_closing(&gap, &mut all, &[]));
    }

    #[test]
    fn analytic_the_best_law_may_work_more_where_it_ended_for_its_work() {
        let twin = Twin::new(&wall_with(DRAG), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let law = drag(1.9, 0.9 * DRAG_N);
        let (hypothesis, values) = trials.law_beside(&wall.recalibrated, &law);
        let start = Start { hypothesis, values, nats: 0.0 };
        let gap = open_gap(&wall, Scope::OneAtom);
        let ended = trials.with_work(0).laws_in_windows(&gap, vec![start], "a law");
        assert!(!ended[0].is_done && trials.unfinished.all().len() == 1);
        let done = trials.with_more_work(&gap, ended);
        let [best, ..] = &done[..] else { panic!("no law") };
        assert!(best.is_done && best.work == MORE_WORK);
        let n = law_of(&best.law).expect("a law").first.numbers[0];
        assert!((n - 2.0).abs() < 0.05, "{n}");
        assert!(trials.unfinished.all().is_empty(), "{:?}", trials.unfinished.all());
        let count = done.len();
        assert_eq!(trials.with_more_work(&gap, done).len(), count, "it is done");
    }
}

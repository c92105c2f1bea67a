//! Hypotheses tried: single effects, pairs, and the same again from better starts, side by side on all threads.
//!
//! | module | idea |
//! | --- | --- |
//! | `search` | one hypothesis: where its fit may start, the fit, and whether it is worth fitting to the end |
//! | `fitted_hypothesis` | what came of it: whether it follows the tests within noise, closes a gap, does something |
//! | `few` | few of the windows to fit, enough to tell what is worth a fit to all |
//! | `effects` | the wall as given, its own numbers, effects one by one and in pairs |
//! | `refinement` | an answer fitted again from about where it was found |
//! | [`Unfinished`] | fits that ended because they had worked as much as they may |
//! | `beds` | joints that give |
//! | `between_impacts` | what hypotheses leave of windows up to the first impact, where formulations of contact are alike |
//! | `joint_laws` | other laws of joints beside a bed |
//! | `imitation` | hypotheses that could imitate the best |
//! | `own` | laws of the user's own |
//! | `friction` | friction that gives a little first |
//! | `patterns` | patterns read again, without a sensor's gain and with joints open by less than the noise |

mod beds;
mod between_impacts;
mod effects;
mod few;
mod fitted_hypothesis;
mod friction;
mod imitation;
mod joint_laws;
mod own;
mod patterns;
mod refinement;
mod search;
mod unfinished;

pub use beds::{
    excess, follows_all_nearly, in_order_of_likelihood, own_error, relieved, typical_error, widened,
};
pub use between_impacts::BetweenImpacts;
pub use effects::{FirstFits, WallFits};
pub(super) use few::Few;
pub use fitted_hypothesis::{Data, FittedHypothesis};
pub use fitted_hypothesis::{
    against, all_but_closes, all_windows, best_answer, closes, closes_held_out, does_something,
    follows_to_noise, is_noise, joint_error, kinds, leave_noise, misses_windows, nearly_closes,
};
pub use friction::{FRICTION, friction_in_two_parts, giving_friction, kind_of};
pub(super) use imitation::taken_by;
pub use joint_laws::crushes;
pub use patterns::{gain_misread, has_gain, reads_better, reads_far_better, set_gain};
pub use patterns::{opened_as_given, opened_enough, opened_under, opened_windows};
pub use refinement::follow_few;
#[cfg(test)]
pub use search::try_hypothesis;
pub use search::{judged, refit, shared_states, untouched, with_values};
pub use unfinished::Unfinished;

use rayon::prelude::*;

use crate::diagnose::experiment::Experiment;
use crate::diagnose::fit::{Budget, Problem};
use crate::diagnose::hypothesis::{Addition, Hypothesis, Nuisance};
use crate::limits::{FIT_WORK, NEAR_BEST, NEAR_BEST_SHARE, POLISHED, WORTH_POLISH};
use crate::{Progress, Tried};
use search::{Coarse, worth_finishing};
use search::{finish, try_coarsely};

/// Of hypotheses fitted together, as many are told while others are tried.
const MOST_TOLD: usize = 10;

/// Where hypotheses are tried.
pub struct Trials<'a, P> {
    /// Wall, priors, tests.
    pub experiment: &'a Experiment,
    /// Windows.
    pub data: Data<'a>,
    /// Told how far it is.
    pub progress: &'a P,
    /// Told which fits ended before they were done.
    pub unfinished: &'a Unfinished,
    /// So many times the usual work a fit may take.
    work: usize,
}

impl<'a, P> Trials<'a, P> {
    /// Hypotheses are tried in windows, each fit within the usual work.
    pub fn new(
        experiment: &'a Experiment,
        data: Data<'a>,
        progress: &'a P,
        unfinished: &'a Unfinished,
    ) -> Self {
        Self { experiment, data, progress, unfinished, work: 1 }
    }
}

impl<P: Progress> Trials<'_, P> {
    /// The same, where a fit may take so many times the usual work.
    pub fn with_work(&self, work: usize) -> Trials<'_, P> {
        let Self { experiment, data, progress, unfinished, .. } = *self;
        Trials { experiment, data, progress, unfinished, work }
    }

    /// A fit of so many numbers within what one may work; `None` where it ends before it is done, which is told.
    pub fn within_budget<R>(
        &self,
        name: &str,
        numbers: usize,
        fit: impl FnOnce(&Data) -> Option<R>,
    ) -> Option<R> {
        self.within_budget_of(&self.data, name, numbers, fit)
    }

    /// The same to other windows.
    pub(in crate::diagnose) fn within_budget_of<R>(
        &self,
        data: &Data,
        name: &str,
        numbers: usize,
        fit: impl FnOnce(&Data) -> Option<R>,
    ) -> Option<R> {
        let budget = Budget::of(&data.fit, FIT_WORK * (self.work * numbers.max(1)) as f64);
        let data = Data { fit: Problem { budget: Some(&budget), ..data.fit }, ..*data };
        let found = fit(&data);
        if budget.is_spent() {
            self.unfinished.tell(name);
            return None;
        }
        found
    }

    /// The wall with what is uncertain of it and what is added.
    pub fn hypothesis(&self, nuisances: &[Nuisance], additions: &[Addition]) -> Hypothesis {
        Hypothesis::new(self.experiment.wall.parameters(), &self.experiment.scales, nuisances, additions)
    }

    /// Fits every set of additions, and orders them by what speaks against them.
    pub fn try_all(
        &self,
        what: &str,
        nuisances: &[Nuisance],
        from: &[&FittedHypothesis],
        sets: &[Vec<Addition>],
    ) -> Vec<FittedHypothesis> {
        self.progress.begin(what, sets.len());
        let try_one = |additions: &Vec<Addition>| {
            let tried = try_coarsely(&self.data, self.hypothesis(nuisances, additions), from);
            self.progress.advance(1);
            tried
        };
        self.finished(self.ordered(sets.par_iter().filter_map(try_one).collect()))
    }

    /// Finishes the best of coarse fits in order; the others are so far behind that they cannot be the answer.
    fn finished(&self, mut coarse: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        let against = |tried: &FittedHypothesis| against(&self.data, tried);
        let judge = |tried: &FittedHypothesis| Coarse { against: against(tried), error: tried.fit_error() };
        let judged = coarse.iter().map(judge).collect::<Vec<_>>();
        let chosen = worth_finishing(&judged);
        self.progress.begin("the best candidates, in full", chosen.len());
        let finish_one = |i: &usize| {
            let finished = finish(&self.data, &coarse[*i]);
            self.progress.advance(1);
            finished.filter(|new| against(new) < judged[*i].against)
        };
        let finished = chosen.par_iter().map(finish_one).collect::<Vec<_>>();
        for (i, finished) in chosen.into_iter().zip(finished) {
            if let Some(finished) = finished {
                coarse[i] = finished;
            }
        }
        self.ordered(coarse)
    }

    /// In the order of what speaks against them; the best are told.
    pub fn ordered(&self, mut tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        tried.sort_by(|a, b| against(&self.data, a).total_cmp(&against(&self.data, b)));
        let told = tried.iter().take(MOST_TOLD).map(|tried| self.as_told(tried)).collect::<Vec<_>>();
        self.progress.tried(&told);
        tried
    }

    /// A hypothesis as far as it is fitted.
    fn as_told(&self, tried: &FittedHypothesis) -> Tried {
        let h = &tried.hypothesis;
        let added = h.unknowns.iter().zip(&tried.fit.values).skip(h.nuisances);
        Tried {
            name: h.name(),
            numbers: added.map(|(u, value)| (u.key.clone(), u.number(*value), u.unit.to_owned())).collect(),
            windowed_error: tried.errors(),
            against: against(&self.data, tried),
        }
    }

    /// The best of hypotheses with the same additions, in order.
    pub(super) fn best_of_each(&self, tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        first_of_each(self.ordered(tried))
    }

    /// Fits the best few once more, about what was found but with the wall's own numbers as given. All stay as they
    /// are if the best gains little over a simpler hypothesis, or none comes near to closing the gap.
    fn polished(
        &self,
        nuisances: &[Nuisance],
        from: &FittedHypothesis,
        mut tried: Vec<FittedHypothesis>,
        simpler: &FittedHypothesis,
    ) -> Vec<FittedHypothesis> {
        let Some(best) = tried.first() else { return tried };
        let gap = joint_error(from).unwrap_or(f64::INFINITY);
        // Of a gap far above the noise likelihood tells little: what is near is told by it too.
        let best_against = against(&self.data, best);
        let limit = best_against + NEAR_BEST.max(NEAR_BEST_SHARE * best_against);
        let count = tried.iter().take(POLISHED).filter(|t| against(&self.data, t) < limit).count();
        let is_near = tried[..count].iter().any(|t| nearly_closes(t, gap));
        if !is_near || against(&self.data, simpler) - best_against < WORTH_POLISH {
            return tried;
        }
        self.progress.begin("the best candidates, again", count);
        let again = |old: &FittedHypothesis| {
            let h = self.hypothesis(nuisances, &old.hypothesis.additions);
            let about = |factor: f64| {
                let shares = (0..h.unknowns.len()).map(|i| if i < h.nuisances { 0.0 } else { factor });
                let values = h.unknowns.iter().zip(shares).zip(&old.fit.values);
                values.map(|((unknown, share), value)| unknown.with_share(share, *value)).collect::<Vec<_>>()
            };
            let tries = [0.92, 1.0, 1.08].map(about);
            let fits = tries.par_iter().filter_map(|values| refit(&self.data, h.clone(), from, values));
            let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
            self.progress.advance(1);
            best.filter(|new| new.fit.cost < old.fit.cost).unwrap_or_else(|| old.clone())
        };
        let best = tried[..count].iter().map(again).collect::<Vec<_>>();
        tried.splice(..count, best);
        self.ordered(tried)
    }

    /// A hypothesis, or the same fitted from the values of a larger one, where that is better. A number of the wall
    /// far from its prior is sometimes found beside a further effect only.
    pub fn better_part(&self, part: FittedHypothesis, whole: &FittedHypothesis) -> FittedHypothesis {
        let additions = &part.hypothesis.additions;
        let holds = additions.iter().all(|a| whole.hypothesis.additions.contains(a));
        if !holds || against(&self.data, whole) > against(&self.data, &part) - WORTH_POLISH {
            return part;
        }
        let h = self.hypothesis(&self.experiment.nuisances, additions);
        let values = h.values_from(&whole.hypothesis, &whole.fit.values);
        let again = refit(&self.data, h, whole, &values);
        again.filter(|new| against(&self.data, new) < against(&self.data, &part)).unwrap_or(part)
    }
}

/// Of hypotheses with the same additions the first: what was fitted twice is no rival of itself.
pub fn first_of_each(tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
    let mut first: Vec<FittedHypothesis> = Vec::new();
    for t in tried {
        if !first.iter().any(|other| other.hypothesis.additions == t.hypothesis.additions) {
            first.push(t);
        }
    }
    first
}

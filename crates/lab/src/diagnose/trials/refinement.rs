//! An answer once more from about where it was found.
//!
//! Windows near an impact that the noise decides have several local minima. The one that a window lies in holds the numbers
//! of a hypothesis where they are. Fits that start from other numbers find other minima. The best of all of them is the
//! answer, and its intervals mean something. Windows that are not missed lie in wrong valleys too: of the answer, other states of all
//! those are looked for that leave more than noise leaves in most.
//!
//! Most starts come to one place by the first steps of a fit, and differ by the states of some windows. They go on as one, with
//! the better state of each window: what a further fit of each would find.

use nalgebra::DVector;
use rayon::prelude::*;

use super::search::{finish_begun, first_steps, shared_states};
use super::{FittedHypothesis, Trials, against, kinds};
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem, nats};
use crate::diagnose::hypothesis::{Addition, Hypothesis, Unknown};
use crate::limits::{
    ANSWER_FINISHED, ANSWER_ROUNDS, ANSWER_SHARES, BED_SHARES, LAW_SHARES, MOVED_IN_A_ROUND, ONE_PLACE,
    WORTH_A_ROUND,
};

impl<P: Progress> Trials<'_, P> {
    /// Single effects in order. Where even the one that follows the windows best misses many of them, that one is
    /// refined. What such windows say is at its bound, and a fit ends before the numbers of the right law.
    pub fn with_far_refined(&self, tried: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        let Some(far) = follows_best(&tried).filter(|t| t.fit.is_far()).cloned() else { return tried };
        let refined = self.refined(far);
        self.best_of_each([tried, vec![refined]].concat())
    }

    /// The same additions with the numbers and states that speak least against them.
    ///
    /// A round that finds better states of windows and leaves the numbers where they are is the last: they do not hang on these.
    pub fn refined(&self, answer: FittedHypothesis) -> FittedHypothesis {
        self.refined_while(answer, ANSWER_FINISHED, |_| true)
    }

    /// The same while the tests ask for it, so many places of a round ended.
    pub(super) fn refined_while(
        &self,
        answer: FittedHypothesis,
        finished: usize,
        asks: impl Fn(&FittedHypothesis) -> bool,
    ) -> FittedHypothesis {
        let mut best = answer;
        for _ in 0..ANSWER_ROUNDS {
            if !asks(&best) {
                break;
            }
            let next = self.looked_about(self.once_more(&best, finished));
            let gain = against(&self.data, &best) - against(&self.data, &next);
            let goes_on =
                gain > WORTH_A_ROUND && likelihood_apart(&next.fit, &best.fit.values) > MOVED_IN_A_ROUND;
            if gain > 0.0 {
                best = next;
            }
            if !goes_on {
                break;
            }
        }
        best
    }

    /// The same with other valleys looked for in its windows, and fitted to the end again where some were found.
    fn looked_about(&self, found: FittedHypothesis) -> FittedHypothesis {
        let (h, name) = (&found.hypothesis, found.hypothesis.name());
        let again = self.within_budget(&name, h.unknowns.len(), |data| {
            let looked = data.fit.looked_about(h, &found.fit)?;
            let gains = nats(&found.fit.windows) - nats(&looked.windows) > WORTH_A_ROUND;
            if gains { finish_begun(data, h.clone(), looked, &found) } else { None }
        });
        again.filter(|next| against(&self.data, next) < against(&self.data, &found)).unwrap_or(found)
    }

    fn once_more(&self, best: &FittedHypothesis, finished: usize) -> FittedHypothesis {
        let (h, name) = (&best.hypothesis, best.hypothesis.name());
        let against = |tried: &FittedHypothesis| against(&self.data, tried);
        let starts = starts(best);
        self.progress.begin("the answer, from starts about it", starts.len());
        let begin = |values: Vec<f64>| {
            let begun =
                self.within_budget(&name, h.unknowns.len(), |data| first_steps(data, h, best, &values));
            self.progress.advance(1);
            begun
        };
        let mut begun = starts.into_par_iter().filter_map(begin).collect::<Vec<_>>();
        begun.push(best.fit.clone());
        let places = come_together(&self.data.fit, h, begun, finished);
        self.progress.begin("the answer, from where these came to", places.len());
        let finish = |begun: Fit| {
            let found = self
                .within_budget(&name, h.unknowns.len(), |data| finish_begun(data, h.clone(), begun, best));
            self.progress.advance(1);
            found
        };
        let mut all = places.into_par_iter().filter_map(finish).collect::<Vec<_>>();
        all.push(best.clone());
        let others = all.iter().collect::<Vec<_>>();
        let shared = all.par_iter().map(|one| shared_states(&self.data, one, &others)).collect::<Vec<_>>();
        let lowest = shared.into_iter().min_by(|a, b| against(a).total_cmp(&against(b)));
        lowest.unwrap_or_else(|| best.clone())
    }
}

/// Fits of a hypothesis, those that came to one place as one, with the better state of each window; so many of the most likely places.
fn come_together(problem: &Problem, h: &Hypothesis, mut begun: Vec<Fit>, finished: usize) -> Vec<Fit> {
    let against = |fit: &Fit| nats(&fit.windows) + 0.5 * h.prior_penalty(&fit.values);
    begun.sort_by(|a, b| against(a).total_cmp(&against(b)));
    let mut places: Vec<Fit> = Vec::new();
    for fit in begun {
        match places.iter().position(|place| is_at(place, &fit.values)) {
            Some(known) => places[known].take_better(fit),
            None if places.len() < finished => places.push(fit),
            None => {}
        }
    }
    let again = |place: Fit| {
        let states = place.windows.iter().map(|window| window.x.clone()).collect::<Vec<_>>();
        problem.states(h, &place.values, &states, 0, false)
    };
    places.into_iter().filter_map(again).collect()
}

/// Whether values are as likely as those of a fit but for [`ONE_PLACE`].
fn is_at(place: &Fit, values: &[f64]) -> bool {
    likelihood_apart(place, values) < ONE_PLACE
}

/// By how much values are less likely than those of a fit, in natural logarithms, where windows are linear; without end where nothing is
/// known of that.
fn likelihood_apart(place: &Fit, values: &[f64]) -> f64 {
    let Some(covariance) = place.covariance.clone().and_then(nalgebra::DMatrix::cholesky) else {
        return f64::INFINITY;
    };
    let apart = place.values.iter().zip(values).map(|(own, other)| other - own);
    let apart = DVector::from_iterator(values.len(), apart);
    0.5 * apart.dot(&covariance.solve(&apart))
}

/// The effect or pair of effects that follows the windows with the least error, however unlikely.
fn follows_best(tried: &[FittedHypothesis]) -> Option<&FittedHypothesis> {
    let answers = tried.iter().filter(|t| kinds(t).is_some());
    answers.min_by(|a, b| a.fit_error().total_cmp(&b.fit_error()))
}

/// Whether even the effect that follows the windows best misses many of them.
pub fn follow_few(tried: &[FittedHypothesis]) -> bool {
    follows_best(tried).is_some_and(|best| best.fit.is_far())
}

/// The values with one added number after the other moved; of an effect of more than two, all of them together.
fn starts(best: &FittedHypothesis) -> Vec<Vec<f64>> {
    let h = &best.hypothesis;
    if h.additions.iter().all(|a| matches!(a, Addition::Formula(_))) {
        return starts_of_law(best);
    }
    if h.unknowns.iter().any(Unknown::is_softness) {
        return starts_of_beds(best);
    }
    let of =
        |index: usize| (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index)).collect::<Vec<_>>();
    let together = |numbers: Vec<usize>| match numbers.len() {
        0..=2 => numbers.into_iter().map(|i| vec![i]).collect(),
        _ => vec![numbers],
    };
    let moved = |numbers: &[usize], share: f64| {
        let mut values = best.fit.values.clone();
        for i in numbers {
            values[*i] = h.unknowns[*i].with_share(share, values[*i]);
        }
        values
    };
    let sets = (0..h.additions.len()).flat_map(|index| together(of(index)));
    sets.flat_map(|numbers| ANSWER_SHARES.map(|share| moved(&numbers, share))).collect()
}

/// The values with one number of a law after the other moved, by shares of itself: those of shapes do not start from nothing.
fn starts_of_law(best: &FittedHypothesis) -> Vec<Vec<f64>> {
    let h = &best.hypothesis;
    let moved = |i: usize, share: f64| {
        let mut values = best.fit.values.clone();
        values[i] = h.unknowns[i].within(share * values[i]);
        values
    };
    (h.nuisances..h.unknowns.len()).flat_map(|i| LAW_SHARES.map(|share| moved(i, share))).collect()
}

/// The values with the stiffness of joints that give moved, of both joints together: their windows take long, and in them stiffness is
/// what valleys hold.
fn starts_of_beds(best: &FittedHypothesis) -> Vec<Vec<f64>> {
    let h = &best.hypothesis;
    let moved = |share: f64| {
        let own = h.unknowns.iter().zip(&best.fit.values);
        own.map(|(of, value)| if of.is_softness() { of.with_share(share, *value) } else { *value }).collect()
    };
    BED_SHARES.map(moved).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::starter_with;
    use nalgebra::DMatrix;

    #[test]
    fn analytic_values_are_at_a_place_as_far_as_likelihood_says() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.9, 1.9, 1.0]);
        let place =
            Fit { values: vec![1.0, 2.0], windows: Vec::new(), cost: 0.0, covariance: Some(covariance) };
        // Along what the tests leave open this step costs less than half a logarithm, and across it 39 times as much.
        assert!(is_at(&place, &[1.0, 2.0]) && is_at(&place, &[1.0 + 1.8, 2.0 + 0.9]));
        assert!(!is_at(&place, &[1.0 + 1.8, 2.0 - 0.9]));
        assert!(!is_at(&Fit { covariance: None, ..place }, &[1.0, 2.0]));
    }

    #[test]
    fn analytic_joints_that_give_start_again_from_other_stiffnesses_alone() {
        let hypothesis = starter_with(&["compliant_joint.both", "viscous_damping"]);
        let values = vec![hypothesis.unknowns[0].measure.value_of(7e9), 6e-4, 500.0];
        let fit = Fit { values, windows: Vec::new(), cost: 0.0, covariance: None };
        let best = FittedHypothesis { hypothesis, held_out: fit.clone(), fit };
        let starts = starts(&best);
        assert_eq!(starts.len(), BED_SHARES.len());
        let softness = &best.hypothesis.unknowns[0];
        for (values, share) in starts.iter().zip(BED_SHARES) {
            let moved = (values[0] - softness.start) / (best.fit.values[0] - softness.start);
            assert!((moved / share - 1.0).abs() < 1e-12, "{moved} of {share}");
        }
        assert!(starts.iter().all(|values| values[1..] == [6e-4, 500.0]));
    }
}

//! An answer, or what comes nearest to one, fitted once more from about where it was found.
//!
//! Windows near an impact that the noise decides have several valleys, and which of them a window lies in holds the numbers
//! of a hypothesis where they are. Fits that set out from other numbers find other valleys; the best of all of them is the
//! answer, and its intervals mean something.

use rayon::prelude::*;

use super::Tried;
use super::search::{refit, shared_states};
use super::{Trials, against, kinds};
use crate::Progress;
use crate::limits::{ANSWER_ROUNDS, ANSWER_SHARES, WORTH_A_ROUND};

impl<P: Progress> Trials<'_, P> {
    /// Single effects in order, and where even the one that follows the windows best is far from many of them, that one
    /// refined: what such windows say is at its bound, and a fit ends before the numbers of the right law.
    pub fn with_far_refined(&self, tried: Vec<Tried>) -> Vec<Tried> {
        let answers = tried.iter().filter(|t| kinds(t).is_some());
        let follows = answers.min_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
        let Some(far) = follows.filter(|t| t.fit.is_far()).cloned() else { return tried };
        let refined = self.refined(far);
        self.best_of_each([tried, vec![refined]].concat())
    }

    /// The same additions with the numbers and states that speak least against them.
    pub fn refined(&self, answer: Tried) -> Tried {
        let mut best = answer;
        for _ in 0..ANSWER_ROUNDS {
            let next = self.once_more(&best);
            let gain = against(&self.data, &best) - against(&self.data, &next);
            if gain > 0.0 {
                best = next;
            }
            if gain < WORTH_A_ROUND {
                break;
            }
        }
        best
    }

    fn once_more(&self, best: &Tried) -> Tried {
        let against = |tried: &Tried| against(&self.data, tried);
        let starts = starts(best);
        self.progress.begin("the answer, from starts about it", starts.len());
        let fit = |values: Vec<f64>| {
            let found = refit(&self.data, best.hypothesis.clone(), best, &values);
            self.progress.advance(1);
            found
        };
        let mut all = starts.into_par_iter().filter_map(fit).collect::<Vec<_>>();
        all.push(best.clone());
        let others = all.iter().collect::<Vec<_>>();
        let shared = all.par_iter().map(|one| shared_states(&self.data, one, &others)).collect::<Vec<_>>();
        let lowest = shared.into_iter().min_by(|a, b| against(a).total_cmp(&against(b)));
        let lowest = lowest.unwrap_or_else(|| best.clone());
        let again = refit(&self.data, lowest.hypothesis.clone(), &lowest, &lowest.fit.values);
        again.filter(|again| against(again) < against(&lowest)).unwrap_or(lowest)
    }
}

/// The values with one added number after the other moved; of an addition of more than two, all of them together.
fn starts(best: &Tried) -> Vec<Vec<f64>> {
    let h = &best.hypothesis;
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

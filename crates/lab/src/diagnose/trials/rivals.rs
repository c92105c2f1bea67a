//! Candidates that could imitate the best, fitted from where a linear look puts them.

use rayon::prelude::*;

use super::imitation::{Imitation, imitations};
use super::search::{refit, shared_states};
use super::{Trials, Tried, against, closes, kinds};
use crate::Progress;
use crate::diagnose::hypothesis::{Addition, candidates};
use crate::limits::{IMITATING_PAIRS, IMITATING_SINGLES, NEAR_BEST, SHARING_STATES};
use mrbd_kernel::model::Role;

impl<P: Progress> Trials<'_, P> {
    /// Single effects or pairs; where the best closes the gap, with the candidates that could imitate it.
    pub fn with_imitations(&self, tried: Vec<Tried>, gap: f64) -> Vec<Tried> {
        let Some(best) = tried.first().filter(|t| closes(t, gap) && kinds(t).is_some()) else { return tried };
        let nuisances = &self.experiment.nuisances;
        let candidates = candidates(self.experiment.wall.parameters());
        // Factors on the coefficients of impact would free these of what was known of them.
        let effect = |a: &Addition| a.role().is_some_and(|role| role != Role::Impact);
        let effects = candidates.into_iter().filter(effect).collect::<Vec<_>>();
        let hypothesis = |additions: &[Addition]| self.hypothesis(nuisances, additions);
        let Some(imitations) = imitations(&self.data, best, &effects, hypothesis) else { return tried };
        // A pair that was fitted set out from its better effect; of the others nothing is known.
        let one = best.hypothesis.additions.len() == 1;
        let fitted_before = |i: &Imitation| {
            tried.iter().any(|t| i.additions.iter().all(|a| t.hypothesis.additions.contains(a)))
        };
        let new = imitations.into_iter().filter(|i| one || !fitted_before(i));
        let new = new.take(if one { IMITATING_SINGLES } else { IMITATING_PAIRS }).collect::<Vec<_>>();
        self.progress.begin("candidates that could imitate the best", new.len());
        let fitted = new.par_iter().filter_map(|i| self.fit_from(i, best)).collect::<Vec<_>>();
        self.sharing(self.best_of_each([tried, fitted].concat()))
    }

    /// Fits additions from the values that a linear look about another hypothesis gave them.
    pub(super) fn fit_from(&self, imitation: &Imitation, about: &Tried) -> Option<Tried> {
        let h = self.hypothesis(&self.experiment.nuisances, &imitation.additions);
        let mut values = h.values_from(&about.hypothesis, &about.fit.values);
        values[h.nuisances..].copy_from_slice(&imitation.values);
        let tried = refit(&self.data, h, about, &values);
        self.progress.advance(1);
        tried
    }

    /// The hypotheses near the best with the states that each of them found: a window near an impact that the noise decides
    /// has several valleys, and none shall be told from another by the valleys it met.
    fn sharing(&self, mut tried: Vec<Tried>) -> Vec<Tried> {
        let Some(best) = tried.first() else { return tried };
        let limit = against(&self.data, best) + NEAR_BEST;
        let near = tried.iter().take(SHARING_STATES).filter(|t| against(&self.data, t) < limit).count();
        let others = tried[..near].iter().collect::<Vec<_>>();
        let shared = others.par_iter().map(|t| shared_states(&self.data, t, &others)).collect::<Vec<_>>();
        tried.splice(..near, shared);
        self.ordered(tried)
    }
}

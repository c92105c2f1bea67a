//! Laws of the user's own: fitted as those of the catalogue are, and judged by the same figures.
//!
//! They never are the verdict. What the catalogue says stays as it is without them.
//!
//! Nothing is known of such a law but what is written. A search from afar may end in other valleys of windows than those in which it is
//! right, so it is fitted from the numbers that are written too, in the states of the wall as given and of the answer, which may be near.

use rayon::prelude::*;

use super::search::{refit, shared_states, try_hypothesis};
use super::{FittedHypothesis, Trials, against, all_but_closes, joint_error};
use crate::Progress;
use crate::diagnose::hypothesis::Hypothesis;
use crate::experiment::file::HypothesisTable;
use crate::limits::LEAST_MOVING;

impl<P: Progress> Trials<'_, P> {
    /// Every law of the user's own, in their order, beside a wall as it was given and as it is answered; `None` where no fit makes a wall,
    /// or too little moves.
    pub fn own_hypotheses(
        &self,
        before: &FittedHypothesis,
        answer: &FittedHypothesis,
    ) -> Vec<Option<FittedHypothesis>> {
        let own = &self.experiment.hypotheses;
        if own.is_empty() {
            return Vec::new();
        }
        self.progress.begin("hypotheses of your own", own.len());
        let wall = self.experiment.wall.parameters();
        let fitted = |own: &HypothesisTable| {
            let (scales, nuisances) = (&self.experiment.scales, &self.experiment.nuisances);
            let hypothesis = Hypothesis::of_formula(wall, scales, nuisances, &own.name, &own.formula);
            let moves = self.data.fit.windows.len() >= LEAST_MOVING;
            let fitted = moves.then(|| self.own_hypothesis(hypothesis, before, answer)).flatten();
            self.progress.advance(1);
            fitted
        };
        own.par_iter().map(fitted).collect()
    }

    /// A law of the user's own, by the best of its fits, and from about that where it all but closes the gap.
    fn own_hypothesis(
        &self,
        hypothesis: Hypothesis,
        before: &FittedHypothesis,
        answer: &FittedHypothesis,
    ) -> Option<FittedHypothesis> {
        let as_written = [before, answer].map(|from| {
            let values = hypothesis.values_from(&from.hypothesis, &from.fit.values);
            let (name, numbers) = (hypothesis.name(), values.len());
            self.within_budget(&name, numbers, |data| refit(data, hypothesis.clone(), from, &values))
        });
        let from_afar = try_hypothesis(&self.data, hypothesis.clone(), before);
        let of = |tried: &FittedHypothesis| against(&self.data, tried);
        let fits = as_written.into_iter().chain([from_afar]).flatten();
        let best = fits.min_by(|a, b| of(a).total_cmp(&of(b)))?;
        let best = shared_states(&self.data, &best, &[answer]);
        let closes = joint_error(before).is_some_and(|error| all_but_closes(&best, error));
        Some(if closes { self.refined(best) } else { best })
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{Twin, wall_with};
    use crate::diagnose::trials::with_values;

    /// A spring that goes with the square of displacement.
    const POWER: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-k*sign(x)*abs(x)**n\"\n\
                         [effects.parameters]\nk = { value = 2e5, unit = \"N/m**n\" }\nn = { value = 2.0, unit = \"1\" }\n";

    #[test]
    fn analytic_a_law_is_followed_no_worse_than_with_the_numbers_that_are_written_and_right() {
        let hidden = wall_with(POWER);
        let written = &hidden.parameters().formulas[0];
        let twin = Twin::new(&hidden, 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let (base, scales) = (trials.experiment.wall.parameters(), &trials.experiment.scales);
        let h = Hypothesis::of_formula(base, scales, &trials.experiment.nuisances, "power", written);
        let own = trials.own_hypothesis(h.clone(), &wall.before, &wall.recalibrated).expect("a fit");
        let right = with_values(&trials.data, h.clone(), &wall.before, &h.start()).expect("a wall");
        let afar = try_hypothesis(&trials.data, h, &wall.before).expect("a fit");
        let [own_nats, right, afar] = [&own, &right, &afar].map(|tried| against(&trials.data, tried));
        assert!(own_nats <= right, "{own_nats}, {right} as written");
        assert!(own_nats < afar, "a search from afar alone ends in other valleys");
        let n = own.fit.values[own.hypothesis.unknowns.len() - 1];
        assert!((n - 2.0).abs() < 0.1, "{n}");
        assert_eq!(own.hypothesis.name(), "power");
    }
}

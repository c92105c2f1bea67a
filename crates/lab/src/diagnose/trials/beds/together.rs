//! Joints that give and an effect beside them, where neither shows without the other.
//!
//! A stiff bed under a wall whose damper is missing, too, leaves nearly what a sharp edge leaves: no bed is asked for, and every
//! single effect is as far off as another. About each bed a linear look tells which effect would take away most beside it.

use super::probe::set_bed;
use super::{in_rounds, may_be_named, typical_error};
use crate::Progress;
use crate::diagnose::fit::{Fit, Loss, WindowFit, nats};
use crate::diagnose::hypothesis::{Addition, Hypothesis, beds};
use crate::diagnose::trials::imitation::{Imitation, seconds};
use crate::diagnose::trials::{Data, Few, FittedHypothesis, Trials};
use crate::limits::{
    BED_DAMPING, BED_HALF_DECADES, BEDS_BESIDE_EFFECTS, BEDS_NEAR_BEST, BEDS_TOGETHER, BEDS_TOGETHER_TAKEN,
    BEDS_TOGETHER_WINDOWS, BEDS_WINDOWS,
};
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// Joints that give with an effect of one number beside them, found together, what follows the tests best first; none where few
    /// windows promise little of them.
    pub fn beds_with_effects(&self, wall: &FittedHypothesis) -> Vec<FittedHypothesis> {
        // Under what the wall leaves in most windows a fit feels nearly all of them.
        let few = Few::new(self.data.fit, BEDS_WINDOWS, typical_error(wall));
        let promised = self.promised_together(wall);
        self.progress.begin("joints that give with an effect", promised.len());
        let begin = |promise: &Promise| {
            let begun = self.begun_together(&few, promise);
            self.progress.advance(1);
            begun
        };
        let mut begun = promised.par_iter().filter_map(begin).collect::<Vec<_>>();
        let left = |begun: &(Hypothesis, Fit)| few.excess(&begun.1);
        begun.sort_by(|a, b| left(a).total_cmp(&left(b)));
        let most = (1.0 - BEDS_TOGETHER_TAKEN) * few.excess(&few.of(wall).fit);
        let Some(least) = begun.first().map(left) else { return Vec::new() };
        let near = most.min(BEDS_NEAR_BEST * least.max(1.0));
        begun.retain(|begun| left(begun) < near && may_be_named(begun));
        begun.truncate(BEDS_BESIDE_EFFECTS);
        self.fitted_from(begun)
    }

    /// A bed with an effect fitted to few windows from where a linear look has both.
    fn begun_together(&self, few: &Few, Promise { of, .. }: &Promise) -> Option<(Hypothesis, Fit)> {
        let h = self.hypothesis(&[], &of.additions);
        let problem = few.problem();
        let start = problem.states(&h, &of.values, &problem.measured_states(), 2, false)?;
        let fit = in_rounds(&problem, &h, start)?;
        Some((h, fit))
    }

    /// What linear looks about beds by half decades promise most of, each bed once with each effect.
    fn promised_together(&self, wall: &FittedHypothesis) -> Vec<Promise> {
        let few = Few::new(self.data.fit, BEDS_TOGETHER_WINDOWS, typical_error(wall));
        let data = few.data();
        let effects = self.effects_on_beds();
        let asked = beds().into_iter().flat_map(|bed| BED_HALF_DECADES.map(|k| (bed, k))).collect::<Vec<_>>();
        self.progress.begin("joints that give, looked at with effects", asked.len());
        let look = |(bed, stiffness_pa_per_m): &(Addition, f64)| {
            let found = self.look_beside(&data, *bed, *stiffness_pa_per_m, &effects);
            self.progress.advance(1);
            found.unwrap_or_default()
        };
        best_of_each(asked.par_iter().flat_map_iter(look).collect())
    }

    /// Effects beside a bed of a stiffness, as a linear look about it has them.
    fn look_beside(
        &self,
        data: &Data,
        bed: Addition,
        stiffness_pa_per_m: f64,
        effects: &[Addition],
    ) -> Option<Vec<Promise>> {
        let h = self.hypothesis(&[], &[bed]);
        let mut values = h.start();
        set_bed(&h, &mut values, stiffness_pa_per_m, BED_DAMPING);
        let fit = data.fit.states(&h, &values, &data.fit.measured_states(), 1, false)?;
        let held_out = Fit { windows: Vec::new(), ..fit.clone() };
        let weighted = |window: &WindowFit| Loss::Likelihood.weight(window) * window.squares;
        let squares = fit.windows.iter().map(weighted).sum::<f64>() + h.prior_penalty(&values);
        let against = nats(&fit.windows);
        let bed = FittedHypothesis { hypothesis: h, fit, held_out };
        let found = seconds(data, &bed, effects, |additions| self.hypothesis(&[], additions))?;
        // What is left of weighted squares tells nothing from one bed to another: where a bed misses all windows they weigh little.
        let promise = |of: Imitation| Promise { against: against - 0.5 * (squares - of.left), of };
        Some(found.into_iter().map(promise).collect())
    }
}

/// A bed with an effect, as a linear look has both.
struct Promise {
    of: Imitation,
    /// What windows would say against them, in natural logarithms of likelihood.
    against: f64,
}

/// The first few of promises, the best of each bed with each effect.
fn best_of_each(mut promises: Vec<Promise>) -> Vec<Promise> {
    promises.sort_by(|a, b| a.against.total_cmp(&b.against));
    let mut best: Vec<Promise> = Vec::new();
    for promise in promises {
        if best.len() < BEDS_TOGETHER && best.iter().all(|one| one.of.additions != promise.of.additions) {
            best.push(promise);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{Twin, wall_with};
    use crate::diagnose::trials::joint_error;

    /// A stiff bed in both joints, and a damper at the top.
    const BOTH: &str = "[[effects]]\nkind = \"compliant_joint\"\njoint = \"both\"\nstiffness_pa_per_m = 8e9\n\
                        damping_s = 1e-3\n[[effects]]\nkind = \"viscous_damping\"\ncoefficient_n_s_per_m = 3e3\n";

    #[test]
    fn regress_a_stiff_bed_and_a_damper_are_found_together() {
        let twin = Twin::new(&wall_with(BOTH), 3e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let gap = joint_error(&wall.before);
        assert!(gap > Some(3.0), "{gap:?}");
        assert!(trials.beds(&wall).is_empty(), "no bed is asked for without the damper");
        let found = trials.beds_with_effects(&wall.before);
        let best = found.first().expect("a bed with an effect");
        assert_eq!(best.hypothesis.name(), "compliant_joint.both + viscous_damping");
        assert!(joint_error(best) < Some(1.05), "they follow to the noise");
        let h = &best.hypothesis;
        let numbers = h.unknowns.iter().zip(&best.fit.values).skip(h.nuisances);
        let numbers = numbers.map(|(unknown, value)| unknown.number(*value)).collect::<Vec<_>>();
        // Ten times what this noise moves them by, and more: they are 0.02 and 0.014 % off.
        assert!((numbers[0] / 8e9 - 1.0).abs() < 5e-3, "{numbers:?}");
        assert!((numbers[2] / 3e3 - 1.0).abs() < 2e-3, "{numbers:?}");
    }

    #[test]
    fn analytic_of_each_bed_with_each_effect_the_best_goes_on() {
        let [one, two] = [0, 1].map(|i| vec![beds()[i], Addition::Placebo]);
        let promise = |additions: &[Addition], against: f64| Promise {
            of: Imitation { additions: additions.to_vec(), values: Vec::new(), left: 0.0 },
            against,
        };
        let best = best_of_each(vec![promise(&one, 3.0), promise(&two, 2.0), promise(&one, 1.0)]);
        let best = best.iter().map(|p| (&p.of.additions, p.against)).collect::<Vec<_>>();
        assert_eq!(best, [(&one, 1.0), (&two, 2.0)]);
    }
}

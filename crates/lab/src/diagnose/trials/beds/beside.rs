//! Effects of the catalogue on a wall whose joints give, and beds that are not alike.
//!
//! Another way to model a joint is followed to several noises of good sensors at best. So where an effect is looked for beside
//! joints that give, what these leave stands in the place of noise ([`widened`]). Few windows tell which effects are worth a
//! fit to all of them.

use super::probe::Probe;
use super::{by_excess, excess, in_rounds, may_be_named, relieved, typical_error, widened};
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem, nats};
use crate::diagnose::hypothesis::{Addition, Hypothesis, beds, candidates};
use crate::diagnose::trials::imitation::seconds;
use crate::diagnose::trials::search::{judged_from_measured, states_of, with_values};
use crate::diagnose::trials::{Few, FittedHypothesis, Trials, all_windows, joint_error};
use crate::limits::{
    BEDS_ASKED_FOR, BEDS_BESIDE_EFFECTS, BEDS_NEAR_BEST, BEDS_WINDOWS, BESIDE_BEDS, BESIDE_BEDS_ASKED_FOR,
    BESIDE_BEDS_GAP, BESIDE_BEDS_WINDOWS, REMAINDER_RIVAL, WORTH_A_NAME,
};
use mrbd_kernel::model::Role;
use rayon::prelude::*;

/// How many times as much a fit beside beds may work. In five cases such fits took up to 0.75 of what others may, two beds that are not alike
/// up to 1.1. Beside a bed that stood for a gap a fit was ended at 2.3 of it, which else went on for minutes.
const WORK_ON_BEDS: usize = 2;

impl<P: Progress> Trials<'_, P> {
    /// Joints that give with an effect of one number beside them, or each with a bed of its own, what follows the tests best
    /// first: beside the first of `beds` those that a linear look promises most of, and the best of them beside the other beds.
    pub fn beside_beds(&self, beds: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
        let Some((first, others)) = beds.split_first() else { return Vec::new() };
        let mut found = self.effects_beside(first);
        let Some(best) = found.first().cloned() else { return found };
        let with_effect = best.hypothesis.additions[1..].iter().all(|a| a.role() != Some(Role::Bed));
        let others = others.iter().filter(|_| with_effect).collect::<Vec<_>>();
        found.extend(others.par_iter().filter_map(|bed| self.on_other_bed(bed, &best)).collect::<Vec<_>>());
        in_order_of_likelihood(&mut found);
        self.first_finished(found)
    }

    /// Joints that give beside single effects that follow best on sharp edges, what follows the tests best first: those that take
    /// away a good part of what their effect leaves in few windows.
    ///
    /// However narrow that gap is: a bed so stiff that it hardly shows leaves many times the likelihood of noise in few windows.
    pub fn beds_beside(&self, effects: &[&FittedHypothesis]) -> Vec<FittedHypothesis> {
        let Some(first) = effects.first() else { return Vec::new() };
        let mut begun =
            effects.iter().flat_map(|effect| self.begun_beside(effect, first)).collect::<Vec<_>>();
        by_excess(&mut begun);
        let Some(best) = begun.first().map(|(_, fit)| excess(&fit.windows)) else { return Vec::new() };
        begun.retain(|(_, fit)| excess(&fit.windows) < BEDS_NEAR_BEST * best.max(1.0));
        begun.truncate(BEDS_BESIDE_EFFECTS);
        self.progress.begin("joints that give beside an effect", begun.len());
        let fit = |(h, begun): &(Hypothesis, Fit)| {
            let fitted = self.bed(h, begun);
            self.progress.advance(1);
            fitted
        };
        self.best_finished(begun.par_iter().filter_map(fit).collect())
    }

    /// Joints that give beside an effect, fitted to few windows of which half are those that `first` follows worst; those that take
    /// away a good part of what the effect leaves there, by error or by likelihood.
    fn begun_beside(&self, effect: &FittedHypothesis, first: &FittedHypothesis) -> Vec<(Hypothesis, Fit)> {
        let probe = Probe::beside(self, effect, first);
        let left = probe.left_without();
        let most = 1.0 - BEDS_ASKED_FOR;
        let takes = |fit: &Fit| {
            excess(&fit.windows) < most * excess(&left) || nats(&fit.windows) < most * nats(&left)
        };
        probe.begun().into_iter().filter(|begun| takes(&begun.1) && may_be_named(begun)).collect()
    }

    /// One addition of a pair alone, with the numbers that it has there; `None` if these make no wall.
    pub fn part_of(&self, pair: &FittedHypothesis, addition: Addition) -> Option<FittedHypothesis> {
        let h = self.hypothesis(&self.experiment.nuisances, &[addition]);
        let values = h.values_from(&pair.hypothesis, &pair.fit.values);
        with_values(&self.data, h, pair, &values)
    }

    /// Joints that give without the effect beside them, fitted to the end from where both are.
    pub fn bed_without_effect(&self, both: &FittedHypothesis) -> Option<FittedHypothesis> {
        let beds = both.hypothesis.additions.iter().filter(|a| a.role() == Some(Role::Bed));
        let h = self.hypothesis(&self.experiment.nuisances, &beds.copied().collect::<Vec<_>>());
        let values = h.values_from(&both.hypothesis, &both.fit.values);
        let start = self.data.fit.states(&h, &values, &states_of(&both.fit), 2, false)?;
        let fit = in_rounds(&self.data.fit, &h, start)?;
        self.finished_beside_own_error(&judged_from_measured(&self.data, h, fit)?)
    }

    /// Joints that give beside single effects that follow best on sharp edges, what follows the tests best first: where numbers of
    /// the wall stood for such an effect beside joints that give `alone`, it is not found from there. Fitted to all windows are those
    /// that few windows promise most of; none where that is little.
    pub fn beds_beside_rivals(
        &self,
        alone: &FittedHypothesis,
        rivals: &[FittedHypothesis],
    ) -> Vec<FittedHypothesis> {
        let few = Few::new(self.data.fit, BEDS_WINDOWS, 1.0);
        let most = (1.0 - BESIDE_BEDS_ASKED_FOR) * excess(&few.left(&alone.fit));
        let is_effect = |t: &&FittedHypothesis| {
            let role = t.hypothesis.additions[0].role();
            role.is_some_and(|role| !role.is_at_impacts())
                && t.hypothesis.unknowns.len() == t.hypothesis.nuisances + 1
        };
        let begun = rivals.iter().filter(is_effect).filter_map(|effect| Probe::new(self, effect, None));
        let begun = begun.filter_map(|probe| probe.begun().into_iter().next());
        let mut promising = begun.filter(|(_, fit)| excess(&fit.windows) < most).collect::<Vec<_>>();
        by_excess(&mut promising);
        promising.truncate(BEDS_BESIDE_EFFECTS);
        self.progress.begin("joints that give beside effects on sharp edges", promising.len());
        let fit = |(h, begun): &(Hypothesis, Fit)| {
            let fitted = self.bed(h, begun);
            self.progress.advance(1);
            fitted
        };
        self.best_finished(promising.par_iter().filter_map(fit).collect())
    }

    /// Hypotheses in the order of how they follow all windows, the first fitted to the end.
    pub(super) fn best_finished(&self, mut found: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        let error = |t: &FittedHypothesis| joint_error(t).unwrap_or(f64::INFINITY);
        found.sort_by(|a, b| error(a).total_cmp(&error(b)));
        self.first_finished(found)
    }

    /// The first of hypotheses fitted to the end.
    fn first_finished(&self, mut found: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        if let Some(first) = found.first_mut()
            && let Some(finished) = self.finished_beside_own_error(first)
        {
            *first = finished;
        }
        found
    }

    /// The best of what few windows promise, and what comes near it there, fitted to all; none where that is little.
    fn effects_beside(&self, bed: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let nearly = follows_nearly(bed);
        // What is missing beside a bed that nearly follows shows in the windows that it follows worst.
        let few = match nearly {
            true => Few::followed_worst(self.data.fit, BESIDE_BEDS_WINDOWS, &bed.fit),
            false => Few::new(self.data.fit, BESIDE_BEDS_WINDOWS, typical_error(bed)),
        };
        let mut promised = self.promised(&few, bed);
        let against = |tried: &FittedHypothesis| nats(&tried.fit.windows);
        let left = |tried: &FittedHypothesis| few.excess(&tried.fit);
        // Near the noise few windows that an effect is missed in say more than the error of all.
        match nearly {
            true => promised.sort_by(|a, b| against(a).total_cmp(&against(b))),
            false => promised.sort_by(|a, b| a.fit_error().total_cmp(&b.fit_error())),
        }
        let Some((least, speaks)) = promised.first().map(|first| (left(first), against(first))) else {
            return Vec::new();
        };
        let before = few.of(bed);
        let by_error = least < (1.0 - BESIDE_BEDS_ASKED_FOR) * few.excess(&before.fit);
        let by_likelihood = nearly && against(&before) - speaks > WORTH_A_NAME;
        if !by_error && !by_likelihood {
            return Vec::new();
        }
        // One may follow within the noise: then another must come near that.
        promised.retain(|tried| match nearly {
            true => against(tried) - speaks < WORTH_A_NAME,
            false => left(tried) < REMAINDER_RIVAL * least.max(1.0),
        });
        self.progress.begin("effects beside joints that give", promised.len());
        let fit = |tried: &FittedHypothesis| {
            let fitted = self.in_all_windows_beside(bed, tried);
            self.progress.advance(1);
            fitted
        };
        let mut found = promised.par_iter().filter_map(fit).collect::<Vec<_>>();
        in_order_of_likelihood(&mut found);
        found
    }

    /// Fits to all windows what was fitted to few, with what `bed` leaves in the place of noise.
    fn in_all_windows_beside(
        &self,
        bed: &FittedHypothesis,
        tried: &FittedHypothesis,
    ) -> Option<FittedHypothesis> {
        let tests = widened(self.data.fit.tests, typical_error(bed));
        let wide = Problem { tests: &tests, ..self.data.fit };
        let h = &tried.hypothesis;
        let start = wide.states(h, &tried.fit.values, &states_of(&bed.fit), 2, false)?;
        let found = in_rounds(&wide, h, start)?;
        let found = if follows_nearly(bed) { wide.fit_finely(h, found)? } else { found };
        let Fit { values, covariance, .. } = found;
        let fitted = with_values(&self.data, h.clone(), bed, &values)?;
        Some(FittedHypothesis { fit: Fit { covariance, ..fitted.fit }, ..fitted })
    }

    /// Effects that a linear look promises most of, and beds that are not alike, fitted to few windows. One that comes to joints so stiff
    /// that it works more than it may is none of them.
    fn promised(&self, few: &Few, bed: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let first = few.of(bed);
        let nearly = follows_nearly(bed);
        let data = few.data();
        let effects = self.effects_on_beds();
        let hypothesis = |additions: &[Addition]| self.hypothesis(&self.experiment.nuisances, additions);
        let looked_at = seconds(&data, &first, &effects, hypothesis);
        let promised = looked_at.into_iter().flatten().take(BESIDE_BEDS);
        let mut starts = promised
            .map(|second| {
                let h = hypothesis(&second.additions);
                let mut values = h.values_from(&bed.hypothesis, &bed.fit.values);
                values[h.nuisances..].copy_from_slice(&second.values);
                (h, values)
            })
            .collect::<Vec<_>>();
        starts.extend(self.apart(bed));
        let fit = |(h, values): (Hypothesis, Vec<f64>)| {
            self.within_budget_of(&data, &h.name(), WORK_ON_BEDS * h.unknowns.len(), |data| {
                let start = data.fit.states(&h, &values, &states_of(&first.fit), 2, false)?;
                let fit = in_rounds(&data.fit, &h, start)?;
                let fit = if nearly { data.fit.fit_finely(&h, fit)? } else { fit };
                judged_from_measured(data, h.clone(), fit)
            })
        };
        starts.into_par_iter().filter_map(fit).collect()
    }

    /// Effects that may show beside joints that give: coefficients of impact do nothing on a bed.
    pub(super) fn effects_on_beds(&self) -> Vec<Addition> {
        let is_effect = |a: &Addition| a.role().is_some_and(|role| !role.is_at_impacts());
        candidates(self.experiment.wall.parameters()).into_iter().filter(is_effect).collect()
    }

    /// Both joints with a bed each, from where one bed is: alike where both gave, else stiff at the other joint.
    fn apart(&self, bed: &FittedHypothesis) -> Option<(Hypothesis, Vec<f64>)> {
        let own = bed.hypothesis.additions.first()?;
        let at_one_joint = beds().into_iter().filter(|bed| bed.joint().is_some()).collect::<Vec<_>>();
        let h = self.hypothesis(&self.experiment.nuisances, &at_one_joint);
        let mut values = h.values_from(&bed.hypothesis, &bed.fit.values);
        let of_bed = &bed.fit.values[bed.hypothesis.nuisances..];
        for (index, here) in at_one_joint.iter().enumerate() {
            let gave = own.joint().is_none() || own.joint() == here.joint();
            let numbers = (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
            for (i, value) in numbers.zip(of_bed) {
                let stiffer = !gave && h.unknowns[i].is_softness();
                values[i] = h.unknowns[i].within(if stiffer { AT_THE_OTHER * value } else { *value });
            }
        }
        Some((h, values))
    }

    /// The effect of one hypothesis on a bed at other joints, fitted from the wall as it is known: its numbers may have stood
    /// for the effect while that was missing.
    fn on_other_bed(
        &self,
        bed: &FittedHypothesis,
        with_effect: &FittedHypothesis,
    ) -> Option<FittedHypothesis> {
        let additions = bed.hypothesis.additions.iter().chain(&with_effect.hypothesis.additions[1..]);
        let additions = additions.copied().collect::<Vec<_>>();
        let h = self.hypothesis(&self.experiment.nuisances, &additions);
        let (of_bed, of_effect) =
            (&bed.fit.values[bed.hypothesis.nuisances..], with_effect.fit.values.last()?);
        let known = h.start()[..h.nuisances].to_vec();
        let values = known.iter().chain(of_bed).chain([of_effect]).copied().collect::<Vec<_>>();
        let start = self.data.fit.states(&h, &values, &self.data.fit.measured_states(), 2, false)?;
        let fit = in_rounds(&self.data.fit, &h, start)?;
        judged_from_measured(&self.data, h, fit)
    }
}

/// Softness of the joint that was sharp, over that of the other, from which its own bed is fitted.
const AT_THE_OTHER: f64 = 0.1;

/// Whether joints that give leave so little that windows tell an effect beside them by likelihood. The widest loss, under which
/// fits begin, would move the numbers for a few windows that no state follows.
fn follows_nearly(bed: &FittedHypothesis) -> bool {
    typical_error(bed) < BESIDE_BEDS_GAP
}

/// What the windows say least against first, with what the best typically leaves in the place of noise.
pub fn in_order_of_likelihood(tried: &mut [FittedHypothesis]) {
    let least = tried.iter().map(typical_error).fold(f64::INFINITY, f64::min);
    tried.sort_by(|a, b| nats_beside(least, a).total_cmp(&nats_beside(least, b)));
}

/// What all windows say against a hypothesis, with an error in the place of noise, in natural logarithms of likelihood.
fn nats_beside(error: f64, tried: &FittedHypothesis) -> f64 {
    nats(&relieved(&all_windows(tried), error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::WindowFit;
    use crate::diagnose::hypothesis::example::starter_with;

    /// Windows with so many times the noise, squared, of a hypothesis.
    fn tried(name: &str, reduced: &[f64]) -> FittedHypothesis {
        let window = |reduced: &f64| WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let windows = reduced.iter().map(window).collect();
        let fit = Fit { values: Vec::new(), windows, cost: 0.0, covariance: None };
        let held_out = Fit { windows: Vec::new(), ..fit.clone() };
        FittedHypothesis { hypothesis: starter_with(&[name]), fit, held_out }
    }

    #[test]
    fn analytic_what_most_windows_say_goes_before_few_far_off() {
        let follows_most = tried("cubic_stiffness", &[1.0, 1.1, 1.2, 1.1, 1.0, 900.0, 900.0]);
        let follows_none = tried("gap", &[2.0, 2.0, 2.1, 2.0, 2.0, 100.0, 100.0]);
        assert!(joint_error(&follows_most) > joint_error(&follows_none));
        assert!((typical_error(&follows_most).powi(2) - 1.1).abs() < 1e-12, "few far off do not make it");
        let mut both = [follows_none, follows_most];
        in_order_of_likelihood(&mut both);
        assert_eq!(both[0].hypothesis.name(), "cubic_stiffness");
    }
}

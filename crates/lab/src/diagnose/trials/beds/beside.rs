//! Effects of the catalogue on a wall whose joints give.
//!
//! Another way to model a joint is followed to several noises of good sensors at best. So where an effect is looked for beside
//! joints that give, what these leave stands in the place of noise ([`widened`]).

use super::{in_rounds, own_error, widened};
use crate::Progress;
use crate::diagnose::fit::Problem;
use crate::diagnose::hypothesis::{Addition, candidates};
use crate::diagnose::trials::imitation::{Imitation, seconds};
use crate::diagnose::trials::search::{judged_from_measured, with_values};
use crate::diagnose::trials::{Data, FittedHypothesis, Trials, joint_error};
use crate::experiment::TestData;
use crate::limits::BESIDE_BEDS;
use mrbd_kernel::model::Role;
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// Joints that give with an effect of one number beside them, what follows the tests best first: beside the first of `beds`
    /// those that a linear look promises most of, and the best of them beside the other beds.
    pub fn beside_beds(&self, beds: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
        let Some((first, others)) = beds.split_first() else { return Vec::new() };
        let mut found = self.effects_beside(first);
        let Some(best) = found.first().cloned() else { return found };
        found.extend(others.par_iter().filter_map(|bed| self.on_other_bed(bed, &best)).collect::<Vec<_>>());
        by_error(&mut found);
        if let Some(best) = found.first_mut()
            && let Some(finished) = self.finished_beside_own_error(best)
        {
            *best = finished;
        }
        found
    }

    /// Joints that give beside an effect that takes away much alone.
    pub fn beds_beside(&self, effect: &FittedHypothesis) -> Vec<FittedHypothesis> {
        self.beds_under(&[effect], effect)
    }

    fn effects_beside(&self, bed: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let tests = widened(self.data.fit.tests, own_error(bed));
        let wide = self.on(&tests);
        let Some(first) = with_values(&wide.data, bed.hypothesis.clone(), bed, &bed.fit.values) else {
            return Vec::new();
        };
        // Coefficients of impact do nothing on a bed.
        let is_effect = |a: &Addition| a.role().is_some_and(|role| role != Role::Impact);
        let effects = candidates(self.experiment.wall.parameters()).into_iter().filter(is_effect);
        let hypothesis = |additions: &[Addition]| self.hypothesis(&self.experiment.nuisances, additions);
        let promised = seconds(&wide.data, &first, &effects.collect::<Vec<_>>(), hypothesis);
        let promised = promised.into_iter().flatten().take(BESIDE_BEDS).collect::<Vec<_>>();
        self.progress.begin("effects beside joints that give", promised.len());
        let fit = |second: &Imitation| {
            let found = wide.fit_from(second, &first)?;
            with_values(&self.data, found.hypothesis.clone(), &found, &found.fit.values)
        };
        let mut found = promised.par_iter().filter_map(fit).collect::<Vec<_>>();
        by_error(&mut found);
        found
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

    /// The same windows of other tests.
    fn on<'t>(&'t self, tests: &'t [TestData]) -> Trials<'t, P> {
        let of = |problem: Problem<'t>| Problem { tests, ..problem };
        let data = Data { fit: of(self.data.fit), held_out: of(self.data.held_out) };
        Trials { experiment: self.experiment, data, progress: self.progress }
    }
}

/// What follows the windows best first.
fn by_error(tried: &mut [FittedHypothesis]) {
    let error = |t: &FittedHypothesis| joint_error(t).unwrap_or(f64::INFINITY);
    tried.sort_by(|a, b| error(a).total_cmp(&error(b)));
}

//! A gap that the wall's own numbers close: they are the answer, unless what moved had not been known and effects do as well.

use super::found::Found;
use super::judge::{Answer, Gap};
use super::{Verdict, name_of_number, names};
use crate::Progress;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::hypothesis::{Addition, Nuisance, candidates};
use crate::diagnose::trials::{FittedHypothesis, against};
use crate::limits::{EQUIVALENT, MEASURED_PRIOR, MOVED_SHARE};
use mrbd_kernel::model::{EffectKind, Role};

impl<P: Progress> Gap<'_, P> {
    /// A gap that the wall's own numbers close: an answer, unless what moved had not been known and effects do as well.
    pub(super) fn within_the_wall(self, singles: Vec<FittedHypothesis>) -> Found {
        let unknown = self.moved_unknown();
        if !unknown.is_empty() {
            let instead = self.effects_instead();
            if let Some(answer) = self.as_good_as_the_wall(&instead, &unknown) {
                return self.found(answer, instead);
            }
        }
        let after = self.wall.recalibrated.clone();
        self.found(Answer::of(Verdict::Recalibrated, after), singles)
    }

    /// Uncertain numbers of the wall that were not known and moved.
    fn moved_unknown(&self) -> Vec<Nuisance> {
        let FittedHypothesis { hypothesis, fit, .. } = &self.wall.recalibrated;
        let moved = |nuisance: &&Nuisance| {
            let key = match nuisance {
                Nuisance::Number(number, _) => number.key.to_owned(),
                Nuisance::Coefficient(l, _) => format!("C_{}", l + 1),
            };
            let found = hypothesis.unknowns.iter().zip(&fit.values).find(|(u, _)| u.key == key);
            let change = found.map_or(0.0, |(u, value)| (value / u.start - 1.0).abs());
            nuisance.is_wide() && change > MOVED_SHARE
        };
        self.trials.experiment.nuisances.iter().filter(moved).copied().collect()
    }

    /// Effects in place of numbers of the wall, as if these were known.
    fn effects_instead(&self) -> Vec<FittedHypothesis> {
        let known = |n: &Nuisance| match *n {
            Nuisance::Number(number, sd) => Nuisance::Number(number, sd.min(MEASURED_PRIOR)),
            Nuisance::Coefficient(l, sd) => Nuisance::Coefficient(l, sd.min(MEASURED_PRIOR)),
        };
        let Experiment { nuisances, wall, .. } = self.trials.experiment;
        let nuisances = nuisances.iter().map(known).collect::<Vec<_>>();
        // A second spring that hardly yields is the floor's own, by another name.
        let other_law = |a: &Addition| a.role().is_some_and(|role| role != Role::Memory);
        let sets = candidates(wall.parameters()).into_iter().filter(other_law).map(|a| vec![a]);
        let what = "effects in place of unknown numbers of the wall";
        self.trials.try_all(what, &nuisances, &[&self.wall.before], &sets.collect::<Vec<_>>())
    }

    /// The class of an effect that does as well as numbers of the wall that were not known, and of these.
    fn as_good_as_the_wall(&self, instead: &[FittedHypothesis], unknown: &[Nuisance]) -> Option<Answer> {
        let limit = against(&self.trials.data, &self.wall.recalibrated) + EQUIVALENT;
        let answer = self.named(instead, &self.wall.before)?;
        if against(&self.trials.data, &answer.after) >= limit {
            return None;
        }
        let mut equivalent = answer.equivalent;
        if equivalent.is_empty() {
            equivalent = names(&answer.after);
        }
        equivalent.extend(unknown.iter().map(|n| match n {
            Nuisance::Number(number, _) => name_of_number(number),
            Nuisance::Coefficient(..) => EffectKind::ImpactDissipation.name().to_owned(),
        }));
        equivalent.dedup();
        Some(Answer { equivalent, ..Answer::of(Verdict::Class, answer.after) })
    }
}

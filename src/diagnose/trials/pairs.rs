//! Pairs of effects: the best single ones with every other, as far as a glance promises something.

use rayon::prelude::*;

use super::imitate::seconds;
use super::search::{promise, try_second};
use super::{Progress, Trials, Tried, kinds};
use crate::diagnose::hypothesis::{Addition, Hypothesis, candidates};

/// Effects fitted beside the best single one because a linear look says that they take away most.
const BESIDE: usize = 4;

impl<P: Progress> Trials<'_, P> {
    /// Pairs of the best `paired` single effects with every other, of which `fitted` are fitted.
    pub fn pairs(
        &self,
        singles: &[Tried],
        single: &Tried,
        before: &Tried,
        gap: f64,
        [paired, fitted]: [usize; 2],
    ) -> Vec<Tried> {
        let answers = singles.iter().filter(|t| kinds(t).is_some()).collect::<Vec<_>>();
        let mut sets: Vec<Vec<Addition>> = Vec::new();
        let mut starts = Vec::new();
        for first in answers.iter().take(paired) {
            let one = first.hypothesis.additions[0];
            for second in &answers {
                let two = second.hypothesis.additions[0];
                let same_kind = one.kind() == two.kind();
                if !same_kind && !sets.iter().any(|set| set.contains(&one) && set.contains(&two)) {
                    sets.push(vec![one, two]);
                    starts.push(*first);
                }
            }
        }
        let pairs = self.promising(sets.into_iter().zip(starts).collect(), fitted);
        self.progress.step("pairs of effects", pairs.len());
        let try_one = |(h, first): &(Hypothesis, &Tried)| {
            let tried = try_second(&self.data, h.clone(), first, before);
            self.progress.fitted();
            tried
        };
        let tried = pairs.par_iter().filter_map(try_one).collect();
        let tried = self.finished(self.ordered(tried));
        let nearest = self.beside(answers.first().copied().unwrap_or(single));
        let tried = self.best_of_each([tried, nearest].concat());
        let tried = self.polished(&self.experiment.nuisances, before, tried, single);
        self.with_imitations(self.with_giving(tried), gap)
    }

    /// The best single effect with those that take away most beside it, as far as a linear look tells.
    fn beside(&self, first: &Tried) -> Vec<Tried> {
        let hypothesis = |additions: &[Addition]| self.hypothesis(&self.experiment.nuisances, additions);
        let effects = candidates(self.experiment.wall.parameters());
        let effects = effects.into_iter().filter(|a| a.kind().is_some()).collect::<Vec<_>>();
        let Some(found) = seconds(&self.data, first, &effects, hypothesis) else { return Vec::new() };
        let found = found.into_iter().take(BESIDE).collect::<Vec<_>>();
        self.progress.step("what helps most beside the best", found.len());
        found.par_iter().filter_map(|imitation| self.fit_from(imitation, first)).collect()
    }

    /// The pairs that promise most at a glance, and those of which only a fit would tell.
    fn promising<'t>(
        &self,
        sets: Vec<(Vec<Addition>, &'t Tried)>,
        count: usize,
    ) -> Vec<(Hypothesis, &'t Tried)> {
        self.progress.step("a glance at pairs", sets.len());
        let look = |(set, first): (Vec<Addition>, &'t Tried)| {
            let h = self.hypothesis(&self.experiment.nuisances, &set);
            let cost = promise(&self.data, &h, first).unwrap_or(f64::NEG_INFINITY);
            self.progress.fitted();
            (cost, h, first)
        };
        let mut pairs = sets.into_par_iter().map(look).collect::<Vec<_>>();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs.into_iter().take(count).map(|(_, h, first)| (h, first)).collect()
    }
}

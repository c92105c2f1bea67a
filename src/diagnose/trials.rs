//! Hypotheses tried: single effects, pairs, and the same again from better starts, side by side on all threads.

use rayon::prelude::*;

use super::candidates::candidates;
use super::experiment::Experiment;
use super::finishing::{Coarse, NEAR_BEST, worth_finishing};
use super::hypothesis::{Addition, Hypothesis, Nuisance};
use super::imitate::{Imitation, imitations, seconds};
use super::search::{
    Data, Tried, finish, promise, refit, shared_states, try_coarsely, try_hypothesis, try_second, untouched,
};
use super::verdict::{against, closes, kinds};

/// Pairs, and single effects, that are fitted because they may stand for the best. Chosen: a pair that was the truth once
/// came eighth.
const IMITATIONS: usize = 8;
const SINGLE_IMITATIONS: usize = 4;
/// Effects fitted beside the best single one because a linear look says that they take away most.
const BESIDE: usize = 4;
/// Rivals fitted once more from other starts.
const POLISHED: usize = 3;
/// Gain above which that is worth its time.
const WORTH_POLISH: f64 = 10.0;
/// Best single effects from whose values the wall without effects is fitted again. Chosen: from the best alone, a wall with
/// nothing hidden was once left 3 % off its stiffness, and an effect named for it.
const PARTS: usize = 6;
/// Best rivals whose states the wall without effects tries too.
const SHARING: usize = 8;
/// Most hypotheses that share their states with each other.
const SHARED: usize = 6;
/// Windows in motion below which no effect could be told.
const LEAST_MOVING: usize = 6;

/// Told how far a diagnosis is.
pub trait Progress: Sync {
    /// A step begins, of so many hypotheses.
    fn step(&self, what: &str, hypotheses: usize);
    /// One of them is fitted.
    fn fitted(&self);
}

/// The wall as given, its numbers fitted, and single effects, best first; none of these where too little moves.
pub struct Alone {
    /// The wall as it was given.
    pub before: Tried,
    /// Its uncertain numbers fitted.
    pub recalibrated: Tried,
    /// Single effects.
    pub singles: Vec<Tried>,
}

/// Where hypotheses are tried.
pub struct Trials<'a, P> {
    /// Wall, priors, tests.
    pub experiment: &'a Experiment,
    /// Windows.
    pub data: Data<'a>,
    /// Told how far it is.
    pub progress: &'a P,
}

impl<P: Progress> Trials<'_, P> {
    pub(super) fn hypothesis(&self, nuisances: &[Nuisance], additions: &[Addition]) -> Hypothesis {
        Hypothesis::new(self.experiment.wall.parameters(), &self.experiment.scales, nuisances, additions)
    }

    /// Everything that is tried alone; none if there is no window to start in. The wall's uncertain numbers are fitted from
    /// values `known` from elsewhere too.
    pub fn alone(&self, known: Option<&[f64]>) -> Option<Alone> {
        let nuisances = &self.experiment.nuisances;
        self.progress.step("the wall as given", 2);
        let before = untouched(&self.data, self.hypothesis(&[], &[]))?;
        self.progress.fitted();
        if self.data.fit.windows.len() < LEAST_MOVING {
            let recalibrated = before.clone();
            return Some(Alone { before, recalibrated, singles: Vec::new() });
        }
        let recalibrated = try_hypothesis(&self.data, self.hypothesis(nuisances, &[]), &before)?;
        let known = known.and_then(|v| refit(&self.data, self.hypothesis(nuisances, &[]), &before, v));
        let better = known.filter(|known| against(&self.data, known) < against(&self.data, &recalibrated));
        let recalibrated = better.unwrap_or(recalibrated);
        self.progress.fitted();
        let (recalibrated, singles) = self.singles(&before, recalibrated);
        let best = singles.iter().take(SHARING).collect::<Vec<_>>();
        let [before, recalibrated] =
            [before, recalibrated].map(|tried| shared_states(&self.data, &tried, &best));
        Some(Alone { before, recalibrated, singles })
    }

    /// Single effects, best first, and the wall without effects, each fitted again from what the other found.
    fn singles(&self, before: &Tried, recalibrated: Tried) -> (Tried, Vec<Tried>) {
        let nuisances = &self.experiment.nuisances;
        let additions = candidates(self.experiment.wall.parameters());
        let sets = additions.iter().map(|a| vec![*a]).collect::<Vec<_>>();
        let singles = self.try_all("single effects", nuisances, &self.starts(before, &recalibrated), &sets);
        let nearest = singles.iter().take(PARTS);
        let better = nearest.fold(recalibrated.clone(), |part, whole| self.better_part(part, whole));
        if against(&self.data, &recalibrated) - against(&self.data, &better) < WORTH_POLISH {
            let singles = self.polished(nuisances, before, singles, &better);
            return (better, self.with_giving(singles));
        }
        // What was tried before had missed the same; the best need not have.
        let starts = [Some(&better), singles.first()].into_iter().flatten().collect::<Vec<_>>();
        let again = self.try_all("single effects again", nuisances, &starts, &sets);
        let best = self.best_of_each([singles, again].concat());
        let singles = self.polished(nuisances, before, best, &better);
        (better, self.with_giving(singles))
    }

    /// Where single effects start: from the wall as given, and where one of its numbers was not known, with that fitted.
    fn starts<'t>(&self, before: &'t Tried, recalibrated: &'t Tried) -> Vec<&'t Tried> {
        let wide = self.experiment.nuisances.iter().any(Nuisance::is_wide);
        if wide { vec![before, recalibrated] } else { vec![before] }
    }

    /// Fits every set of additions, and orders them by what speaks against them.
    pub fn try_all(
        &self,
        what: &str,
        nuisances: &[Nuisance],
        from: &[&Tried],
        sets: &[Vec<Addition>],
    ) -> Vec<Tried> {
        self.progress.step(what, sets.len());
        let try_one = |additions: &Vec<Addition>| {
            let tried = try_coarsely(&self.data, self.hypothesis(nuisances, additions), from);
            self.progress.fitted();
            tried
        };
        self.finished(self.ordered(sets.par_iter().filter_map(try_one).collect()))
    }

    /// Finishes the best of coarse fits in order; the others are so far behind that they cannot be the answer.
    fn finished(&self, mut coarse: Vec<Tried>) -> Vec<Tried> {
        let against = |tried: &Tried| against(&self.data, tried);
        let judge = |tried: &Tried| Coarse { against: against(tried), error: tried.fit_error() };
        let judged = coarse.iter().map(judge).collect::<Vec<_>>();
        let chosen = worth_finishing(&judged);
        self.progress.step("the best in full", chosen.len());
        let finish_one = |i: &usize| {
            let finished = finish(&self.data, &coarse[*i]);
            self.progress.fitted();
            finished.filter(|new| against(new) < judged[*i].against)
        };
        let finished = chosen.par_iter().map(finish_one).collect::<Vec<_>>();
        for (i, finished) in chosen.into_iter().zip(finished) {
            if let Some(finished) = finished {
                coarse[i] = finished;
            }
        }
        self.ordered(coarse)
    }

    /// In the order of what speaks against them.
    pub fn ordered(&self, mut tried: Vec<Tried>) -> Vec<Tried> {
        tried.sort_by(|a, b| against(&self.data, a).total_cmp(&against(&self.data, b)));
        tried
    }

    /// The best of hypotheses with the same additions, in order.
    pub(super) fn best_of_each(&self, tried: Vec<Tried>) -> Vec<Tried> {
        let mut best: Vec<Tried> = Vec::new();
        for t in self.ordered(tried) {
            if !best.iter().any(|b| b.hypothesis.additions == t.hypothesis.additions) {
                best.push(t);
            }
        }
        best
    }

    /// Fits the best few once more, from about what was found with the wall's own numbers back where they were; all as they
    /// are if the best gains little over a simpler hypothesis.
    fn polished(
        &self,
        nuisances: &[Nuisance],
        from: &Tried,
        mut tried: Vec<Tried>,
        simpler: &Tried,
    ) -> Vec<Tried> {
        let Some(best) = tried.first() else { return tried };
        if against(&self.data, simpler) - against(&self.data, best) < WORTH_POLISH {
            return tried;
        }
        let count = tried.len().min(POLISHED);
        self.progress.step("the best again", count);
        let again = |old: &Tried| {
            let h = self.hypothesis(nuisances, &old.hypothesis.additions);
            let about = |factor: f64| {
                let shares = (0..h.unknowns.len()).map(|i| if i < h.nuisances { 0.0 } else { factor });
                let values = h.unknowns.iter().zip(shares).zip(&old.fit.values);
                values.map(|((unknown, share), value)| unknown.with_share(share, *value)).collect::<Vec<_>>()
            };
            let tries = [0.92, 1.0, 1.08].map(about);
            let fits = tries.par_iter().filter_map(|values| refit(&self.data, h.clone(), from, values));
            let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
            self.progress.fitted();
            best.filter(|new| new.fit.cost < old.fit.cost).unwrap_or_else(|| old.clone())
        };
        let best = tried[..count].iter().map(again).collect::<Vec<_>>();
        tried.splice(..count, best);
        self.ordered(tried)
    }

    /// A hypothesis, or the same fitted from the values of one that holds more than it, where that is better: a number of
    /// the wall far from its prior is sometimes found beside a further effect only.
    pub fn better_part(&self, part: Tried, whole: &Tried) -> Tried {
        let additions = &part.hypothesis.additions;
        let holds = additions.iter().all(|a| whole.hypothesis.additions.contains(a));
        if !holds || against(&self.data, whole) > against(&self.data, &part) - WORTH_POLISH {
            return part;
        }
        let h = self.hypothesis(&self.experiment.nuisances, additions);
        let values = h.values_from(&whole.hypothesis, &whole.fit.values);
        let again = refit(&self.data, h, whole, &values);
        again.filter(|new| against(&self.data, new) < against(&self.data, &part)).unwrap_or(part)
    }

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

    /// Single effects or pairs, and where the best closes the gap, what may stand for it, from where it would.
    pub fn with_imitations(&self, tried: Vec<Tried>, gap: f64) -> Vec<Tried> {
        let Some(best) = tried.first().filter(|t| closes(t, gap) && kinds(t).is_some()) else { return tried };
        let nuisances = &self.experiment.nuisances;
        let candidates = candidates(self.experiment.wall.parameters());
        // Factors on the coefficients of impact would free these of what was known of them.
        let effect = |a: &Addition| a.kind().is_some_and(|kind| kind != "impact_dissipation");
        let effects = candidates.into_iter().filter(effect).collect::<Vec<_>>();
        let hypothesis = |additions: &[Addition]| self.hypothesis(nuisances, additions);
        let Some(imitations) = imitations(&self.data, best, &effects, hypothesis) else { return tried };
        // A pair that was fitted set out from its better effect; of the others nothing is known.
        let one = best.hypothesis.additions.len() == 1;
        let fitted_before = |i: &Imitation| {
            tried.iter().any(|t| i.additions.iter().all(|a| t.hypothesis.additions.contains(a)))
        };
        let new = imitations.into_iter().filter(|i| one || !fitted_before(i));
        let new = new.take(if one { SINGLE_IMITATIONS } else { IMITATIONS }).collect::<Vec<_>>();
        self.progress.step("what may stand for the best", new.len());
        let fitted = new.par_iter().filter_map(|i| self.fit_from(i, best)).collect::<Vec<_>>();
        self.sharing(self.best_of_each([tried, fitted].concat()))
    }

    /// Fits additions from the values that a linear look about another hypothesis gave them.
    fn fit_from(&self, imitation: &Imitation, about: &Tried) -> Option<Tried> {
        let h = self.hypothesis(&self.experiment.nuisances, &imitation.additions);
        let mut values = h.values_from(&about.hypothesis, &about.fit.values);
        values[h.nuisances..].copy_from_slice(&imitation.values);
        let tried = refit(&self.data, h, about, &values);
        self.progress.fitted();
        tried
    }

    /// The hypotheses near the best with the states that each of them found: a window near an impact that the noise decides
    /// has several valleys, and none shall be told from another by the valleys it met.
    fn sharing(&self, mut tried: Vec<Tried>) -> Vec<Tried> {
        let Some(best) = tried.first() else { return tried };
        let limit = against(&self.data, best) + NEAR_BEST;
        let near = tried.iter().take(SHARED).filter(|t| against(&self.data, t) < limit).count();
        let others = tried[..near].iter().collect::<Vec<_>>();
        let shared = others.par_iter().map(|t| shared_states(&self.data, t, &others)).collect::<Vec<_>>();
        tried.splice(..near, shared);
        self.ordered(tried)
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

//! Effects tried: one by one, and in pairs.
//!
//! A pair is the best single effects with every other, as far as a first look promises something.

use super::imitation::seconds;
use super::search::{promise, refit, shared_states, try_hypothesis, try_second};
use super::{FittedHypothesis, Trials, against, follow_few, kinds, untouched};
use crate::Progress;
use crate::diagnose::hypothesis::{Addition, Hypothesis, Nuisance, candidates};
use crate::limits::{
    BESIDE_THE_BEST, LEAST_MOVING, PAIRED, PAIRS_BESIDE_A_NAME, PAIRS_WITHOUT_A_NAME, PROMISING_PAIR,
    REFITTED_FROM, STATES_FOR_WALL, WORTH_POLISH, WORTH_TRYING_AGAIN,
};
use mrbd_kernel::model::Role;
use rayon::prelude::*;

/// The wall without effects.
#[derive(Clone)]
pub struct WallFits {
    /// As it was given.
    pub before: FittedHypothesis,
    /// Its uncertain numbers fitted.
    pub recalibrated: FittedHypothesis,
}

/// The wall as given, its numbers fitted, and single effects, best first; none of these where too little moves.
pub struct FirstFits {
    /// The wall as it was given.
    pub before: FittedHypothesis,
    /// Its uncertain numbers fitted.
    pub recalibrated: FittedHypothesis,
    /// Single effects.
    pub singles: Vec<FittedHypothesis>,
}

impl<P: Progress> Trials<'_, P> {
    /// The wall without effects; `None` if there is no window to start in. Its uncertain numbers are fitted from values
    /// `known` from elsewhere too, unless too little moves.
    pub fn wall_fits(&self, known: Option<&[f64]>) -> Option<WallFits> {
        let nuisances = &self.experiment.nuisances;
        self.progress.begin("the wall as given", 2);
        let before = untouched(&self.data, self.hypothesis(&[], &[]))?;
        self.progress.advance(1);
        if self.data.fit.windows.len() < LEAST_MOVING {
            return Some(WallFits { recalibrated: before.clone(), before });
        }
        let recalibrated = try_hypothesis(&self.data, self.hypothesis(nuisances, &[]), &before)?;
        let known = known.and_then(|v| refit(&self.data, self.hypothesis(nuisances, &[]), &before, v));
        let better = known.filter(|known| against(&self.data, known) < against(&self.data, &recalibrated));
        let recalibrated = better.unwrap_or(recalibrated);
        self.progress.advance(1);
        Some(WallFits { before, recalibrated })
    }

    /// Everything that is tried alone.
    pub fn first_fits(&self, WallFits { before, recalibrated }: WallFits) -> FirstFits {
        if self.data.fit.windows.len() < LEAST_MOVING {
            return FirstFits { before, recalibrated, singles: Vec::new() };
        }
        let (recalibrated, singles) = self.singles(&before, recalibrated);
        let best = singles.iter().take(STATES_FOR_WALL).collect::<Vec<_>>();
        let [before, recalibrated] =
            [before, recalibrated].map(|tried| shared_states(&self.data, &tried, &best));
        FirstFits { before, recalibrated, singles }
    }

    /// Single effects, best first, and the wall without effects, each fitted again from what the other found.
    fn singles(
        &self,
        before: &FittedHypothesis,
        recalibrated: FittedHypothesis,
    ) -> (FittedHypothesis, Vec<FittedHypothesis>) {
        let nuisances = &self.experiment.nuisances;
        let additions = candidates(self.experiment.wall.parameters());
        let sets = additions.iter().map(|a| vec![*a]).collect::<Vec<_>>();
        let singles = self.try_all("single effects", nuisances, &self.starts(before, &recalibrated), &sets);
        let nearest = singles.iter().take(REFITTED_FROM);
        let better = nearest.fold(recalibrated.clone(), |part, whole| self.better_part(part, whole));
        let worth = WORTH_POLISH.max(WORTH_TRYING_AGAIN * against(&self.data, &better));
        if against(&self.data, &recalibrated) - against(&self.data, &better) < worth {
            let singles = self.polished_if_near(before, singles, &better);
            return (better, self.with_giving(singles));
        }
        // What was tried before had missed the same; the best need not have.
        let starts = [Some(&better), singles.first()].into_iter().flatten().collect::<Vec<_>>();
        let again = self.try_all("single effects again", nuisances, &starts, &sets);
        let best = self.best_of_each([singles, again].concat());
        let singles = self.polished_if_near(before, best, &better);
        (better, self.with_giving(singles))
    }

    /// Single effects in order, the best fitted once more unless even the one that follows best misses many windows: a law outside the
    /// catalogue is looked for before these are.
    fn polished_if_near(
        &self,
        before: &FittedHypothesis,
        singles: Vec<FittedHypothesis>,
        simpler: &FittedHypothesis,
    ) -> Vec<FittedHypothesis> {
        if follow_few(&singles) {
            return singles;
        }
        self.polished(&self.experiment.nuisances, before, singles, simpler)
    }

    /// Single effects in order that even at best miss many windows, fitted once more.
    pub fn far_again(&self, wall: &WallFits, singles: Vec<FittedHypothesis>) -> Vec<FittedHypothesis> {
        if !follow_few(&singles) {
            return singles;
        }
        let again = self.polished(&self.experiment.nuisances, &wall.before, singles, &wall.recalibrated);
        self.with_far_refined(self.with_giving(again))
    }

    /// Where single effects start: from the wall as given, and where one of its numbers was not known, with that fitted.
    pub(super) fn starts<'t>(
        &self,
        before: &'t FittedHypothesis,
        recalibrated: &'t FittedHypothesis,
    ) -> Vec<&'t FittedHypothesis> {
        let wide = self.experiment.nuisances.iter().any(Nuisance::is_wide);
        if wide { vec![before, recalibrated] } else { vec![before] }
    }
}

impl<P: Progress> Trials<'_, P> {
    /// Pairs with the best single effects, where one of them closes a gap by its `name` or where none does.
    pub fn pairs(
        &self,
        singles: &[FittedHypothesis],
        single: &FittedHypothesis,
        before: &FittedHypothesis,
        gap: f64,
        name: bool,
    ) -> Vec<FittedHypothesis> {
        let answers = singles.iter().filter(|t| kinds(t).is_some()).collect::<Vec<_>>();
        let count = if name { PAIRS_BESIDE_A_NAME } else { PAIRS_WITHOUT_A_NAME };
        let pairs = self.promising(&bases(&answers, name), &answers, count);
        self.progress.begin("pairs of effects", pairs.len());
        let try_one = |(h, first): &(Hypothesis, &FittedHypothesis)| {
            let tried = try_second(&self.data, h.clone(), first, before);
            self.progress.advance(1);
            tried
        };
        let tried = pairs.par_iter().filter_map(try_one).collect();
        let tried = self.finished(self.ordered(tried));
        let nearest = self.beside(answers.first().copied().unwrap_or(single));
        let tried = self.best_of_each([tried, nearest].concat());
        let gain = |pair| against(&self.data, single) - against(&self.data, pair);
        if name && tried.first().is_none_or(|pair| gain(pair) < PROMISING_PAIR) {
            return tried;
        }
        let tried = self.polished(&self.experiment.nuisances, before, tried, single);
        self.with_imitations(self.with_giving(tried), gap)
    }

    /// The best single effect with those that take away most beside it, as far as a linear look tells.
    pub fn beside(&self, first: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let hypothesis = |additions: &[Addition]| self.hypothesis(&self.experiment.nuisances, additions);
        let effects = candidates(self.experiment.wall.parameters());
        // Factors on the coefficients of impact would free these of what was known of them.
        let known = self.experiment.nuisances.iter().any(|n| matches!(n, Nuisance::Coefficient(..)));
        let effect = |a: &Addition| a.role().is_some_and(|role| !known || role != Role::Impact);
        let effects = effects.into_iter().filter(effect).collect::<Vec<_>>();
        let Some(found) = seconds(&self.data, first, &effects, hypothesis) else { return Vec::new() };
        let found = found.into_iter().take(BESIDE_THE_BEST).collect::<Vec<_>>();
        self.progress.begin("second effects beside the best", found.len());
        found.par_iter().filter_map(|imitation| self.fit_from(imitation, first)).collect()
    }

    /// Of each base the pairs that promise most at a first look, and those that only a fit can judge. Bases that
    /// follow the windows differently are looked at in different losses.
    fn promising<'t>(
        &self,
        bases: &[&'t FittedHypothesis],
        answers: &[&FittedHypothesis],
        count: usize,
    ) -> Vec<(Hypothesis, &'t FittedHypothesis)> {
        let sets = sets(bases, answers);
        self.progress.begin("pairs of effects, a first look", sets.iter().map(Vec::len).sum());
        let look = |first: &'t FittedHypothesis, set: &[Addition; 2]| {
            let h = self.hypothesis(&self.experiment.nuisances, set);
            let cost = promise(&self.data, &h, first).unwrap_or(f64::NEG_INFINITY);
            self.progress.advance(1);
            (cost, h, first)
        };
        let best = |(first, sets): (&&'t FittedHypothesis, Vec<[Addition; 2]>)| {
            let mut pairs = sets.par_iter().map(|set| look(first, set)).collect::<Vec<_>>();
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
            pairs.into_iter().take(count).map(|(_, h, first)| (h, first)).collect::<Vec<_>>()
        };
        bases.iter().zip(sets).flat_map(best).collect()
    }
}

/// Single effects that are paired with all others: the best. Where none closes the gap, also the second best and the
/// one with the least error over windows. Of a gap far above the noise likelihood says little.
fn bases<'t>(answers: &[&'t FittedHypothesis], name: bool) -> Vec<&'t FittedHypothesis> {
    let mut bases = answers.iter().copied().take(if name { 1 } else { PAIRED }).collect::<Vec<_>>();
    let follows = answers.iter().copied().min_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
    bases.extend(follows.filter(|t| !name && !bases.iter().any(|b| std::ptr::eq(*b, *t))));
    bases
}

/// Of each base its pairs with all others of another kind, or of its own at another joint, each pair once.
fn sets(bases: &[&FittedHypothesis], answers: &[&FittedHypothesis]) -> Vec<Vec<[Addition; 2]>> {
    let addition = |t: &&FittedHypothesis| t.hypothesis.additions[0];
    let bases = bases.iter().map(addition).collect::<Vec<_>>();
    let of = |(i, one): (usize, &Addition)| {
        let new = |two: &Addition| one.stands_beside(two) && !bases[..i].contains(two);
        answers.iter().map(addition).filter(new).map(|two| [*one, two]).collect()
    };
    bases.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Fit, WindowFit};
    use crate::diagnose::hypothesis::example::starter_with;

    /// One effect, followed to a squared error over squared noise.
    fn followed(name: &str, reduced: f64) -> FittedHypothesis {
        let window = WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let of = |windows| Fit { values: vec![0.0], windows, cost: 0.0, covariance: None };
        FittedHypothesis {
            hypothesis: starter_with(&[name]),
            fit: of(vec![window; 10]),
            held_out: of(Vec::new()),
        }
    }

    #[test]
    fn analytic_the_best_and_what_follows_best_are_paired_where_none_closes_the_gap() {
        let all = ["gap", "cubic_stiffness", "carriage_mass", "record_gain"];
        let singles =
            all.iter().zip([4.0, 9.0, 2.0, 16.0]).map(|(name, r)| followed(name, r)).collect::<Vec<_>>();
        let answers = singles.iter().collect::<Vec<_>>();
        let names = |tried: &[&FittedHypothesis]| {
            tried.iter().map(|t| t.hypothesis.additions[0].name()).collect::<Vec<_>>()
        };
        assert_eq!(names(&bases(&answers, true)), ["gap"]);
        let three = bases(&answers, false);
        assert_eq!(names(&three), ["gap", "cubic_stiffness", "carriage_mass"]);
        let pairs = |sets: &Vec<[Addition; 2]>| {
            sets.iter().map(|set| set.map(|a| a.name()).join(" + ")).collect::<Vec<_>>()
        };
        let sets = sets(&three, &answers).iter().map(pairs).collect::<Vec<_>>();
        assert_eq!(sets[0], ["gap + cubic_stiffness", "gap + carriage_mass", "gap + record_gain"]);
        assert_eq!(sets[1], ["cubic_stiffness + carriage_mass", "cubic_stiffness + record_gain"]);
        assert_eq!(sets[2], ["carriage_mass + record_gain"]);
        // The best that follows best is one base.
        let nearer = [followed("gap", 1.0), followed("cubic_stiffness", 2.0)];
        assert_eq!(names(&bases(&[&nearer[0], &nearer[1]], false)), ["gap", "cubic_stiffness"]);
    }
}

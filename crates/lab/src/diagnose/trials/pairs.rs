//! Pairs of effects: the best single ones with every other, as far as a glance promises something.

use rayon::prelude::*;

use super::imitation::seconds;
use super::search::{promise, try_second};
use super::{Trials, Tried, kinds};
use crate::Progress;
use crate::diagnose::hypothesis::{Addition, Hypothesis, Nuisance, candidates};
use crate::limits::{BESIDE_THE_BEST, PAIRED, PAIRS_BESIDE_A_NAME, PAIRS_WITHOUT_A_NAME};
use mrbd_kernel::model::Role;

impl<P: Progress> Trials<'_, P> {
    /// Pairs with the best single effects, where one of them closes a gap by its `name` or where none does.
    pub fn pairs(
        &self,
        singles: &[Tried],
        single: &Tried,
        before: &Tried,
        gap: f64,
        name: bool,
    ) -> Vec<Tried> {
        let answers = singles.iter().filter(|t| kinds(t).is_some()).collect::<Vec<_>>();
        let count = if name { PAIRS_BESIDE_A_NAME } else { PAIRS_WITHOUT_A_NAME };
        let pairs = self.promising(&bases(&answers, name), &answers, count);
        self.progress.begin("pairs of effects", pairs.len());
        let try_one = |(h, first): &(Hypothesis, &Tried)| {
            let tried = try_second(&self.data, h.clone(), first, before);
            self.progress.advance(1);
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
        // Factors on the coefficients of impact would free these of what was known of them.
        let known = self.experiment.nuisances.iter().any(|n| matches!(n, Nuisance::Coefficient(..)));
        let effect = |a: &Addition| a.role().is_some_and(|role| !known || role != Role::Impact);
        let effects = effects.into_iter().filter(effect).collect::<Vec<_>>();
        let Some(found) = seconds(&self.data, first, &effects, hypothesis) else { return Vec::new() };
        let found = found.into_iter().take(BESIDE_THE_BEST).collect::<Vec<_>>();
        self.progress.begin("second effects beside the best", found.len());
        found.par_iter().filter_map(|imitation| self.fit_from(imitation, first)).collect()
    }

    /// Of each base the pairs that promise most at a glance, and those of which only a fit would tell: bases that follow the
    /// windows differently are looked at in different losses.
    fn promising<'t>(
        &self,
        bases: &[&'t Tried],
        answers: &[&Tried],
        count: usize,
    ) -> Vec<(Hypothesis, &'t Tried)> {
        let sets = sets(bases, answers);
        self.progress.begin("pairs of effects, a first look", sets.iter().map(Vec::len).sum());
        let look = |first: &'t Tried, set: &[Addition; 2]| {
            let h = self.hypothesis(&self.experiment.nuisances, set);
            let cost = promise(&self.data, &h, first).unwrap_or(f64::NEG_INFINITY);
            self.progress.advance(1);
            (cost, h, first)
        };
        let best = |(first, sets): (&&'t Tried, Vec<[Addition; 2]>)| {
            let mut pairs = sets.par_iter().map(|set| look(first, set)).collect::<Vec<_>>();
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
            pairs.into_iter().take(count).map(|(_, h, first)| (h, first)).collect::<Vec<_>>()
        };
        bases.iter().zip(sets).flat_map(best).collect()
    }
}

/// Single effects that are paired with all others: the best; where none closes the gap, the second best too, and that which
/// follows the windows with the least error, for of a gap far above the noise likelihood tells little.
fn bases<'t>(answers: &[&'t Tried], name: bool) -> Vec<&'t Tried> {
    let mut bases = answers.iter().copied().take(if name { 1 } else { PAIRED }).collect::<Vec<_>>();
    let follows = answers.iter().copied().min_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
    bases.extend(follows.filter(|t| !name && !bases.iter().any(|b| std::ptr::eq(*b, *t))));
    bases
}

/// Of each base its pairs with all others of another kind, each pair once.
fn sets(bases: &[&Tried], answers: &[&Tried]) -> Vec<Vec<[Addition; 2]>> {
    let addition = |t: &&Tried| t.hypothesis.additions[0];
    let bases = bases.iter().map(addition).collect::<Vec<_>>();
    let of = |(i, one): (usize, &Addition)| {
        let new = |two: &Addition| two.kind() != one.kind() && !bases[..i].contains(two);
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
    fn followed(name: &str, reduced: f64) -> Tried {
        let window = WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let of = |windows| Fit { values: vec![0.0], windows, cost: 0.0, covariance: None };
        Tried { hypothesis: starter_with(&[name]), fit: of(vec![window; 10]), held_out: of(Vec::new()) }
    }

    #[test]
    fn analytic_the_best_and_what_follows_best_are_paired_where_none_closes_the_gap() {
        let all = ["gap", "cubic_stiffness", "carriage_mass", "record_gain"];
        let singles =
            all.iter().zip([4.0, 9.0, 2.0, 16.0]).map(|(name, r)| followed(name, r)).collect::<Vec<_>>();
        let answers = singles.iter().collect::<Vec<_>>();
        let names =
            |tried: &[&Tried]| tried.iter().map(|t| t.hypothesis.additions[0].name()).collect::<Vec<_>>();
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

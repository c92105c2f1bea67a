//! Joints that give beside an effect, where that is not enough on sharp edges and windows did not ask for beds alone; and in the place of an
//! indented corner, which they may look like.

use super::found::Found;
use super::judge::{Answer, Gap};
use super::on_beds::{Standing, comes_near, following_alone, follows, is_worth_it};
use super::remainder::is_soft;
use super::{Verdict, names, names_of_all};
use crate::Progress;
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{
    FittedHypothesis, Trials, WallFits, does_something, first_of_each, joint_error,
};
use crate::limits::{BEDS_BESIDE_EFFECTS, EQUIVALENT, NARROW_GAP};
use mrbd_kernel::model::Role;
use std::ops::ControlFlow;

/// Joints that give beside an effect that was tried on sharp edges, and is not enough there.
pub struct BedsBeside {
    effect: FittedHypothesis,
    /// The bed of the best alone.
    alone: FittedHypothesis,
    best: FittedHypothesis,
    near: Vec<FittedHypothesis>,
}

impl BedsBeside {
    /// Beside one of the single effects that follow best, where beds take away what it leaves.
    pub fn an_effect<P: Progress>(trials: &Trials<P>, singles: &[FittedHypothesis]) -> Option<Self> {
        if !may_have_beds_beside(trials) {
            return None;
        }
        Self::one_of(trials, singles, &following_best(singles))
    }

    /// The same beside an effect of a pair that follows best and leaves more than noise, begun with the numbers that the pair has:
    /// something else may stand there for the bed that is missing, beside which alone the effect was not seen.
    pub fn an_effect_of_pairs<P: Progress>(trials: &Trials<P>, tried: &[FittedHypothesis]) -> Option<Self> {
        if !may_have_beds_beside(trials) {
            return None;
        }
        let pair = tried.iter().find(|t| t.hypothesis.additions.len() == 2)?;
        let singles = tried.iter().filter(|t| t.hypothesis.additions.len() == 1).cloned().collect::<Vec<_>>();
        let seen = following_best(&singles);
        let is_new =
            |a: &&Addition| is_effect(a) && !seen.iter().any(|one| one.hypothesis.additions[0] == **a);
        let new = pair.hypothesis.additions.iter().filter(is_new);
        let parts = new.filter_map(|addition| trials.part_of(pair, *addition)).collect::<Vec<_>>();
        Self::one_of(trials, &singles, &parts.iter().collect::<Vec<_>>())
    }

    /// The same beside an effect that is found with them, where neither shows without the other and the wall as given leaves a
    /// gap that is not narrow.
    pub fn found_together<P: Progress>(
        trials: &Trials<P>,
        before: &FittedHypothesis,
        tried: &[FittedHypothesis],
    ) -> Option<Self> {
        if !may_have_beds_beside(trials) || joint_error(before)? < NARROW_GAP {
            return None;
        }
        Self::best_of(trials, tried, &trials.beds_with_effects(before))
    }

    /// The same beside one of some effects, each of which was tried alone among `singles`.
    fn one_of<P: Progress>(
        trials: &Trials<P>,
        singles: &[FittedHypothesis],
        effects: &[&FittedHypothesis],
    ) -> Option<Self> {
        Self::best_of(trials, singles, &trials.beds_beside(effects))
    }

    /// The first of some beds with an effect each, which was tried alone among others.
    fn best_of<P: Progress>(
        trials: &Trials<P>,
        tried: &[FittedHypothesis],
        beds: &[FittedHypothesis],
    ) -> Option<Self> {
        let (best, others) = beds.split_first()?;
        let effect = tried.iter().find(|one| is_alone_in(best, one))?.clone();
        let alone = trials.bed_without_effect(best)?;
        let is_other =
            |other: &&FittedHypothesis| names(other) != names(best) && comes_near(trials, best, other);
        let near = others.iter().filter(is_other).cloned().collect();
        Some(Self { effect, alone, best: trials.beds_refined(best.clone()), near })
    }

    /// The verdict where they follow to the noise, and no effect on sharp edges does nearly as well beside the same effect; or where
    /// the bed does so without the effect, by which it was only found.
    pub fn following<P: Progress>(
        &self,
        trials: &Trials<P>,
        wall: &WallFits,
        tried: &[FittedHypothesis],
    ) -> Option<Found> {
        if !is_worth_it(trials, wall, &self.alone, &self.best)
            && let Some(found) = following_alone(trials, wall, std::slice::from_ref(&self.alone), tried)
        {
            return Some(found);
        }
        if !follows(trials, wall, &self.best, tried) {
            return None;
        }
        let all = [tried, &trials.beside(&self.effect)].concat();
        self.leaving_little(trials, wall, &all).filter(|found| found.remainder.is_none())
    }

    /// The verdict where what they leave is noise, or little that nothing tried comes near.
    pub fn leaving_little<P: Progress>(
        &self,
        trials: &Trials<P>,
        wall: &WallFits,
        tried: &[FittedHypothesis],
    ) -> Option<Found> {
        let Self { effect, alone, best, near } = self;
        let standing = Standing::of(trials, wall, best, tried)?;
        let all = || [&[best.clone(), alone.clone()], &near[..], tried].concat();
        let is_worth_both = [effect, alone].iter().all(|one| is_worth_it(trials, wall, one, best));
        (is_worth_both && is_soft(best)).then(|| standing.found(trials, wall, best.clone(), near, all()))
    }
}

impl<P: Progress> Gap<'_, P> {
    /// Joints that give beside an effect, unless two effects on sharp edges close the gap and say more: a gap with other impacts follows as a
    /// bed with a damper, to 1.02 noises. Where neither says more, both are the answer.
    pub(super) fn unless_pairs_do_better(&self, on_beds: Found, on_edges: Option<&Answer>) -> Option<Found> {
        let Some(pair) = on_edges else { return Some(on_beds) };
        let gain = self.gain(&on_beds.after, &pair.after);
        if gain > EQUIVALENT {
            return None;
        }
        if gain < -EQUIVALENT {
            return Some(on_beds);
        }
        let of_both = names_of_all(&on_beds.after, [&pair.after]);
        let equivalent = joined(on_beds.equivalent, of_both);
        Some(Found { verdict: Verdict::Class, equivalent, ..on_beds })
    }

    /// An answer with an indented corner, held against joints that give in the corner's place: in motion of about one size a bed turns a body
    /// about a line within its edge, as an indented corner does. Where they say more that ends with them, and where they follow to the
    /// noise they make a class with it: what another way to model a bed leaves may be more than what tells the two apart. With the answer
    /// goes everything tried.
    pub(super) fn beside_bed_in_place_of_corner(
        &self,
        answer: Answer,
        tried: Vec<FittedHypothesis>,
    ) -> ControlFlow<Found, (Answer, Vec<FittedHypothesis>)> {
        let Some(found) = self.bed_in_place_of_corner(&answer.after, &tried) else {
            return ControlFlow::Continue((answer, tried));
        };
        let says_more = self.gain(&answer.after, &found.after) > EQUIVALENT;
        let of_both = names_of_all(&answer.after, [&found.after]);
        let tried = first_of_each(self.trials.ordered([found.tried.clone(), tried].concat()));
        if says_more {
            return ControlFlow::Break(Found { tried, ..found });
        }
        if found.remainder.is_some() {
            return ControlFlow::Continue((answer, tried));
        }
        let equivalent = joined(answer.equivalent, of_both);
        ControlFlow::Continue((Answer { verdict: Verdict::Class, equivalent, ..answer }, tried))
    }

    /// Joints that give with what else an answer with an indented corner has, if it has one and they may be named beside all other edges.
    fn bed_in_place_of_corner(&self, named: &FittedHypothesis, tried: &[FittedHypothesis]) -> Option<Found> {
        let has_corner =
            |t: &FittedHypothesis| t.hypothesis.additions.iter().any(|a| a.role() == Some(Role::Corners));
        if !has_corner(named) || !may_have_beds_beside(self.trials) {
            return None;
        }
        let others = tried.iter().filter(|t| !has_corner(t)).cloned().collect::<Vec<_>>();
        let mut beside = named.hypothesis.additions.iter().filter(|a| a.role() != Some(Role::Corners));
        let Some(effect) = beside.next() else {
            return following_alone(self.trials, &self.wall, &self.trials.beds_unasked(&self.wall), &others);
        };
        let part = self.trials.part_of(named, *effect)?;
        BedsBeside::one_of(self.trials, &others, &[&part])?.leaving_little(self.trials, &self.wall, &others)
    }
}

/// Names, with those of some more that are new.
fn joined(names: Vec<String>, more: Vec<String>) -> Vec<String> {
    let new = more.into_iter().filter(|name| !names.contains(name)).collect::<Vec<_>>();
    [names, new].concat()
}

/// Whether an effect beside joints that give could be told: a strip whose top is held shows one moment, and a wall with beds of its own
/// gets no others.
fn may_have_beds_beside<P: Progress>(trials: &Trials<P>) -> bool {
    !trials.is_held() && !trials.experiment.wall.gives()
}

/// The single effects that do something and follow best: by what speaks against them, and by error.
fn following_best(singles: &[FittedHypothesis]) -> Vec<&FittedHypothesis> {
    let effects = singles
        .iter()
        .filter(|t| is_effect(&t.hypothesis.additions[0]) && does_something(t))
        .collect::<Vec<_>>();
    let mut by_error = effects.clone();
    by_error.sort_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
    let mut best: Vec<&FittedHypothesis> = Vec::new();
    for effect in by_error.into_iter().take(BEDS_BESIDE_EFFECTS - 1).chain(effects) {
        if best.len() < BEDS_BESIDE_EFFECTS && !best.iter().any(|other| std::ptr::eq(*other, effect)) {
            best.push(effect);
        }
    }
    best
}

/// Whether a hypothesis is a single effect that another has, too.
fn is_alone_in(both: &FittedHypothesis, effect: &FittedHypothesis) -> bool {
    let additions = &effect.hypothesis.additions;
    additions.len() == 1 && both.hypothesis.additions.contains(&additions[0])
}

/// Whether an addition is an effect on what acts on the wall: coefficients of impact do nothing on a bed.
fn is_effect(addition: &Addition) -> bool {
    addition.role().is_some_and(|role| !role.is_at_impacts())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{DRAG, Twin, wall_with};
    use crate::diagnose::hypothesis::candidates;
    use crate::diagnose::trials::joint_error;

    #[test]
    fn analytic_a_bed_beside_an_effect_gives_way_to_two_effects_on_sharp_edges_that_say_more() {
        let twin = Twin::new(&wall_with(DRAG), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let error = joint_error(&wall.before).expect("windows");
        let WallFits { before, recalibrated } = wall.clone();
        let gap = Gap::new(&trials, wall, error);
        let [one, two] = [0, 1].map(|i| candidates(trials.experiment.wall.parameters())[i]);
        // Of a window that is followed to less than its noise, natural logarithms are half of the squares.
        let says = |effect: Addition, more: f64| {
            let mut tried = recalibrated.clone();
            tried.hypothesis.additions = vec![effect];
            let window = &mut tried.fit.windows[0];
            window.squares = window.freedom - 2.0 * (2.0 * EQUIVALENT + more);
            tried
        };
        let on_beds =
            |after| Found { after, ..Found::in_vain(Verdict::Named, &before, recalibrated.clone()) };
        let verdict = |more: f64| {
            let pair = Answer::of(Verdict::Named, says(two, more));
            let found = gap.unless_pairs_do_better(on_beds(says(one, 0.0)), Some(&pair))?;
            Some((found.verdict, found.equivalent))
        };
        let of_both = [one, two].into_iter().flat_map(|effect| names(&says(effect, 0.0)));
        let class = Some((Verdict::Class, of_both.collect::<Vec<_>>()));
        assert_eq!(class.as_ref().map(|(_, names)| names.len()), Some(2));
        assert_eq!(verdict(EQUIVALENT + 1.0), None, "two effects say more");
        assert_eq!(verdict(0.5 * EQUIVALENT), class);
        assert_eq!(verdict(-0.5 * EQUIVALENT), class);
        assert_eq!(verdict(-EQUIVALENT - 1.0), Some((Verdict::Named, Vec::new())), "the bed says more");
        let alone = gap.unless_pairs_do_better(on_beds(says(one, 0.0)), None).map(|found| found.verdict);
        assert_eq!(alone, Some(Verdict::Named));
    }

    #[test]
    fn analytic_an_indented_corner_is_held_against_joints_that_give() {
        const BED: &str = "[[effects]]\nkind = \"compliant_joint\"\njoint = \"ground\"\n\
                           stiffness_pa_per_m = 7e7\ndamping_s = 1e-3\n";
        let twin = Twin::new(&wall_with(BED), 3e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let error = joint_error(&wall.before).expect("windows");
        let gap = Gap::new(&trials, wall.clone(), error);
        let all = candidates(trials.experiment.wall.parameters());
        let corner = all.into_iter().find(|a| a.name() == "corner_indentation.ground").expect("an effect");
        // An answer that leaves so much of the squared noise in every window.
        let leaving = |share: f64| {
            let mut after = wall.recalibrated.clone();
            after.hypothesis.additions = vec![corner];
            for window in after.fit.windows.iter_mut().chain(&mut after.held_out.windows) {
                window.squares = share * window.freedom;
            }
            gap.beside_bed_in_place_of_corner(Answer::of(Verdict::Named, after), Vec::new())
        };
        match leaving(1.5) {
            ControlFlow::Break(found) => assert_eq!(names(&found.after), ["compliant_joint"]),
            ControlFlow::Continue(_) => panic!("the bed says more"),
        }
        match leaving(0.9) {
            ControlFlow::Continue((answer, tried)) => {
                assert!(tried.iter().any(|t| names(t) == ["compliant_joint"]), "its numbers are told");
                assert_eq!(answer.verdict, Verdict::Class);
                assert_eq!(answer.equivalent, ["corner_indentation", "compliant_joint"]);
            }
            ControlFlow::Break(_) => panic!("the corner says more"),
        }
    }
}

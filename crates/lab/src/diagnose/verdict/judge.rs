//! From what was tried alone to the verdict: nothing missing, the wall's own numbers, one effect, two, or a place.

use std::cell::OnceCell;
use std::ops::ControlFlow;

use super::at_impacts::{
    NamedBetween, is_near_other_impacts, named_between, only_impacts, worth_two_between,
};
use super::beds_beside::BedsBeside;
use super::found::Found;
use super::names_of_all;
use super::on_beds::{on_beds_instead, on_beds_last};
use super::worth_naming::{could_show, place, worth_two};
use super::{OtherLaw, Verdict};
use crate::Progress;
use crate::diagnose::discovery::{Discovered, Relatives};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{
    FirstFits, FittedHypothesis, Trials, WallFits, against, best_answer, closes, does_something, follow_few,
    is_noise, joint_error, kinds,
};
use crate::limits::{EQUIVALENT, HELD_OUT_ERROR, WORTH_A_NAME, WORTH_PAIRS};

/// A hypothesis that may be the answer.
pub(super) struct Answer {
    pub(super) verdict: Verdict,
    pub(super) after: FittedHypothesis,
    /// Names of what cannot be told from it.
    pub(super) equivalent: Vec<String>,
    /// Whether it is named by what it leaves between impacts.
    pub(super) between_impacts: bool,
}

impl Answer {
    /// A hypothesis that nothing comes near.
    pub(super) const fn of(verdict: Verdict, after: FittedHypothesis) -> Self {
        Self { verdict, after, equivalent: Vec::new(), between_impacts: false }
    }

    /// By name, alone or in a class.
    fn named(after: FittedHypothesis, equivalent: Vec<String>) -> Self {
        let verdict = if equivalent.is_empty() { Verdict::Named } else { Verdict::Class };
        Self { equivalent, ..Self::of(verdict, after) }
    }
}

/// The verdict on what effects did to the windows one by one.
pub fn judge<P: Progress>(trials: &Trials<P>, first_fits: FirstFits) -> Found {
    let FirstFits { before, recalibrated, singles } = first_fits;
    match joint_error(&before) {
        Some(error) if !singles.is_empty() => {
            Gap::new(trials, WallFits { before, recalibrated }, error).judge(singles)
        }
        // Too little moves for anything to show.
        _ => Found {
            verdict: Verdict::NoPower,
            recalibrated: before.clone(),
            after: before.clone(),
            before,
            equivalent: Vec::new(),
            place: None,
            remainder: None,
            other_law: None,
            discovered: None,
            tried: Vec::new(),
        },
    }
}

/// A law outside the catalogue of one atom or two and nothing else; `None` where none holds, or an effect does by name that no law outdoes.
pub fn judge_laws<P: Progress>(trials: &Trials<P>, first_fits: FirstFits) -> Option<Found> {
    let (gap, singles) = Gap::of_laws(trials, first_fits)?;
    if gap.named(&singles, &gap.wall.recalibrated).is_some() {
        // Whether a name gives way to a law hangs on all that is tried.
        let found = gap.judge(singles);
        return found.verdict.is_formula().then_some(found);
    }
    let told = gap.told_early(&singles).or_else(|| gap.of_up_to_two_atoms(&singles))?;
    gap.told(told, singles)
}

/// The same in windows that tests held out share with those fitted, of which an answer was found `before`: the law that the latter tell, if they
/// tell one, with an atom that only the larger motion reaches, or else one that is told before joints that give are tried, or any of one atom
/// where nothing was said.
pub fn judge_laws_beyond<P: Progress>(
    trials: &Trials<P>,
    first_fits: FirstFits,
    before: &Found,
) -> Option<Found> {
    let (gap, singles) = Gap::of_laws(trials, first_fits)?;
    if gap.named(&singles, &gap.wall.recalibrated).is_some() {
        return None;
    }
    let beyond = before.asked_for_more().and_then(|law| gap.beyond(law, &singles));
    let told = beyond.or_else(|| gap.told_early(&singles)).or_else(|| {
        let says_nothing = before.says_nothing_of_what_is_held_out();
        if says_nothing { gap.told_where_nothing_was_said() } else { None }
    })?;
    gap.told(told, singles)
}

/// A gap between model and measurement, or none.
pub(super) struct Gap<'t, P> {
    pub(super) trials: &'t Trials<'t, P>,
    /// The wall without effects.
    pub(super) wall: WallFits,
    /// Windowed error of the wall as given.
    pub(super) error: f64,
    /// Laws outside the catalogue, where they were looked for before the best effect is fitted once more or joints that give beside it.
    pub(super) early: OnceCell<Discovered>,
}

impl<'t, P: Progress> Gap<'t, P> {
    /// The gap that the wall as given leaves, of this windowed error.
    pub(super) fn new(trials: &'t Trials<'t, P>, wall: WallFits, error: f64) -> Self {
        Self { trials, wall, error, early: OnceCell::new() }
    }
}

impl<'t, P: Progress> Gap<'t, P> {
    /// A gap of which only laws outside the catalogue are asked, and effects one by one.
    fn of_laws(trials: &'t Trials<'t, P>, first_fits: FirstFits) -> Option<(Self, Vec<FittedHypothesis>)> {
        let FirstFits { before, recalibrated, singles } = first_fits;
        let error = joint_error(&before)?;
        Some((Self::new(trials, WallFits { before, recalibrated }, error), singles))
    }
}

impl<P: Progress> Gap<'_, P> {
    /// A law as the answer.
    fn told(self, law: Discovered, singles: Vec<FittedHypothesis>) -> Option<Found> {
        let found = self.placed_by(Some(law), None, singles);
        found.verdict.is_formula().then_some(found)
    }

    fn judge(self, singles: Vec<FittedHypothesis>) -> Found {
        let gain = best_answer(&singles).map_or(0.0, |best| self.gain(&self.wall.recalibrated, best));
        if gain < WORTH_A_NAME {
            let is_given = is_noise(&self.wall.before);
            if is_given || is_noise(&self.wall.recalibrated) || closes(&self.wall.recalibrated, self.error) {
                if let Some(law) = self.law_that_shows(&singles) {
                    return self.placed_by(Some(law), None, singles);
                }
                return if is_given { self.nothing_missing(singles) } else { self.within_the_wall(singles) };
            }
        }
        self.with_effects(singles, gain)
    }

    /// The wall as given follows the tests, if an effect could have shown.
    fn nothing_missing(self, singles: Vec<FittedHypothesis>) -> Found {
        let could = could_show(&self.trials.data, &self.wall.recalibrated, &singles);
        let verdict = if could { Verdict::None } else { Verdict::NoPower };
        let after = self.wall.before.clone();
        self.found(Answer::of(verdict, after), singles)
    }

    /// One effect or two by name, or the place of what is missing.
    fn with_effects(self, singles: Vec<FittedHypothesis>, gain: f64) -> Found {
        let early = if follow_few(&singles) { self.told_early(&singles) } else { None };
        let singles = if early.is_some() { singles } else { self.trials.far_again(&self.wall, singles) };
        let singles = self.trials.with_imitations(singles, self.error);
        if self.only_other_impacts(&singles) {
            return match self.law_beyond_impacts(&singles) {
                Some(law) => self.placed_by(Some(law), None, singles),
                None => self.other_impacts(singles),
            };
        }
        let one = self.named(&singles, &self.wall.recalibrated);
        if one.is_none() && place(&self.trials.data, &self.wall.recalibrated, &singles).is_none() {
            let before = only_impacts(self.trials, &self.wall.before, &singles);
            if before || only_impacts(self.trials, &self.wall.recalibrated, &singles) {
                if let Some(law) = self.law_beyond_impacts(&singles) {
                    return self.placed_by(Some(law), None, singles);
                }
                // A stiff bed shows at impacts, too.
                let on_beds = on_beds_last(self.trials, &self.wall, &singles, &[]);
                return on_beds.unwrap_or_else(|| match before {
                    true => self.nothing_missing(singles),
                    false => self.within_the_wall(singles),
                });
            }
        }
        let gives_way = |name: &Answer, early: &Option<Discovered>| {
            let law = early.as_ref().and_then(|early| early.equals.first());
            law.is_some_and(|law| self.outdoes(law, &name.after))
        };
        let one = one.filter(|one| !gives_way(one, &early));
        // Where every effect misses many windows and one atom leaves noise, two effects of the catalogue would be two atoms: points, which
        // weigh all of these, would say more of them.
        if one.is_none() && early.as_ref().is_some_and(Discovered::is_all_of_one_atom) {
            return self.placed_by(early, None, singles);
        }
        // What a window can say is bounded: of a gap far above the noise a single effect may take little of it, and two all.
        let far = joint_error(&self.wall.recalibrated).is_some_and(|error| error > HELD_OUT_ERROR);
        if one.is_none() && !far && gain <= WORTH_PAIRS {
            return self.placed(None, singles);
        }
        let instead = |one: &Answer| on_beds_instead(self.trials, &self.wall, &one.after, &singles);
        if let Some(found) = one.as_ref().and_then(instead) {
            return found;
        }
        // A force that is told at the top is none of joints that give, and these take long to fit.
        let early = early.or_else(|| if one.is_none() { self.told_early(&singles) } else { None });
        // Two effects that one atom stands for to the noise leave each alone near it: points must have seen them.
        if one.is_none() && early.as_ref().is_some_and(Discovered::is_all_of_one_atom_by_points) {
            return self.placed_by(early, None, singles);
        }
        let may_give = one.is_none() && early.is_none() && !self.closes_by_law_at_top();
        let beds = if may_give { BedsBeside::an_effect(self.trials, &singles) } else { None };
        let follow = beds.as_ref().and_then(|beds| beds.following(self.trials, &self.wall, &singles));
        let (answer, tried) = self.with_pairs(one, singles);
        if let Some(found) = follow.and_then(|found| self.unless_pairs_do_better(found, answer.as_ref())) {
            return found;
        }
        let answer = answer.filter(|answer| !gives_way(answer, &early));
        // Beside a second effect factors on impacts may be found that follow to the noise, and say no more than that impacts are
        // those of another formulation. What leaves more has no name by what it leaves between them.
        let tried = self.trials.ordered(tried);
        let between = answer.as_ref().filter(|answer| answer.between_impacts);
        if between.is_some_and(|answer| self.follow_other_impacts(&answer.after, &tried)) {
            return self.other_impacts(tried);
        }
        let Some(answer) = answer else {
            if early.is_some() {
                return self.placed_by(early, None, tried);
            }
            let little = |beds: BedsBeside| beds.leaving_little(self.trials, &self.wall, &tried);
            let of_pairs = || BedsBeside::an_effect_of_pairs(self.trials, &tried);
            let found = beds.and_then(little).or_else(|| of_pairs().and_then(little));
            if let Some(found) = found {
                return self.or_another_law(found, || None);
            }
            let discovered = self.discovered(&tried, &[]);
            // A force that is told along the direction of the top is none of joints that give, and these take long to fit.
            if discovered.as_ref().is_some_and(|one| self.is_told_at_top(one)) {
                return self.placed_by(discovered, None, tried);
            }
            let laws = discovered.as_ref().map_or(&[][..], |one| &one.tried);
            let found = on_beds_last(self.trials, &self.wall, &tried, laws);
            let is_told = discovered.as_ref().is_some_and(|one| !one.equals.is_empty());
            if found.is_none() && !is_told {
                let all = [&tried[..], laws].concat();
                let beds = BedsBeside::found_together(self.trials, &self.wall.before, &all);
                if let Some(found) = beds.and_then(|beds| beds.leaving_little(self.trials, &self.wall, &all))
                {
                    return self.or_another_law(found, || None);
                }
            }
            return found.unwrap_or_else(|| self.placed_by(discovered, None, tried));
        };
        let answer = Answer { after: self.trials.refined(answer.after), ..answer };
        let (answer, tried) = match self.beside_bed_in_place_of_corner(answer, tried) {
            ControlFlow::Break(found) => return found,
            ControlFlow::Continue(all) => all,
        };
        let other_law = OtherLaw::beside(&self.trials.data, &answer.after);
        if other_law.speaks() {
            return self.placed_without(&answer.after, other_law, tried);
        }
        // What is left at impacts is none of a law's: no exponent is to take it up.
        let relatives = match answer.between_impacts {
            true => Relatives::default(),
            false => self.trials.relatives(&answer.after),
        };
        if let Some(kin) = relatives.better {
            return self.beyond_a_wrong_name(&answer.after, kin, other_law, tried);
        }
        let better = if answer.between_impacts { None } else { self.better_formula(&answer.after, &tried) };
        match better {
            Some((discovered, formula)) => {
                let other_law = Some(other_law);
                Found { discovered: Some(discovered), other_law, ..self.found(formula, tried) }
            }
            None => {
                let (answer, tried) = self.in_class_with(answer, relatives.of_ground, tried);
                Found { other_law: Some(other_law), ..self.found(answer, tried) }
            }
        }
    }

    /// The better of the answer among single effects and that among pairs, and everything tried.
    fn with_pairs(
        &self,
        one: Option<Answer>,
        mut tried: Vec<FittedHypothesis>,
    ) -> (Option<Answer>, Vec<FittedHypothesis>) {
        let trials = self.trials;
        let best_single =
            |tried: &[FittedHypothesis]| best_answer(tried).unwrap_or(&self.wall.recalibrated).clone();
        let pairs = trials.pairs(&tried, &best_single(&tried), &self.wall.before, self.error, one.is_some());
        let mut one = one;
        // Where one effect of the best pair does nothing, its fit is a better one of the other effect alone.
        if let Some(pair) = pairs.first().filter(|pair| !does_something(pair)) {
            tried = trials.ordered(tried.into_iter().map(|t| trials.better_part(t, pair)).collect());
            one = self.named(&tried, &self.wall.recalibrated);
        }
        let single = best_single(&tried);
        // What impacts of another formulation leave, a second effect may take up: it must show between them.
        let between = one.as_ref().is_some_and(|one| one.between_impacts);
        let is_worth_it = |two: &Answer| match between || two.between_impacts {
            true => worth_two_between(trials, &single, &two.after),
            false => worth_two(&trials.data, &single, &two.after),
        };
        let two = self.named(&pairs, &single).filter(is_worth_it);
        tried.extend(pairs);
        (two.or(one), tried)
    }

    /// The best hypothesis that closes the gap, or leaves noise between impacts, is an answer, and is worth its name beside a
    /// simpler one; with what cannot be told from it.
    pub(super) fn named(&self, tried: &[FittedHypothesis], simpler: &FittedHypothesis) -> Option<Answer> {
        self.closing(tried, simpler).or_else(|| {
            let NamedBetween { best, near } = named_between(self.trials, tried, simpler)?;
            let equivalent = if near.is_empty() { Vec::new() } else { names_of_all(best, near) };
            Some(Answer { between_impacts: true, ..Answer::named(best.clone(), equivalent) })
        })
    }

    /// The same of those that close the gap.
    fn closing(&self, tried: &[FittedHypothesis], simpler: &FittedHypothesis) -> Option<Answer> {
        let closing = tried.iter().filter(|t| closes(t, self.error)).collect::<Vec<_>>();
        let best = best_answer(closing.iter().copied())?;
        if self.gain(simpler, best) < WORTH_A_NAME || is_near_other_impacts(&self.trials.data, best, &closing)
        {
            return None;
        }
        // A number of the wall that does clearly better than every effect: a symptom, no answer.
        let first = closing.first().filter(|t| kinds(t).is_none());
        if first.is_some_and(|t| self.gain(best, t) > EQUIVALENT) {
            return None;
        }
        Some(Answer::named(best.clone(), self.equivalent(best, &closing)))
    }

    /// Whether hypotheses in order say no more than that impacts keep what those of another formulation may keep.
    fn only_other_impacts(&self, tried: &[FittedHypothesis]) -> bool {
        let closing = tried.iter().filter(|t| closes(t, self.error)).collect::<Vec<_>>();
        let best = best_answer(closing.iter().copied());
        best.is_some_and(|best| is_near_other_impacts(&self.trials.data, best, &closing))
    }

    /// Whether impacts of another formulation, however little they keep beside sharp edges, close the gap and do as well as a name.
    fn follow_other_impacts(&self, named: &FittedHypothesis, tried: &[FittedHypothesis]) -> bool {
        let closing = tried.iter().filter(|t| closes(t, self.error)).collect::<Vec<_>>();
        is_near_other_impacts(&self.trials.data, named, &closing)
    }

    /// Impacts of another formulation: nothing is missing where a wall without effects leaves noise all the same, else the place.
    fn other_impacts(self, singles: Vec<FittedHypothesis>) -> Found {
        if is_noise(&self.wall.before) {
            return self.nothing_missing(singles);
        }
        if is_noise(&self.wall.recalibrated) {
            return self.within_the_wall(singles);
        }
        let after = self.wall.recalibrated.clone();
        Found { place: Some("impacts"), ..self.found(Answer::of(Verdict::PlaceOnly, after), singles) }
    }

    /// Names of the best and of what cannot be told from it; empty if that is nothing.
    fn equivalent(&self, best: &FittedHypothesis, closing: &[&FittedHypothesis]) -> Vec<String> {
        let own = kinds(best);
        let limit = against(&self.trials.data, best) + EQUIVALENT;
        let as_good = |t: &&&FittedHypothesis| against(&self.trials.data, t) < limit && kinds(t) != own;
        let others = closing.iter().filter(as_good);
        let mut others = others.filter(|t| !t.hypothesis.additions.contains(&Addition::Placebo)).peekable();
        if others.peek().is_none() { Vec::new() } else { names_of_all(best, others.copied()) }
    }

    /// What one hypothesis gains over another.
    pub(super) fn gain(&self, over: &FittedHypothesis, of: &FittedHypothesis) -> f64 {
        against(&self.trials.data, over) - against(&self.trials.data, of)
    }

    pub(super) fn found(
        self,
        Answer { verdict, after, equivalent, .. }: Answer,
        tried: Vec<FittedHypothesis>,
    ) -> Found {
        let WallFits { before, recalibrated } = self.wall;
        Found {
            verdict,
            before,
            recalibrated,
            after,
            equivalent,
            place: None,
            remainder: None,
            other_law: None,
            discovered: None,
            tried,
        }
    }
}

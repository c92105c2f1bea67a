//! Joints that give: a name where windows ask for them, alone or with an effect beside them.
//!
//! Everything else is tried on sharp edges, where a wall on beds is far off whatever is added. So beds come first: where
//! they hold, the others are fitted as rivals, and no more is tried.

use super::found::Found;
use super::held::{equals_of_held, near_held};
use super::judge::Gap;
use super::remainder::is_soft;
use super::worth_naming::{leaves_noise, worth_two};
use super::{Remainder, Verdict, names, names_of_all};
use crate::Progress;
use crate::diagnose::certainty::differs_beside_bed;
use crate::diagnose::fit::{WindowFit, nats};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{
    FittedHypothesis, Trials, WallFits, against, all_windows, closes, crushes, does_something, excess,
    first_of_each, follows_all_nearly, in_order_of_likelihood, is_noise, joint_error, relieved,
    typical_error,
};
use crate::limits::{
    BED_OWN_ERROR, BESIDE_BEDS_ASKED_FOR, BESIDE_BEDS_FROM, BESIDE_BEDS_GAP, EQUIVALENT, REMAINDER_RIVAL,
    REMAINDER_TAKEN, WORTH_A_NAME, WORTH_A_SECOND, WORTH_A_SECOND_HELD_OUT,
};
use mrbd_kernel::model::Role;

/// The verdict where joints that give, alone or in pairs with effects, are the answer, or part of it; `None` where they are not.
pub fn on_beds<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    beds: Vec<FittedHypothesis>,
    pairs: Vec<FittedHypothesis>,
) -> Option<Found> {
    let WallFits { before, recalibrated } = wall;
    if !beds.first().is_some_and(does_something) {
        return None;
    }
    let OnBeds { best, mut near, pairs, rivals } = with_effect(trials, wall, &beds, pairs)?;
    let best = trials.beds_refined(best);
    if Remainder::new(&trials.data, recalibrated, &best, &[])?.taken_held_out < REMAINDER_TAKEN {
        return None;
    }
    let rivals = rivals.unwrap_or_else(|| trials.rivals_of_beds(before));
    let (nearest, others) = near_held(trials, recalibrated, &best, rivals.clone());
    let standing = Standing::of(trials, wall, &best, &others)?;
    let laws = trials.joint_laws(&best);
    let equals = equals_of_held(trials, &beds, &laws, &nearest);
    if !trials.is_held() {
        near.extend(laws.iter().filter(|law| stands_for(trials, &best, law)).cloned());
    }
    let alone = beds.first().filter(|alone| names(alone) != names(&best)).cloned();
    let tried = || [&beds[..], &pairs, &laws, &rivals].concat();
    let found = standing.found(trials, wall, best, &near, tried());
    if !equals.is_empty() {
        return Some(Found { verdict: Verdict::Class, equivalent: equals, ..found });
    }
    let gap = Gap::new(trials, wall.clone(), joint_error(before)?);
    let named_alone = || {
        let alone = alone?;
        Some(Standing::of(trials, wall, &alone, &rivals)?.found(trials, wall, alone, &[], tried()))
    };
    Some(gap.or_another_law(found, named_alone))
}

/// Joints that give where the gap was too narrow for them to come first, and nothing that was tried closes it: a name if they
/// follow the tests to their noise, or nearly.
pub fn on_beds_last<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    tried: &[FittedHypothesis],
    laws: &[FittedHypothesis],
) -> Option<Found> {
    let rivals = tried.iter().chain(laws).chain([&wall.recalibrated]);
    let rival = rivals.min_by(|a, b| against(&trials.data, a).total_cmp(&against(&trials.data, b)))?;
    following_alone(trials, wall, &trials.beds_in_narrow_gap(wall, rival), tried)
}

/// Joints that give in the place of a name that leaves more than noise, where they follow the tests to it, or nearly, and nothing that
/// was tried comes near: what a stiff bed leaves of sharp edges, an effect may take up in part.
pub fn on_beds_instead<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    named: &FittedHypothesis,
    tried: &[FittedHypothesis],
) -> Option<Found> {
    if leaves_noise(named) || trials.is_held() {
        return None;
    }
    following_alone(trials, wall, &trials.beds_instead_of(named, wall), tried)
}

/// The verdict where the first of some beds, alone or with an effect beside it, follows the tests to their noise, or nearly, and is no other
/// way to model a sharp edge.
pub(super) fn following_alone<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    beds: &[FittedHypothesis],
    tried: &[FittedHypothesis],
) -> Option<Found> {
    let best = beds.first().filter(|best| does_something(best) && is_soft(best))?;
    let alone = trials.beds_refined(best.clone());
    let standing = Standing::of(trials, wall, &alone, tried)?;
    let pairs = beside_beds(trials, wall, std::slice::from_ref(&alone));
    let all = || [beds, &pairs, tried].concat();
    if let Some((two, near)) = worth_it(trials, wall, &alone, &pairs) {
        let two = trials.beds_refined(two);
        if let Some(standing) = Standing::of(trials, wall, &two, tried) {
            return Some(standing.found(trials, wall, two, &near, all()));
        }
    }
    let tried = all();
    Some(standing.found(trials, wall, alone, &[], tried))
}

/// Why joints that give, alone or with an effect, may be named.
pub(super) struct Standing {
    /// What they leave, where that is more than noise.
    pub remainder: Option<Remainder>,
}

impl Standing {
    /// They follow to the noise, or what they leave is little, and no rival comes near; `None` if neither.
    pub fn of<P: Progress>(
        trials: &Trials<P>,
        wall: &WallFits,
        best: &FittedHypothesis,
        rivals: &[FittedHypothesis],
    ) -> Option<Self> {
        if follows(trials, wall, best, rivals) {
            return Some(Self { remainder: None });
        }
        let remainder = Remainder::of_name(&trials.data, &wall.recalibrated, best, rivals)?;
        Some(Self { remainder: Some(remainder) })
    }

    pub fn found<P: Progress>(
        self,
        trials: &Trials<P>,
        wall: &WallFits,
        best: FittedHypothesis,
        near: &[FittedHypothesis],
        tried: Vec<FittedHypothesis>,
    ) -> Found {
        Found {
            verdict: if near.is_empty() { Verdict::Named } else { Verdict::Class },
            equivalent: if near.is_empty() { Vec::new() } else { names_of_all(&best, near) },
            before: wall.before.clone(),
            recalibrated: wall.recalibrated.clone(),
            after: best,
            place: None,
            remainder: self.remainder,
            other_law: None,
            discovered: None,
            tried: trials.ordered(tried),
        }
    }
}

/// What follows best where joints give.
struct OnBeds {
    /// Joints that give alone, or with an effect.
    best: FittedHypothesis,
    /// With other effects that come near the best.
    near: Vec<FittedHypothesis>,
    /// Everything tried beside joints that give.
    pairs: Vec<FittedHypothesis>,
    /// Single effects on sharp edges, where they were asked for.
    rivals: Option<Vec<FittedHypothesis>>,
}

/// Joints that give with an effect beside them, the best first; none where they take away too little for one to show, or leave
/// noise.
pub fn beside_beds<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    beds: &[FittedHypothesis],
) -> Vec<FittedHypothesis> {
    let Some(alone) = beds.first().filter(|alone| does_something(alone)) else { return Vec::new() };
    let nothing_beside = || leaves_noise(alone) || trials.is_held();
    if !takes_enough(trials, wall, alone) || nothing_beside() {
        return Vec::new();
    }
    trials.beside_beds(beds)
}

/// Whether joints that give take away so much, in the tests held out, that an effect beside them could show.
fn takes_enough<P: Progress>(trials: &Trials<P>, wall: &WallFits, alone: &FittedHypothesis) -> bool {
    Remainder::new(&trials.data, &wall.recalibrated, alone, &[])
        .is_some_and(|taken| taken.taken_held_out >= BESIDE_BEDS_FROM)
}

/// Joints that give with an effect beside them where one of `pairs` is worth it, else alone. `None` where joints that give take away
/// too little for anything beside them to show.
fn with_effect<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    beds: &[FittedHypothesis],
    pairs: Vec<FittedHypothesis>,
) -> Option<OnBeds> {
    let alone = beds.first()?;
    if !takes_enough(trials, wall, alone) {
        return None;
    }
    // A strip whose top is held shows one moment: nothing tells an effect beside its joints.
    if leaves_noise(alone) || trials.is_held() {
        return Some(OnBeds { best: alone.clone(), near: Vec::new(), pairs: Vec::new(), rivals: None });
    }
    // A pair that leaves more than noise may stand for another, which is found from sharp edges alone.
    let to_noise = worth_it(trials, wall, alone, &pairs).is_some_and(|(two, _)| is_noise(&two));
    let (pairs, rivals) = if !to_noise && leaves_more_than_another_model(wall, alone) {
        let in_few = trials.rivals_in_few_windows(&wall.before);
        let rivals = trials.rivals_in_all_windows(&wall.before, &in_few);
        let mut all = [trials.beds_beside_rivals(alone, &in_few), pairs].concat();
        in_order_of_likelihood(&mut all);
        all.extend(beside_another_bed(trials, alone, &all));
        in_order_of_likelihood(&mut all);
        // A pair may have been found from either of its parts.
        (first_of_each(all), Some(rivals))
    } else {
        (pairs, None)
    };
    let (best, near) = worth_it(trials, wall, alone, &pairs).unwrap_or_else(|| (alone.clone(), Vec::new()));
    Some(OnBeds { best, near, pairs, rivals })
}

/// Effects beside the bed of the first of some pairs, where that leaves more than noise and is at other joints than the bed alone: beside
/// this one they were not seen.
fn beside_another_bed<P: Progress>(
    trials: &Trials<P>,
    alone: &FittedHypothesis,
    pairs: &[FittedHypothesis],
) -> Vec<FittedHypothesis> {
    let own = alone.hypothesis.additions[0];
    let other = pairs.first().filter(|two| !is_noise(two) && two.hypothesis.additions[0] != own);
    let bed = other.and_then(|two| trials.bed_without_effect(two));
    bed.map(|bed| trials.beside_beds(&[bed])).unwrap_or_default()
}

/// The first of pairs, if it is worth naming beside joints that give alone, and what comes near it.
fn worth_it<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    alone: &FittedHypothesis,
    pairs: &[FittedHypothesis],
) -> Option<(FittedHypothesis, Vec<FittedHypothesis>)> {
    let mut pairs = pairs.iter().filter(|two| !stands_for_part_of_bed(two));
    let two = pairs.next().filter(|two| is_worth_it(trials, wall, alone, two))?;
    // What follows to the noise or takes most is near only to what does so too.
    let clearly = is_clearly_worth_it(trials, wall, alone, two);
    let is_worth = |other: &FittedHypothesis| {
        let worth = if clearly { is_clearly_worth_it } else { is_worth_it };
        worth(trials, wall, alone, other)
    };
    let is_as_good = |other: &&FittedHypothesis| comes_near(trials, two, other) && is_worth(other);
    Some((two.clone(), pairs.filter(is_as_good).cloned().collect()))
}

/// Whether joints that give alone leave more than another way to model them does.
fn leaves_more_than_another_model(wall: &WallFits, alone: &FittedHypothesis) -> bool {
    let [gap, left] = [&wall.recalibrated, alone].map(|tried| excess(&all_windows(tried)));
    left > BED_OWN_ERROR * gap && joint_error(alone).is_some_and(|error| error > BESIDE_BEDS_GAP)
}

/// Whether an effect beside joints that give is named with them: it is clearly worth it, or it shows beside what both leave.
pub(super) fn is_worth_it<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    alone: &FittedHypothesis,
    two: &FittedHypothesis,
) -> bool {
    if stands_for_part_of_bed(two) {
        return false;
    }
    let shows = || does_something(two) && differs_beside_bed(two) && shows_beside_own_error(alone, two);
    is_clearly_worth_it(trials, wall, alone, two) || shows()
}

/// Whether what is beside a bed may stand for what springs and dampers under the joint do by another way to model them: a damper or
/// another edge of the bed's own joint, where both leave more than noise.
fn stands_for_part_of_bed(two: &FittedHypothesis) -> bool {
    changes_joint_of_bed(&two.hypothesis.additions) && !leaves_noise(two)
}

/// Whether a damper or another edge belongs to a joint that has a bed.
fn changes_joint_of_bed(additions: &[Addition]) -> bool {
    let of = |role: Role| additions.iter().filter(move |a| a.role() == Some(role)).map(Addition::joint);
    // A bed without a joint of its own lies in both.
    let is_on_bed = |joint| of(Role::Bed).any(|bed| bed.is_none() || bed == Some(joint));
    of(Role::Damper).chain(of(Role::Corners)).flatten().any(is_on_bed)
}

/// Whether an effect beside joints that give follows to the noise and gains what a second effect must. Or they leave more than
/// another way to model a bed does, or than a bed with the effect, which nearly follows, and it takes most of that away, in small
/// swings and in large ones.
fn is_clearly_worth_it<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    alone: &FittedHypothesis,
    two: &FittedHypothesis,
) -> bool {
    let is_more = leaves_more_than_another_model(wall, alone)
        || (follows_all_nearly(two) && !follows_all_nearly(alone));
    let takes_most = || Remainder::new(&trials.data, alone, two, &[]).is_some_and(|r| r.holds());
    let to_noise = || follows(trials, wall, two, &[]) && worth_two(&trials.data, alone, two);
    does_something(two) && ((is_more && takes_most()) || to_noise())
}

/// Whether a second effect gains what one must that leaves more than noise, in tests fitted and in those held out, with what both
/// typically leave in the place of noise.
fn shows_beside_own_error(one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
    let error = typical_error(two);
    let gain =
        |one: &[WindowFit], two: &[WindowFit]| nats(&relieved(one, error)) - nats(&relieved(two, error));
    let fitted = gain(&one.fit.windows, &two.fit.windows);
    let held_out = gain(&one.held_out.windows, &two.held_out.windows);
    fitted + held_out > WORTH_A_SECOND && held_out > WORTH_A_SECOND_HELD_OUT
}

/// Whether another law of the joints may stand for a bed: it comes near, and does not only follow because it is a bed that hardly
/// crushes.
fn stands_for<P: Progress>(trials: &Trials<P>, best: &FittedHypothesis, law: &FittedHypothesis) -> bool {
    let [bed, own] = [best, law].map(|tried| excess(&all_windows(tried)));
    comes_near(trials, best, law) && (!crushes(law) || own < (1.0 - BESIDE_BEDS_ASKED_FOR) * bed)
}

/// Whether the tests cannot tell another effect from the best: by likelihood where that leaves noise, else by what each leaves.
pub(super) fn comes_near<P: Progress>(
    trials: &Trials<P>,
    best: &FittedHypothesis,
    other: &FittedHypothesis,
) -> bool {
    if is_noise(best) {
        return against(&trials.data, other) - against(&trials.data, best) < EQUIVALENT;
    }
    let [best, other] = [best, other].map(|tried| excess(&all_windows(tried)));
    other < REMAINDER_RIVAL * best
}

/// Whether a hypothesis follows the tests to their noise, and no rival does nearly as well.
pub(super) fn follows<P: Progress>(
    trials: &Trials<P>,
    wall: &WallFits,
    best: &FittedHypothesis,
    rivals: &[FittedHypothesis],
) -> bool {
    let own = against(&trials.data, best);
    let over = |other: &FittedHypothesis| against(&trials.data, other) - own;
    joint_error(&wall.before).is_some_and(|gap| closes(best, gap))
        && over(&wall.recalibrated) > WORTH_A_NAME
        && rivals.iter().all(|rival| over(rival) > EQUIVALENT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::Fit;
    use crate::diagnose::hypothesis::example::starter_with;

    /// Windows to fit and held out, each with so many times the noise, squared, and the last far off.
    fn tried(reduced: f64, far: f64, held_out: f64) -> FittedHypothesis {
        let window = |reduced: f64| WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let of = |reduced: f64| {
            let windows = [vec![window(reduced); 20], vec![window(far)]].concat();
            Fit { values: Vec::new(), windows, cost: 0.0, covariance: None }
        };
        let hypothesis = starter_with(&["compliant_joint.both"]);
        FittedHypothesis { hypothesis, fit: of(reduced), held_out: of(held_out) }
    }

    #[test]
    fn analytic_a_second_effect_shows_in_most_windows_and_not_in_few_far_off() {
        let alone = tried(1.5, 1e5, 1.5);
        assert!(shows_beside_own_error(&alone, &tried(1.1, 2e5, 1.1)));
        assert!(!shows_beside_own_error(&alone, &tried(1.5, 1e2, 1.5)), "only where few windows are far off");
        assert!(!shows_beside_own_error(&alone, &tried(1.1, 1e5, 1.5)), "not in the tests held out");
        assert!(!shows_beside_own_error(&alone, &tried(1.45, 1e5, 1.45)), "too little");
    }

    #[test]
    fn analytic_dampers_and_edges_of_a_bed_are_those_of_its_joint() {
        let has = |names: &[&str]| changes_joint_of_bed(&starter_with(names).additions);
        assert!(has(&["compliant_joint.ground", "corner_indentation.ground"]));
        assert!(!has(&["compliant_joint.ground", "corner_indentation.crack"]));
        assert!(has(&["compliant_joint.both", "joint_damping.crack"]));
        assert!(has(&["compliant_joint.crack", "joint_damping.crack"]));
        assert!(!has(&["compliant_joint.ground", "joint_damping.crack"]));
        assert!(!has(&["compliant_joint.both", "viscous_damping"]));
        assert!(!has(&["joint_damping.crack", "viscous_damping"]));
    }
}

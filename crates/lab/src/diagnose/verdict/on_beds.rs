//! Joints that give: a name where windows ask for them, and nothing else follows.
//!
//! Everything else is tried on sharp edges, where a wall on beds is far off whatever is added. So beds come first: where
//! they hold, the others are fitted as rivals, and no more is tried.

use super::judge::Found;
use super::{Remainder, Verdict};
use crate::Progress;
use crate::diagnose::trials::{
    FittedHypothesis, Trials, WallFits, against, all_windows, closes, does_something, excess, joint_error,
};
use crate::limits::{EQUIVALENT, REMAINDER_RIVAL, REMAINDER_TAKEN, WORTH_A_NAME};

/// The verdict where joints that give are the answer; `None` where they are not.
pub fn on_beds<P: Progress>(trials: &Trials<P>, wall: &WallFits) -> Option<Found> {
    let WallFits { before, recalibrated } = wall;
    let beds = trials.beds(recalibrated);
    let best = beds.first().filter(|best| does_something(best))?;
    let alone = Remainder::new(&trials.data, recalibrated, best, &[])?;
    if alone.taken_held_out < REMAINDER_TAKEN {
        return None;
    }
    let rivals = trials.coarse_singles(before);
    let follows = follows(trials, wall, best, &rivals);
    let remainder = Remainder::of_name(&trials.data, recalibrated, best, &rivals).filter(|_| !follows);
    if !follows && remainder.is_none() {
        return None;
    }
    let laws = trials.joint_laws(best);
    let equals = equals_of_held(trials, &beds, &laws);
    Some(Found {
        verdict: if equals.is_empty() { Verdict::Named } else { Verdict::Class },
        before: before.clone(),
        recalibrated: recalibrated.clone(),
        after: best.clone(),
        equivalent: equals,
        place: None,
        remainder,
        other_law: None,
        discovered: None,
        tried: trials.ordered([beds, laws, rivals].concat()),
    })
}

/// What a strip whose top is held cannot tell from its best bed: beds at other joints and other laws that leave no more than a
/// rival may; empty where nothing comes near, or no top is held.
fn equals_of_held<P: Progress>(
    trials: &Trials<P>,
    beds: &[FittedHypothesis],
    laws: &[FittedHypothesis],
) -> Vec<String> {
    let Some((best, others)) = beds.split_first().filter(|_| trials.is_held()) else { return Vec::new() };
    let left = |tried: &FittedHypothesis| excess(&all_windows(tried)).max(1.0);
    let near = others.iter().chain(laws).filter(|other| left(other) < REMAINDER_RIVAL * left(best));
    let near = near.map(|other| other.hypothesis.name()).collect::<Vec<_>>();
    if near.is_empty() { near } else { [vec![best.hypothesis.name()], near].concat() }
}

/// Whether a bed follows the tests to their noise, and no rival does nearly as well.
fn follows<P: Progress>(
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

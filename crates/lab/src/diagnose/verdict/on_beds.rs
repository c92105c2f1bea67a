//! Joints that give: a name where windows ask for them, and nothing else follows.
//!
//! Everything else is tried on sharp edges, where a wall on beds is far off whatever is added. So beds come first: where
//! they hold, the others are fitted as rivals, and no more is tried.

use super::judge::Found;
use super::{Remainder, Verdict};
use crate::Progress;
use crate::diagnose::trials::{
    FittedHypothesis, Trials, WallFits, against, closes, does_something, joint_error,
};
use crate::limits::{EQUIVALENT, REMAINDER_TAKEN, WORTH_A_NAME};

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
    Some(Found {
        verdict: Verdict::Named,
        before: before.clone(),
        recalibrated: recalibrated.clone(),
        after: best.clone(),
        equivalent: Vec::new(),
        place: None,
        remainder,
        other_law: None,
        discovered: None,
        tried: trials.ordered([beds, rivals].concat()),
    })
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

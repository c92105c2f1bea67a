//! A strip whose top is held: one moment against one rotation, which tells joints that give from little.

use super::Remainder;
use crate::Progress;
use crate::diagnose::trials::{FittedHypothesis, Trials, all_windows, does_something, excess, kinds};
use crate::limits::REMAINDER_RIVAL;

/// Effects on sharp edges that take away nearly as much of a strip whose top is held as joints that give do, and those that do not. The
/// first are of one class with these: one moment against one rotation tells little, and which comes how near depends on the states of few
/// windows. All are of the second where no top is held.
pub(super) fn near_held<P: Progress>(
    trials: &Trials<P>,
    without: &FittedHypothesis,
    best: &FittedHypothesis,
    rivals: Vec<FittedHypothesis>,
) -> (Vec<FittedHypothesis>, Vec<FittedHypothesis>) {
    if !trials.is_held() {
        return (Vec::new(), rivals);
    }
    let left = |tried: &FittedHypothesis| {
        let taken = Remainder::new(&trials.data, without, tried, &[]);
        taken.map_or(1.0, |taken| 1.0 - taken.taken_held_out)
    };
    let most = REMAINDER_RIVAL * left(best);
    rivals
        .into_iter()
        .partition(|rival| kinds(rival).is_some() && does_something(rival) && left(rival) < most)
}

/// What a strip whose top is held cannot tell from its best bed: beds at other joints, other laws that leave no more than a
/// rival may, and the effects that come as near; empty where nothing does, or no top is held.
pub(super) fn equals_of_held<P: Progress>(
    trials: &Trials<P>,
    beds: &[FittedHypothesis],
    laws: &[FittedHypothesis],
    nearest: &[FittedHypothesis],
) -> Vec<String> {
    let Some((best, others)) = beds.split_first().filter(|_| trials.is_held()) else { return Vec::new() };
    let left = |tried: &FittedHypothesis| excess(&all_windows(tried)).max(1.0);
    let near = others.iter().chain(laws).filter(|other| left(other) < REMAINDER_RIVAL * left(best));
    let near = near.chain(nearest).map(|other| other.hypothesis.name()).collect::<Vec<_>>();
    if near.is_empty() { near } else { [vec![best.hypothesis.name()], near].concat() }
}

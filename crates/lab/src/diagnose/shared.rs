//! Windows of tests held out that are fitted too, where the tests fitted do not show all of a law.
//!
//! A stop that only the larger motion reaches is told by no test of small motion. A law that follows the tests fitted to their noise and
//! fails in those held out may lack such an atom; one that leaves a little more than noise there may have its numbers from motion too small.
//! Every other window of the tests held out is fitted then too, and those between them judge: each is a swing of its own, with noise of its
//! own, in motion as large.

use super::discovery::Discovered;
use super::fit::nats;
use super::trials::{FittedHypothesis, closes_held_out, leave_noise};
use super::verdict::{Found, stands_out_held_out};
use crate::experiment::{TestData, Window};
use crate::experiment_file::Purpose;
use crate::limits::{EQUIVALENT, LEAST_SHARED, MINDED_SHARE};

/// Windows to fit and held out, every other one of those held out fitted too; `None` where nothing asks for it, or too few are held out.
pub(super) fn shared_windows(windows: &[Vec<Window>; 2], found: &Found) -> Option<[Vec<Window>; 2]> {
    if windows[1].len() < LEAST_SHARED {
        return None;
    }
    Some(every_other(windows.clone(), asks_for_what_is_held_out(found)?))
}

/// Windows to fit and held out, every other one of those held out fitted too, and so of those that a hypothesis misses: a stop may be met in
/// two of a row, and both sides must see it.
pub(super) fn every_other(
    [fitted, held_out]: [Vec<Window>; 2],
    asking: &FittedHypothesis,
) -> [Vec<Window>; 2] {
    let mut shared = [fitted, Vec::new()];
    let mut so_far = [0; 2];
    for (window, left) in held_out.into_iter().zip(&asking.held_out.windows) {
        let count = &mut so_far[usize::from(left.is_poor())];
        let side = *count % 2;
        *count += 1;
        shared[side].push(Window { purpose: [Purpose::Fit, Purpose::HoldOut][side], ..window });
    }
    shared
}

/// A law that is told and leaves more than noise of the tests held out; where no answer is found, that which follows the tests fitted and that
/// nothing but those held out refuses, or one that misses these, or the wall if that follows those fitted so.
fn asks_for_what_is_held_out(found: &Found) -> Option<&FittedHypothesis> {
    if found.says_nothing_of_what_is_held_out() {
        return Some(&found.after).filter(|wall| follows_fitted(wall));
    }
    if found.verdict.is_formula() {
        return Some(&found.after).filter(|law| follows_fitted(law) && stands_out_held_out(law));
    }
    let discovered = found.discovered.as_ref().filter(|_| found.verdict.is_left_open())?;
    let misses = |law: &&FittedHypothesis| follows_fitted(law) && !closes_held_out(law);
    discovered.asked_for_more().or_else(|| discovered.tried.iter().find(misses))
}

fn follows_fitted(law: &FittedHypothesis) -> bool {
    leave_noise(&[law.fit.windows.clone(), Vec::new()])
}

/// The tests as points are taken of them: those held out too, of which windows are fitted.
pub(super) fn as_fitted(tests: &[TestData]) -> Vec<TestData> {
    tests.iter().map(|test| TestData { purpose: Purpose::Fit, ..test.clone() }).collect()
}

/// Whether a law found so is one for the tests that were to be fitted: these say no less of it than of the best law fitted to them alone that
/// nothing refused but the tests held out, or of the wall. Formulations of a contact differ in larger motion, so they may say less by a small
/// share of what its second atom says.
pub(super) fn keeps_what_was_fitted(before: &Found, after: &Found, windows: &[Vec<Window>; 2]) -> bool {
    let count = windows[0].len();
    let best = |found: &Found| {
        let laws = found.discovered.iter().flat_map(Discovered::unless_tests_fitted_refuse);
        laws.chain([&found.after]).map(|law| nats(&law.fit.windows)).fold(f64::INFINITY, f64::min)
    };
    let minded = nats(&after.after.fit.windows[..count]) - best(before);
    let second_says =
        || after.discovered.as_ref().map_or(0.0, |laws| laws.says_more_than_one_atom(&after.after));
    minded < EQUIVALENT || minded < MINDED_SHARE * second_says()
}

#[cfg(test)]
mod tests {
    use super::super::answer::{Findings, SharedHeldOut};
    use super::super::discovery::twin::{Twin, wall_with};
    use super::super::verdict::Verdict;
    use super::*;

    /// What a law leaves, in every window fitted and in every window held out, of a wall for which nothing was told; squared error over
    /// squared noise.
    fn found(twin: &Twin, [fitted, held_out]: [f64; 2]) -> Found {
        let mut law = twin.trials().wall_fits(None).expect("windows").recalibrated;
        for (side, reduced) in [(&mut law.fit, fitted), (&mut law.held_out, held_out)] {
            side.windows.iter_mut().for_each(|window| window.squares = reduced * window.freedom);
        }
        Found::in_vain(Verdict::PlaceOnly, &law, law.clone())
    }

    #[test]
    fn analytic_every_other_window_held_out_is_fitted_where_a_law_misses_these_alone() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let given = twin.windows();
        let [fitted, judging] = shared_windows(given, &found(&twin, [1.0, 9.0])).expect("some to share");
        let places =
            |windows: &[Window]| windows.iter().map(|w| (w.test, w.samples.start)).collect::<Vec<_>>();
        let held_out = places(&given[1]);
        assert_eq!(places(&fitted[..given[0].len()]), places(&given[0]));
        let every_other = |from: usize| held_out.iter().skip(from).step_by(2).copied().collect::<Vec<_>>();
        assert_eq!(places(&fitted[given[0].len()..]), every_other(0));
        assert_eq!(places(&judging), every_other(1));
        assert!(fitted.iter().all(|w| w.purpose == Purpose::Fit));
        assert!(judging.iter().all(|w| w.purpose == Purpose::HoldOut));
        assert!(as_fitted(&twin.experiment().tests).iter().all(|test| test.purpose == Purpose::Fit));
        let told = |windows: [Vec<Window>; 2]| {
            let (experiment, found) = (twin.experiment(), found(&twin, [1.0, 1.0]));
            let (own, unfinished) = (Vec::new(), std::collections::BTreeMap::new());
            Findings {
                experiment,
                tests: experiment.tests.clone(),
                windows,
                found,
                freed: Vec::new(),
                own,
                unfinished,
            }
            .shared_held_out()
        };
        let half = held_out.len() / 2;
        assert_eq!(told(given.clone()), None);
        assert_eq!(
            told([fitted, judging]),
            Some(SharedHeldOut { fitted: held_out.len() - half, judging: half })
        );
    }

    #[test]
    fn analytic_of_two_windows_in_a_row_that_a_law_misses_one_is_fitted_and_one_judges() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let given = twin.windows();
        let law = found(&twin, [1.0, 1.0]).after;
        let sides_of = |missed: [usize; 2]| {
            let mut law = law.clone();
            for k in missed {
                law.held_out.windows[k].squares *= 1e4;
            }
            let shared = every_other(given.clone(), &law);
            let at = |k: usize| (given[1][k].test, given[1][k].samples.start);
            let judges = |k: usize| shared[1].iter().any(|w| (w.test, w.samples.start) == at(k));
            missed.map(judges)
        };
        // The third and the fourth, or the third and the fifth.
        assert_eq!([sides_of([2, 3]), sides_of([2, 4])], [[false, true]; 2]);
    }

    #[test]
    fn analytic_none_is_shared_where_something_is_told_that_follows_or_nothing_asks_for_it() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let given = twin.windows();
        let missing = || found(&twin, [1.0, 9.0]);
        assert!(shared_windows(given, &Found { verdict: Verdict::Named, ..missing() }).is_none());
        for told in [Verdict::Formula, Verdict::FormulaClass] {
            let law = |left: [f64; 2]| Found { verdict: told, ..found(&twin, left) };
            assert!(shared_windows(given, &law([1.0, 1.0])).is_none(), "follows those held out");
            assert!(shared_windows(given, &law([1.0, 1.5])).is_some(), "stands out in those held out");
            assert!(shared_windows(given, &law([9.0, 9.0])).is_none(), "misses those fitted");
        }
        assert!(shared_windows(given, &found(&twin, [1.0, 1.0])).is_none(), "follows those held out");
        assert!(shared_windows(given, &found(&twin, [9.0, 9.0])).is_none(), "misses those fitted");
        assert!(shared_windows(given, &Found { discovered: None, ..missing() }).is_none(), "no law");
        // The wall itself follows the tests fitted alone.
        for nothing in [Verdict::None, Verdict::Recalibrated] {
            let mut wall = Found { verdict: nothing, discovered: None, ..missing() };
            assert!(shared_windows(given, &wall).is_none(), "what shows is what was judged");
            wall.after.fit.windows = vec![wall.after.fit.windows; 500].concat();
            assert!(shared_windows(given, &wall).is_some(), "all windows together leave noise");
        }
        let few = [given[0].clone(), given[1][..LEAST_SHARED - 1].to_vec()];
        assert!(shared_windows(&few, &missing()).is_none());
    }

    #[test]
    fn analytic_a_law_found_so_must_be_one_for_the_tests_fitted() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let before = found(&twin, [1.0, 9.0]);
        // Of so many windows each by a share of its squares: more logarithms together than laws that are equals differ by, or fewer.
        let freedom = before.after.fit.windows.iter().map(|window| window.freedom).sum::<f64>();
        let keeps = |lost: f64| {
            let after = found(&twin, [1.0 + 2.0 * lost / freedom, 1.0]);
            keeps_what_was_fitted(&before, &after, twin.windows())
        };
        assert!(keeps(0.0) && keeps(0.9 * EQUIVALENT) && !keeps(1.2 * EQUIVALENT));
        // Where a law of one atom leaves so much more, it keeps enough.
        let beside = |left: f64| {
            let mut after = found(&twin, [1.0 + 2.4 * EQUIVALENT / freedom, 1.0]);
            after.discovered = found(&twin, [1.0 + 2.0 * left / freedom, 1.0]).discovered;
            keeps_what_was_fitted(&before, &after, twin.windows())
        };
        let enough = 1.2 * EQUIVALENT / MINDED_SHARE;
        assert!(beside(1.5 * enough) && !beside(0.9 * enough));
    }
}

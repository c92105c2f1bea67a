//! Numbers of a law that the tests fitted leave open, where those held out ask for others.
//!
//! A test at twice the amplitude magnifies what the tests fitted do not know of an exponent. A law with the numbers as they were fitted then
//! leaves more than noise there, though it is the right one. So the numbers may move to where all tests together want them, as far as the
//! tests fitted hardly mind: what they lose by it is a ratio of likelihoods, of which a right law loses about half a natural logarithm for
//! each number.

use super::fitted::Fitted;
use super::refused::Guard;
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::trials::{Data, FittedHypothesis, Trials, refit};
use crate::limits::EQUIVALENT;

/// Whether all that speaks against a law may be that tests held out ask for numbers that those fitted leave open.
pub(super) fn may_move(guards: &[Guard]) -> bool {
    let of_numbers =
        |guard: &Guard| matches!(guard, Guard::HeldOut | Guard::Gap | Guard::Bend | Guard::Trend);
    guards.contains(&Guard::HeldOut) && guards.iter().all(of_numbers)
}

/// What speaks in the tests fitted against the law that follows these best, and is as good in them as any that is asked to move.
pub(super) fn least_in_tests_fitted(data: &Data, fitted: &[Fitted]) -> f64 {
    let done = fitted.iter().filter(|one| one.is_done);
    done.map(|one| one.law.against(data)[0]).fold(f64::INFINITY, f64::min)
}

impl<P: Progress> Trials<'_, P> {
    /// The same law with numbers that the tests fitted leave open, asked once of those that these tell least from the best.
    pub(super) fn move_in_what_is_open(&self, one: &mut Fitted, least: f64) {
        let is_as_good = one.law.against(&self.data)[0] < least + EQUIVALENT;
        if one.is_done && is_as_good && !one.is_asked_to_move {
            one.is_asked_to_move = true;
            one.moved = self.moved_in_what_is_open(&one.law);
        }
    }

    /// A law with numbers fitted to all tests together; `None` where those that were fitted alone lose more by it than laws that cannot be
    /// told apart differ by, or where no test is held out.
    pub(super) fn moved_in_what_is_open(&self, law: &FittedHypothesis) -> Option<FittedHypothesis> {
        let Data { fit, held_out } = self.data;
        if held_out.windows.is_empty() {
            return None;
        }
        let windows = [fit.windows, held_out.windows].concat();
        let all = Data {
            fit: Problem { windows: &windows, ..fit },
            held_out: Problem { windows: &[], ..held_out },
        };
        let (h, from) = (&law.hypothesis, all_of(law));
        let found = self.within_budget_of(&all, &h.name(), h.unknowns.len(), |data| {
            refit(data, h.clone(), &from, &law.fit.values)
        });
        let moved = apart(found?, fit.windows.len());
        (moved.in_tests_fitted() - law.in_tests_fitted() < EQUIVALENT).then_some(moved)
    }
}

/// A law with all windows as those fitted.
fn all_of(law: &FittedHypothesis) -> FittedHypothesis {
    let windows = [&law.fit.windows[..], &law.held_out.windows].concat();
    FittedHypothesis {
        hypothesis: law.hypothesis.clone(),
        fit: Fit { windows, ..law.fit.clone() },
        held_out: Fit { windows: Vec::new(), ..law.held_out.clone() },
    }
}

/// The same with those beyond the first as held out.
fn apart(mut law: FittedHypothesis, fitted: usize) -> FittedHypothesis {
    let windows = law.fit.windows.split_off(fitted);
    law.held_out = Fit { windows, ..law.fit.clone() };
    law
}

#[cfg(test)]
mod tests {
    use super::super::points::Points;
    use super::super::twin::{DRAG, Twin, wall_with};
    use super::*;
    use crate::diagnose::formula::{Atom, Law, Shape, Site};
    use crate::diagnose::hypothesis::Addition;
    use crate::diagnose::trials::closes_held_out;

    /// A law of velocity on a wall with a drag, fitted and moved off by so many standard deviations, and with numbers left open.
    fn tried(noise_rad: f64, shape: Shape, off_sd: f64) -> (FittedHypothesis, Option<FittedHypothesis>) {
        let twin = Twin::new(&wall_with(DRAG), noise_rad);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let reach = Points::new(trials.data.fit.tests, &h).expect("points").reach[Site::Top as usize];
        let law = Law::of(Atom {
            site: Site::Top,
            shape,
            numbers: [if shape == Shape::Drag { 2.0 } else { 0.5 }, 0.0],
            size: 4000.0 * reach[1] * reach[1],
            reach,
            is_exact: false,
        });
        let h = trials.hypothesis(&trials.experiment.nuisances, &[Addition::Formula(law)]);
        let own = wall.recalibrated.fit.values.iter().copied();
        let values = own.chain(law.values()).collect::<Vec<_>>();
        let mut found = refit(&trials.data, h, &wall.recalibrated, &values).expect("a fit");
        // Where noise might have left its numbers: along the direction that the tests fitted tell least of.
        let covariance = found.fit.covariance.clone().expect("numbers that are told");
        let loose = covariance.symmetric_eigen();
        let k = loose.eigenvalues.imax();
        let step = loose.eigenvectors.column(k) * loose.eigenvalues[k].sqrt() * off_sd;
        let values =
            found.fit.values.iter().zip(step.iter()).map(|(value, step)| value + step).collect::<Vec<_>>();
        if off_sd != 0.0 {
            found =
                crate::diagnose::trials::with_values(&trials.data, found.hypothesis.clone(), &found, &values)
                    .expect("a wall");
        }
        let moved = trials.moved_in_what_is_open(&found);
        (found, moved)
    }

    #[test]
    fn analytic_a_right_law_follows_tests_held_out_with_numbers_that_those_fitted_leave_open() {
        let (found, moved) = tried(1e-4, Shape::Drag, 2.0);
        let moved = moved.expect("numbers that are left open");
        // Two standard deviations along one direction are two logarithms, which come back, and noise in each of four numbers half a one.
        let lost = moved.in_tests_fitted() - found.in_tests_fitted();
        assert!(lost.abs() < 4.0, "{lost}");
        let [before, after] = [&found, &moved].map(|law| law.errors()[1]);
        assert!(closes_held_out(&moved) && after < before, "{before:?} to {after:?}");
    }

    #[test]
    fn analytic_a_law_that_only_imitates_another_has_no_such_numbers() {
        let (found, moved) = tried(3e-5, Shape::DragSaturation, 0.0);
        assert!(moved.is_none_or(|moved| !closes_held_out(&moved)), "{:?}", found.errors());
    }

    #[test]
    fn analytic_numbers_may_move_where_nothing_but_the_larger_motion_speaks_against_a_law() {
        assert!(may_move(&[Guard::HeldOut]) && may_move(&[Guard::Gap, Guard::HeldOut]));
        assert!(!may_move(&[Guard::Gap]) && !may_move(&[]));
        assert!(!may_move(&[Guard::HeldOut, Guard::SecondAtom]));
        assert!(!may_move(&[Guard::HeldOut, Guard::InsideRange]));
    }
}

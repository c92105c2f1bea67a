//! Every window of a fit linear, and what is still known of that after a step.

use super::linear::{Linear, Sides, first_changes, next_changes};
use super::{Fit, Problem, WindowFit};
use crate::diagnose::hypothesis::Hypothesis;
use crate::experiment::Window;
use nalgebra::DMatrix;

/// Every window of a fit linear, for the values and states that the fit had then.
#[derive(Debug)]
pub(super) struct Linearised {
    values: Vec<f64>,
    states: Vec<Vec<f64>>,
    sides: Sides,
    /// Changes of the values over which slopes are taken next.
    changes: Vec<f64>,
    pub windows: Vec<Linear>,
}

/// What is known of a window beforehand.
enum Known {
    /// It is where it was, under the same values.
    All(Linear),
    /// Its Jacobian by the state, from nearby.
    Chord(DMatrix<f64>),
    Nothing,
}

impl Linearised {
    /// What is still known of the windows of a fit. Enough to walk by, a Jacobian by the state serves for one more step,
    /// unless the state has moved beyond what the measurement leaves open.
    fn known(self, windows: &[Window], fit: &Fit, sides: Sides) -> Vec<Known> {
        let same = self.values == fit.values && self.sides == sides;
        let of = |((linear, x), (window, now)): ((Linear, Vec<f64>), (&Window, &WindowFit))| {
            let moved = x.iter().zip(&now.x).map(|(before, now)| (now - before).abs());
            match same && x == now.x {
                true => Known::All(linear),
                false
                    if sides == Sides::OneWhereClear
                        && linear.is_fresh
                        && moved.zip(&window.spread).all(|(moved, spread)| moved < *spread) =>
                {
                    Known::Chord(linear.jx)
                }
                false => Known::Nothing,
            }
        };
        let before = self.windows.into_iter().zip(self.states);
        before.zip(windows.iter().zip(&fit.windows)).map(of).collect()
    }
}

impl Problem<'_> {
    /// Every window, linear about the fit; `None` if a neighbour is no wall. What is known of windows that are where they
    /// were is kept.
    pub(super) fn linearised(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        known: Option<Linearised>,
        sides: Sides,
    ) -> Option<Linearised> {
        let changes = known.as_ref().map_or_else(|| first_changes(h), |known| known.changes.clone());
        let known = known.map_or_else(
            || self.windows.iter().map(|_| Known::Nothing).collect(),
            |known| known.known(self.windows, fit, sides),
        );
        let states = self.states_of(fit);
        let (mut windows, mut open) = (Vec::with_capacity(known.len()), Vec::new());
        for (known, state) in known.into_iter().zip(states) {
            let (linear, chord) = match known {
                Known::All(linear) => (Some(linear), None),
                Known::Chord(chord) => (None, Some(chord)),
                Known::Nothing => (None, None),
            };
            if linear.is_none() {
                open.push((state, chord));
            }
            windows.push(linear);
        }
        if !open.is_empty() {
            let mut found = self.linear_of(h, fit, &open, &changes, sides)?.into_iter();
            windows.iter_mut().filter(|known| known.is_none()).for_each(|window| *window = found.next());
        }
        let windows = windows.into_iter().flatten().collect::<Vec<_>>();
        let changes = next_changes(h, &windows);
        let states = fit.windows.iter().map(|w| w.x.clone()).collect();
        Some(Linearised { values: fit.values.clone(), states, sides, changes, windows })
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear::tests::swaying;
    use super::*;

    #[test]
    fn analytic_only_windows_that_moved_are_made_linear_again() {
        let (tests, h) = swaying();
        let windows = crate::experiment::windows(&tests);
        let problem = Problem { tests: &tests, windows: &windows, budget: None };
        let mut fit = problem.states(&h, &h.start(), &problem.measured_states(), 0, false).expect("a wall");
        let first = problem.linearised(&h, &fit, None, Sides::Both).expect("a wall");
        let before = first.windows.iter().map(|linear| linear.jp.clone()).collect::<Vec<_>>();
        assert!(before.len() > 1 && before.iter().all(|jp| jp.amax() > 0.0), "{before:?}");
        // Another change of the damper would give other digits, if the windows were made linear again.
        let changes = first.changes.clone();
        assert_ne!(changes, first_changes(&h));
        fit.windows[0].x[0] += 0.1 * windows[0].spread[0];
        let again = problem.linearised(&h, &fit, Some(first), Sides::Both).expect("a wall");
        let anew = problem.linear(&h, &fit, &changes, Sides::Both).expect("a wall");
        assert_eq!(again.windows[0].jp, anew[0].jp);
        assert_eq!(again.windows[0].r, anew[0].r);
        assert!((1..before.len()).all(|k| again.windows[k].jp == before[k] && anew[k].jp != before[k]));
        // With another number nothing is kept.
        fit.values[0] += changes[0];
        let moved = problem.linearised(&h, &fit, Some(again), Sides::Both).expect("a wall");
        assert!(moved.windows.iter().zip(&before).all(|(linear, before)| linear.jp != *before));
    }

    #[test]
    fn analytic_a_jacobian_by_the_state_serves_for_one_step_more() {
        let (tests, h) = swaying();
        let windows = crate::experiment::windows(&tests);
        let problem = Problem { tests: &tests, windows: &windows, budget: None };
        let mut fit = problem.states(&h, &h.start(), &problem.measured_states(), 0, false).expect("a wall");
        let first = problem.linearised(&h, &fit, None, Sides::OneWhereClear).expect("a wall");
        let jacobian = |of: &Linearised, k: usize| of.windows[k].jx.clone();
        let before = [0, 1].map(|k| jacobian(&first, k));
        fit.values[0] += first.changes[0];
        // A state that moves farther than the measurement leaves open is looked at anew.
        fit.windows[1].x[0] += 1.1 * windows[1].spread[0];
        let second = problem.linearised(&h, &fit, Some(first), Sides::OneWhereClear).expect("a wall");
        assert!(jacobian(&second, 0) == before[0] && jacobian(&second, 1) != before[1]);
        fit.values[0] += second.changes[0];
        let third = problem.linearised(&h, &fit, Some(second), Sides::OneWhereClear).expect("a wall");
        assert!(jacobian(&third, 0) != before[0]);
    }
}

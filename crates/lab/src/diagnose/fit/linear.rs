//! Windows linear in the numbers of a hypothesis and in the state at their start.
//!
//! An impact that occurs on one side of a small change only makes a slope of any steepness. Such a window would keep a fit
//! where it is. It would make a number look known a hundred times better than it is. So it has no slopes here; what it
//! costs still counts.

use super::window_fit::{At, InState, in_chunks, owned, state_jacobians};
use super::{Fit, Problem, Replay};
use crate::diagnose::hypothesis::{Hypothesis, Unknown};
use nalgebra::{DMatrix, DVector};

/// A sensitivity is taken over a change of the residuals of this many standard deviations of the noise ...
const CHANGE: f64 = 0.3;
/// ... in this share of the windows that change by more than that at all ...
const MOST: f64 = 0.9;
const SHOWS: f64 = 0.01;
/// ... and over these shares of a number's scale.
const CHANGE_SHARES: [f64; 2] = [1e-6, 0.05];
/// Most of the range between its bounds: one side lies within them.
const MOST_OF_RANGE: f64 = 0.25;
/// The share of its scale before anything is known.
const FIRST_CHANGE_SHARE: f64 = 1e-3;
/// A window that changes more than this, in standard deviations of the noise, is asked whether it is linear.
const DOUBTFUL: f64 = 2.0 * CHANGE;
/// Slopes of either side that differ by more than this share of the smaller are of no straight line. Chosen, between
/// the few percent of most windows and the whole slope of one with an impact on one side only.
const BENT: f64 = 0.25;

/// From which sides of a value slopes are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sides {
    /// From both.
    Both,
    /// From one, but for windows that change so much that they may not be linear: enough to walk by.
    OneWhereClear,
}

/// One window, linear about a state and values; all derivatives by the values are zero where it is not.
#[derive(Debug)]
pub(super) struct Linear {
    /// Residuals by the state ...
    pub jx: DMatrix<f64>,
    /// ... and whether they were taken here, and not nearby.
    pub is_fresh: bool,
    /// Residuals by the values.
    pub jp: DMatrix<f64>,
    /// Residuals, in standard deviations of the noise.
    pub r: DVector<f64>,
    /// Jp and r without what the state can do.
    pub jp_left: DMatrix<f64>,
    pub r_left: DVector<f64>,
    /// Whether it is linear.
    pub holds: bool,
}

impl Linear {
    /// From the slopes to either side.
    fn new(
        (jx, is_fresh): (DMatrix<f64>, bool),
        jp: [DMatrix<f64>; 2],
        r: DVector<f64>,
        changes: &[f64],
    ) -> Self {
        let q = if jx.ncols() > 0 { jx.clone().qr().q() } else { jx.clone() };
        let left = |columns: &DMatrix<f64>| columns - &q * q.tr_mul(columns);
        let sides = jp.each_ref().map(left);
        let r_left = &r - &q * q.tr_mul(&r);
        let mut jp = (&jp[0] + &jp[1]) * 0.5;
        let mut jp_left = (&sides[0] + &sides[1]) * 0.5;
        let holds = !changes.iter().enumerate().any(|(i, change)| is_bent(&sides, i, *change));
        if !holds {
            jp.fill(0.0);
            jp_left.fill(0.0);
        }
        Self { jx, is_fresh, jp, r, jp_left, r_left, holds }
    }

    /// Root mean square of the change that a change of one value makes, in standard deviations of the noise.
    fn size(&self, value: usize) -> f64 {
        (self.jp_left.column(value).norm_squared() / self.r.len() as f64).sqrt()
    }
}

/// One window about a fit, without what its state can do: the residuals, and how they change with the values.
#[derive(Debug, Clone)]
pub struct WindowSlopes {
    /// Residuals, in standard deviations of the noise.
    pub residual: DVector<f64>,
    /// Their derivatives, a column a value; zero where the window is not linear.
    pub by_values: DMatrix<f64>,
    /// Whether the window is linear.
    pub holds: bool,
}

/// The wall with one number changed.
struct Neighbour<'t> {
    replay: Replay<'t>,
    change: f64,
    /// The coefficient C_l that the number scales, by its index, where it does nothing else.
    coefficient: Option<usize>,
}

impl Neighbour<'_> {
    /// Slopes of the residuals of windows. Where the change that a coefficient belongs to does not occur, they are zero.
    fn slopes(&self, these: &[&At]) -> Vec<DVector<f64>> {
        let acts = |at: &&At| self.coefficient.is_none_or(|l| at.changes[l]);
        let asked = these.iter().filter(|at| acts(at)).map(|at| (at.window, &at.x[..])).collect::<Vec<_>>();
        let mut found = self.replay.followed(&asked).into_iter();
        let mut near = |at: &At| if acts(&at) { found.next() } else { None };
        let slope = |at: &&At| match near(at) {
            Some(near) => (near.r - &at.r) / self.change,
            None => DVector::zeros(at.r.len()),
        };
        these.iter().map(slope).collect()
    }
}

/// Slopes of windows to either side of a value. Where one side serves, it stands for both in windows that are clear.
fn slopes_to([one, two]: &[Neighbour; 2], these: &[At], sides: Sides) -> [Vec<DVector<f64>>; 2] {
    let after = one.slopes(&these.iter().collect::<Vec<_>>());
    let asked =
        |slope: &DVector<f64>| sides == Sides::Both || is_doubtful(slope.norm(), slope.len(), one.change);
    let doubtful = after.iter().zip(these).filter(|(slope, _)| asked(slope)).map(|(_, at)| at);
    let mut found = two.slopes(&doubtful.collect::<Vec<_>>()).into_iter();
    let mut before = |slope: &DVector<f64>| if asked(slope) { found.next() } else { None };
    let before = after.iter().map(|slope| before(slope).unwrap_or_else(|| slope.clone())).collect();
    [after, before]
}

/// Whether a window whose slopes have this length changes so much with a value that it may not be linear.
fn is_doubtful(length: f64, residuals: usize, change: f64) -> bool {
    length > DOUBTFUL * (residuals as f64).sqrt() / change.abs()
}

impl Problem<'_> {
    /// How each window of a fit changes with the values, and over which changes of the values that was taken. These
    /// are the given ones, or fitting ones. `None` if a neighbour is no wall.
    pub fn slopes(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        changes: Option<&[f64]>,
    ) -> Option<(Vec<WindowSlopes>, Vec<f64>)> {
        let changes = match changes {
            Some(changes) => changes.to_vec(),
            None => next_changes(h, &self.linear(h, fit, &first_changes(h), Sides::OneWhereClear)?),
        };
        Some((self.slopes_over(h, fit, &changes, None)?, changes))
    }

    /// How each window of a fit changes with the values over these changes of them, where its Jacobian by the state may be
    /// known. `None` if a neighbour is no wall.
    pub fn slopes_over(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        changes: &[f64],
        chords: Option<&[DMatrix<f64>]>,
    ) -> Option<Vec<WindowSlopes>> {
        let chord = |k: usize| chords.and_then(|chords| chords.get(k).cloned());
        let states = self.states_of(fit).into_iter().enumerate().map(|(k, state)| (state, chord(k)));
        let linear = self.linear_of(h, fit, &states.collect::<Vec<_>>(), changes, Sides::Both)?;
        let of = |l: Linear| WindowSlopes { residual: l.r_left, by_values: l.jp_left, holds: l.holds };
        Some(linear.into_iter().map(of).collect())
    }

    /// Every window, linear about the fit; `None` if a neighbour is no wall.
    pub(super) fn linear(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        changes: &[f64],
        sides: Sides,
    ) -> Option<Vec<Linear>> {
        let states = self.states_of(fit).into_iter().map(|state| (state, None)).collect::<Vec<_>>();
        self.linear_of(h, fit, &states, changes, sides)
    }

    /// Windows in states, some with a Jacobian by the state, linear about them and the values of a fit.
    pub(super) fn linear_of(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        these: &[(InState, Option<DMatrix<f64>>)],
        changes: &[f64],
        sides: Sides,
    ) -> Option<Vec<Linear>> {
        let replay = self.replay(&h.physics(&fit.values)?);
        let neighbours = |(i, change): (usize, &f64)| both_sides(h, fit, &replay, (i, *change));
        let neighbours = changes.iter().enumerate().map(neighbours).collect::<Option<Vec<_>>>()?;
        let linear = |these: &[(InState, Option<DMatrix<f64>>)]| {
            let (states, chords): (Vec<_>, Vec<_>) =
                these.iter().map(|(state, chord)| (*state, chord)).unzip();
            let these = At::all(&replay, owned(&states));
            let without = these.iter().zip(&chords).filter(|(_, chord)| chord.is_none());
            let mut fresh =
                state_jacobians(&replay, &without.map(|(at, _)| at).collect::<Vec<_>>()).into_iter();
            let jx = chords.iter().filter_map(|chord| match chord {
                Some(chord) => Some((chord.clone(), false)),
                None => Some((fresh.next()?, true)),
            });
            let jx = jx.collect::<Vec<_>>();
            let slopes = neighbours.iter().map(|both| slopes_to(both, &these, sides)).collect::<Vec<_>>();
            let columns = |side: usize, k: usize| {
                DMatrix::from_columns(&slopes.iter().map(|of| of[side][k].column(0)).collect::<Vec<_>>())
            };
            let all = these.into_iter().zip(jx).enumerate();
            all.map(|(k, (at, jx))| Linear::new(jx, [columns(0, k), columns(1, k)], at.r, changes)).collect()
        };
        Some(in_chunks(these, linear))
    }
}

/// The wall to either side of a value; at a bound, by the whole and by half of the change.
fn both_sides<'t>(
    h: &Hypothesis,
    fit: &Fit,
    replay: &Replay<'t>,
    (i, change): (usize, f64),
) -> Option<[Neighbour<'t>; 2]> {
    let Unknown { lower, upper, .. } = h.unknowns[i];
    let inside = |by: &f64| (lower..=upper).contains(&(fit.values[i] + by));
    let at = |by: f64| Some(by).filter(inside).and_then(|by| neighbour(h, fit, replay, (i, by)));
    match (at(change), at(-change)) {
        (Some(after), Some(before)) => Some([after, before]),
        (Some(far), None) => Some([far, neighbour(h, fit, replay, (i, 0.5 * change))?]),
        (None, Some(far)) => Some([far, neighbour(h, fit, replay, (i, -0.5 * change))?]),
        (None, None) => None,
    }
}

fn neighbour<'t>(
    h: &Hypothesis,
    fit: &Fit,
    replay: &Replay<'t>,
    (i, change): (usize, f64),
) -> Option<Neighbour<'t>> {
    let mut values = fit.values.clone();
    values[i] += change;
    let replay = replay.near(&h.physics(&values)?);
    Some(Neighbour { replay, change, coefficient: h.coefficient_of(i) })
}

/// Whether the slopes to either side of a value are of no straight line, in a window that changes much with it.
fn is_bent(sides: &[DMatrix<f64>; 2], value: usize, change: f64) -> bool {
    let [one, two] = sides.each_ref().map(|side| side.column(value));
    is_doubtful(one.norm().max(two.norm()), one.len(), change)
        && (one - two).norm() > BENT * one.norm().min(two.norm())
}

/// Changes of the numbers to begin with.
pub(super) fn first_changes(h: &Hypothesis) -> Vec<f64> {
    let change = |u: &Unknown| (FIRST_CHANGE_SHARE * u.scale).min(MOST_OF_RANGE * (u.upper - u.lower));
    h.unknowns.iter().map(change).collect()
}

/// Changes of the numbers over which the next sensitivities are taken. They are small beside the noise in most
/// windows in which a number shows at all. An impact of a rare kind shows in few.
pub(super) fn next_changes(h: &Hypothesis, linear: &[Linear]) -> Vec<f64> {
    let of = |(i, unknown): (usize, &Unknown)| {
        let [least, most] = CHANGE_SHARES.map(|share| share * unknown.scale);
        let most = most.min(MOST_OF_RANGE * (unknown.upper - unknown.lower));
        let sizes = linear.iter().map(|l| l.size(i));
        let mut shows = sizes.filter(|size| size * most > SHOWS).collect::<Vec<_>>();
        shows.sort_by(f64::total_cmp);
        let upper = shows.get((shows.len() as f64 * MOST) as usize);
        upper.map_or(most, |upper| (CHANGE / upper).max(least).min(most))
    };
    h.unknowns.iter().enumerate().map(of).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A window of four residuals, one number of the state and two values, with slopes to either side.
    fn linear(after: [f64; 4], before: [f64; 4]) -> Linear {
        let jx = DMatrix::from_column_slice(4, 1, &[1.0, 1.0, 1.0, 1.0]);
        let side =
            |second: [f64; 4]| DMatrix::from_column_slice(4, 2, &[[1.0, 2.0, 3.0, 4.0], second].concat());
        Linear::new(
            (jx, true),
            [side(after), side(before)],
            DVector::from_vec(vec![2.0, 0.0, 0.0, 0.0]),
            &[1.0, 1.0],
        )
    }

    #[test]
    fn analytic_what_the_state_can_do_is_left_out() {
        let found = linear([4.0, 0.0, 0.0, 0.0], [4.0, 0.0, 0.0, 0.0]);
        // Columns less their means; roundings of a few products.
        let near = |a: DVector<f64>, b: [f64; 4]| (a - DVector::from_column_slice(&b)).amax() < 1e-14;
        assert!(near(found.r_left, [1.5, -0.5, -0.5, -0.5]));
        assert!(near(found.jp_left.column(0).into_owned(), [-1.5, -0.5, 0.5, 1.5]));
        assert!(near(found.jp_left.column(1).into_owned(), [3.0, -1.0, -1.0, -1.0]));
    }

    #[test]
    fn analytic_a_window_that_parts_on_one_side_of_a_value_tells_nothing() {
        let parted = linear([4.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 40.0]);
        assert!(
            !parted.holds
                && parted.jp_left.amax() == 0.0
                && parted.jp.amax() == 0.0
                && parted.r_left.amax() > 0.0
        );
        // A change far inside the noise may bend as it likes: both sides are averaged.
        let little = linear([0.4, 0.0, 0.0, 0.0], [0.0, 0.4, 0.0, 0.0]);
        assert!(little.holds);
        assert_eq!(little.jp[(0, 1)], 0.2);
        assert_eq!(little.jp[(1, 1)], 0.2);
    }

    /// The windows of a wall that sways, fitted with a damper at the top.
    pub(in crate::diagnose::fit) fn swaying() -> ([crate::experiment::TestData; 1], Hypothesis) {
        let h = crate::diagnose::hypothesis::example::starter_with(&["viscous_damping"]);
        ([super::super::replay::tests::swaying().0], h)
    }

    #[test]
    fn analytic_slopes_of_one_side_are_those_of_both_where_windows_are_clear() {
        let (tests, h) = swaying();
        let windows = crate::experiment::windows(&tests);
        let problem = Problem { tests: &tests, windows: &windows, budget: None };
        let fit = problem.states(&h, &h.start(), &problem.measured_states(), 0, false).expect("a wall");
        let [both, one] = [Sides::Both, Sides::OneWhereClear]
            .map(|sides| problem.linear(&h, &fit, &first_changes(&h), sides).expect("a wall"));
        for (both, one) in both.iter().zip(&one).filter(|(both, _)| both.holds) {
            // A damper is linear but for what its loss does to the motion within a window.
            assert!((&both.jp - &one.jp).amax() < BENT * both.jp.amax(), "{} {}", both.jp, one.jp);
        }
        assert!(
            both.iter().zip(&one).any(|(both, one)| both.jp != one.jp),
            "both sides were asked everywhere"
        );
    }
}

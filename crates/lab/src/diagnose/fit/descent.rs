//! Steps of a hypothesis' numbers, with the states of the windows eliminated.
//!
//! For a step every window is made linear in the numbers and in the state at its start. An impact that occurs on one side
//! of a small change only makes a slope of any steepness. Such a window would keep a fit where it is. It would make a
//! number look known a hundred times better than it is. So it has no slopes here; what it costs still counts.

use super::window_fit::{At, InState, in_chunks, newton_step, owned, state_jacobians, take_steps};
use super::{Fit, Loss, Problem, Replay, WindowFit};
use crate::diagnose::hypothesis::{Hypothesis, Unknown};
use nalgebra::{DMatrix, DVector};

/// When to end the steps with one loss.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    /// Most steps.
    steps: usize,
    /// Gain in the loss not worth another step: at least, and as a share of the loss.
    little: f64,
    little_share: f64,
}

/// To the end.
pub const FINE: Patience = Patience { steps: 10, little: 1.0, little_share: 0.0 };
/// To tell what is far from the truth.
pub const COARSE: Patience = Patience { steps: 5, little: 1.0, little_share: 2e-3 };
/// Damping of a step (Levenberg and Marquardt): first, factor, tries.
const FIRST_DAMPING: f64 = 1e-4;
const DAMPING_FACTOR: f64 = 10.0;
const TRIES: usize = 5;
/// Longest step of a number, as a multiple of its size or of a size that matters. Without it a number that leaves no
/// trace is tried at its bounds, where dampers are so stiff that a fit takes minutes.
const MOST_OF_SIZE: f64 = 10.0;

impl Problem<'_> {
    /// Steps of the numbers, damped after Levenberg and Marquardt, until they gain little.
    pub(super) fn descend(&self, h: &Hypothesis, mut fit: Fit, loss: Loss, patience: Patience) -> Fit {
        if h.unknowns.is_empty() {
            return fit;
        }
        fit.cost = cost(h, &fit, loss);
        let mut changes = first_changes(h);
        let mut damping = FIRST_DAMPING;
        for _ in 0..patience.steps {
            let Some(linear) = self.linear(h, &fit, &changes) else { return fit };
            changes = next_changes(h, &linear);
            let (a, g) = normal_equations(h, &fit, &linear, loss);
            fit.covariance = a.clone().cholesky().map(|c| c.inverse());
            let before = fit.cost;
            for _ in 0..TRIES {
                if let Some(next) = self.step(h, &fit, &linear, (&a, &g), damping, loss)
                    && next.cost < fit.cost
                {
                    fit = Fit { covariance: fit.covariance.take(), ..next };
                    damping = (damping / DAMPING_FACTOR).max(1e-9);
                    break;
                }
                damping *= DAMPING_FACTOR;
            }
            if before - fit.cost < patience.little.max(patience.little_share * before) {
                break;
            }
        }
        fit
    }

    /// One damped step of the numbers; the states go with it as the linear windows say, and once more from there.
    fn step(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        linear: &[Linear],
        (a, g): (&DMatrix<f64>, &DVector<f64>),
        damping: f64,
        loss: Loss,
    ) -> Option<Fit> {
        let mut damped = a.clone();
        for i in 0..damped.nrows() {
            damped[(i, i)] *= 1.0 + damping;
        }
        let dp = -damped.cholesky()?.solve(g);
        let within = |(i, u): (usize, &Unknown)| {
            let most = MOST_OF_SIZE * u.scale.max((fit.values[i] - u.start).abs());
            (fit.values[i] + dp[i].clamp(-most, most)).clamp(u.lower, u.upper)
        };
        let values = h.unknowns.iter().enumerate().map(within).collect::<Vec<_>>();
        let dp =
            DVector::from_iterator(values.len(), values.iter().zip(&fit.values).map(|(new, old)| new - old));
        let replay = Replay::new(self.tests, &h.physics(&values)?);
        let follow = |these: &[(InState, &Linear)]| followed(&replay, these, &dp);
        let these = self.states_of(fit).into_iter().zip(linear).collect::<Vec<_>>();
        let windows = in_chunks(&these, follow);
        let mut next = Fit { values, windows, cost: 0.0, covariance: None };
        next.cost = cost(h, &next, loss);
        Some(next)
    }
}

/// The states of windows after a step dp of the numbers: as the linear windows say, and a step with their old Jacobians.
fn followed(replay: &Replay, these: &[(InState, &Linear)], dp: &DVector<f64>) -> Vec<WindowFit> {
    let (states, linear): (Vec<_>, Vec<_>) = these.iter().copied().unzip();
    let mut all = At::all(replay, owned(&states));
    let has_state = |l: &&&Linear| l.jx.ncols() > 0;
    let said = |l: &&Linear| Some(l).filter(has_state).and_then(|l| newton_step(&l.jx, &(&l.r + &l.jp * dp)));
    take_steps(replay, &mut all, linear.iter().map(said).collect());
    let again = |(l, at): (&&Linear, &At)| Some(l).filter(has_state).and_then(|l| newton_step(&l.jx, &at.r));
    let steps = linear.iter().zip(&all).map(again).collect();
    take_steps(replay, &mut all, steps);
    all.into_iter().map(At::fit).collect()
}

/// Loss of the windows and prior together.
pub fn cost(h: &Hypothesis, fit: &Fit, loss: Loss) -> f64 {
    let windows = fit.windows.iter().map(|w| loss.of(w)).sum::<f64>();
    windows + h.prior_penalty(&fit.values)
}

/// What the linear windows say of the numbers once their states are eliminated, with what was known before.
fn normal_equations(
    h: &Hypothesis,
    fit: &Fit,
    linear: &[Linear],
    loss: Loss,
) -> (DMatrix<f64>, DVector<f64>) {
    let count = h.unknowns.len();
    let (mut a, mut g) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (window, linear) in fit.windows.iter().zip(linear) {
        let w = loss.weight(window);
        a += linear.jp_left.transpose() * &linear.jp_left * w;
        g += linear.jp_left.transpose() * &linear.r_left * w;
    }
    h.add_prior(&fit.values, &mut a, &mut g);
    for (i, unknown) in h.unknowns.iter().enumerate() {
        // A number without a trace stays where it is.
        a[(i, i)] += 1e-12 / (unknown.scale * unknown.scale);
    }
    (a, g)
}

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

/// One window, linear about a state and values; all derivatives by the values are zero where it is not.
pub(super) struct Linear {
    /// Residuals by the state.
    pub jx: DMatrix<f64>,
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
    fn new(jx: DMatrix<f64>, jp: [DMatrix<f64>; 2], r: DVector<f64>, changes: &[f64]) -> Self {
        let q = if jx.ncols() > 0 { jx.clone().qr().q() } else { jx.clone() };
        let left = |columns: &DMatrix<f64>| columns - &q * (q.transpose() * columns);
        let sides = jp.each_ref().map(left);
        let r_left = &r - &q * (q.transpose() * &r);
        let mut jp = (&jp[0] + &jp[1]) * 0.5;
        let mut jp_left = (&sides[0] + &sides[1]) * 0.5;
        let holds = !changes.iter().enumerate().any(|(i, change)| is_bent(&sides, i, *change));
        if !holds {
            jp.fill(0.0);
            jp_left.fill(0.0);
        }
        Self { jx, jp, r, jp_left, r_left, holds }
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
}

impl Neighbour<'_> {
    /// Slopes of the residuals of windows.
    fn slopes(&self, these: &[At]) -> Vec<DVector<f64>> {
        let asked = these.iter().map(|at| (at.window, &at.x[..])).collect::<Vec<_>>();
        let found = self.replay.residuals(&asked);
        found.into_iter().zip(these).map(|(r, at)| (r - &at.r) / self.change).collect()
    }
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
            None => next_changes(h, &self.linear(h, fit, &first_changes(h))?),
        };
        let linear = self.linear(h, fit, &changes)?;
        let of = |l: Linear| WindowSlopes { residual: l.r_left, by_values: l.jp_left, holds: l.holds };
        Some((linear.into_iter().map(of).collect(), changes))
    }

    /// Every window, linear about the fit; `None` if a neighbour is no wall.
    pub(super) fn linear(&self, h: &Hypothesis, fit: &Fit, changes: &[f64]) -> Option<Vec<Linear>> {
        let replay = Replay::new(self.tests, &h.physics(&fit.values)?);
        let sides = |(i, change): (usize, &f64)| self.sides(h, fit, i, *change);
        let sides = changes.iter().enumerate().map(sides).collect::<Option<Vec<_>>>()?;
        let linear = |these: &[InState]| {
            let these = At::all(&replay, owned(these));
            let jx = state_jacobians(&replay, &these.iter().collect::<Vec<_>>());
            let slopes =
                [0, 1].map(|side| sides.iter().map(|both| both[side].slopes(&these)).collect::<Vec<_>>());
            let columns = |side: usize, k: usize| {
                DMatrix::from_columns(&slopes[side].iter().map(|of| of[k].column(0)).collect::<Vec<_>>())
            };
            let all = these.into_iter().zip(jx).enumerate();
            all.map(|(k, (at, jx))| Linear::new(jx, [columns(0, k), columns(1, k)], at.r, changes)).collect()
        };
        Some(in_chunks(&self.states_of(fit), linear))
    }

    /// The wall to either side of a value; at a bound, by the whole and by half of the change.
    fn sides(&self, h: &Hypothesis, fit: &Fit, i: usize, change: f64) -> Option<[Neighbour<'_>; 2]> {
        let Unknown { lower, upper, .. } = h.unknowns[i];
        let inside = |by: &f64| (lower..=upper).contains(&(fit.values[i] + by));
        let at = |by: f64| Some(by).filter(inside).and_then(|by| self.neighbour(h, fit, i, by));
        match (at(change), at(-change)) {
            (Some(after), Some(before)) => Some([after, before]),
            (Some(far), None) => Some([far, self.neighbour(h, fit, i, 0.5 * change)?]),
            (None, Some(far)) => Some([far, self.neighbour(h, fit, i, -0.5 * change)?]),
            (None, None) => None,
        }
    }

    fn neighbour(&self, h: &Hypothesis, fit: &Fit, i: usize, change: f64) -> Option<Neighbour<'_>> {
        let mut values = fit.values.clone();
        values[i] += change;
        Some(Neighbour { replay: Replay::new(self.tests, &h.physics(&values)?), change })
    }
}

/// Whether the slopes to either side of a value are of no straight line, in a window that changes much with it.
fn is_bent(sides: &[DMatrix<f64>; 2], value: usize, change: f64) -> bool {
    let [one, two] = sides.each_ref().map(|side| side.column(value));
    let much = DOUBTFUL * (one.len() as f64).sqrt() / change.abs();
    one.norm().max(two.norm()) > much && (one - two).norm() > BENT * one.norm().min(two.norm())
}

/// Changes of the numbers to begin with.
fn first_changes(h: &Hypothesis) -> Vec<f64> {
    let change = |u: &Unknown| (FIRST_CHANGE_SHARE * u.scale).min(MOST_OF_RANGE * (u.upper - u.lower));
    h.unknowns.iter().map(change).collect()
}

/// Changes of the numbers over which the next sensitivities are taken. They are small beside the noise in most
/// windows in which a number shows at all. An impact of a rare kind shows in few.
fn next_changes(h: &Hypothesis, linear: &[Linear]) -> Vec<f64> {
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
mod tests {
    use super::*;

    /// A window of four residuals, one number of the state and two values, with slopes to either side.
    fn linear(after: [f64; 4], before: [f64; 4]) -> Linear {
        let jx = DMatrix::from_column_slice(4, 1, &[1.0, 1.0, 1.0, 1.0]);
        let side =
            |second: [f64; 4]| DMatrix::from_column_slice(4, 2, &[[1.0, 2.0, 3.0, 4.0], second].concat());
        Linear::new(jx, [side(after), side(before)], DVector::from_vec(vec![2.0, 0.0, 0.0, 0.0]), &[1.0, 1.0])
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
}

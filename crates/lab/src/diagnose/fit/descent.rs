//! Steps of a hypothesis' numbers, with the states of the windows eliminated.

use super::linear::{Linear, Sides};
use super::linearised::Linearised;
use super::window_fit::{At, InState, LITTLE, NewtonStep, in_chunks, owned, step_of, take_steps};
use super::{Fit, Loss, Problem, Replay, WindowFit};
use crate::diagnose::hypothesis::{Hypothesis, Unknown};
use nalgebra::{DMatrix, DVector};

/// How the steps with one loss are taken, and when they end.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    /// Most steps.
    steps: usize,
    /// Gain in the loss not worth another step: at least, and as a share of the loss.
    little: f64,
    little_share: f64,
    sides: Sides,
}

impl Patience {
    /// The gain in a loss of this size that is not worth another step.
    fn little(self, cost: f64) -> f64 {
        self.little.max(self.little_share * cost)
    }
}

/// To the end, with the last loss: intervals come from there.
pub const LAST: Patience = Patience { steps: 10, little: 1.0, little_share: 0.0, sides: Sides::Both };
/// To the end, with the losses before.
pub const FINE: Patience = Patience { sides: Sides::OneWhereClear, ..LAST };
/// To tell what is far from the truth.
pub const COARSE: Patience = Patience { steps: 5, little_share: 2e-3, ..FINE };
/// To tell which of several starts come to one place.
pub const FIRST: Patience = Patience { steps: 2, ..FINE };
/// Share of the gain not worth another step that a step must promise, for windows to be simulated for it.
const WORTH_TRYING: f64 = 0.1;
/// Damping of a step (Levenberg and Marquardt): first, factor, tries.
const FIRST_DAMPING: f64 = 1e-4;
const DAMPING_FACTOR: f64 = 10.0;
const TRIES: usize = 5;
/// Longest step of a number, as a multiple of its size or of a size that matters. Without it a number that leaves no
/// trace is tried at its bounds, where dampers are so stiff that a fit takes minutes.
const MOST_OF_SIZE: f64 = 10.0;

/// A step of the numbers, and what it promises: by how much the loss falls where windows are linear.
struct NumbersStep {
    values: Vec<f64>,
    change: DVector<f64>,
    promise: f64,
}

impl NumbersStep {
    /// Damped, and within bounds.
    fn new(h: &Hypothesis, fit: &Fit, (a, g): (&DMatrix<f64>, &DVector<f64>), damping: f64) -> Option<Self> {
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
        let change =
            DVector::from_iterator(values.len(), values.iter().zip(&fit.values).map(|(new, old)| new - old));
        // The loss is c + 2 gᵀ dp + dpᵀ a dp.
        let promise = -(2.0 * g.dot(&change) + change.dot(&(a * &change)));
        Some(Self { values, change, promise })
    }
}

impl Problem<'_> {
    /// Steps of the numbers, damped after Levenberg and Marquardt, until they gain little or promise less. What is known of
    /// linear windows is taken from `known`, and left there.
    pub(super) fn descend(
        &self,
        h: &Hypothesis,
        mut fit: Fit,
        loss: Loss,
        patience: Patience,
        known: &mut Option<Linearised>,
    ) -> Fit {
        if h.unknowns.is_empty() {
            return fit;
        }
        fit.cost = cost(h, &fit, loss);
        let mut damping = FIRST_DAMPING;
        for _ in 0..patience.steps {
            if self.is_spent() {
                break;
            }
            let Some(linear) = self.linearised(h, &fit, known.take(), patience.sides) else { return fit };
            let linear = &known.insert(linear).windows;
            let (a, g) = normal_equations(h, &fit, linear, loss);
            fit.covariance = a.clone().cholesky().map(|c| c.inverse());
            let before = fit.cost;
            let little = patience.little(before);
            for _ in 0..TRIES {
                let step = NumbersStep::new(h, &fit, (&a, &g), damping);
                if step.as_ref().is_some_and(|step| step.promise < WORTH_TRYING * little) {
                    break;
                }
                if let Some(next) = step.and_then(|step| self.step(h, &fit, linear, step, loss))
                    && next.cost < fit.cost
                {
                    fit = Fit { covariance: fit.covariance.take(), ..next };
                    damping = (damping / DAMPING_FACTOR).max(1e-9);
                    break;
                }
                damping *= DAMPING_FACTOR;
            }
            if before - fit.cost < little {
                break;
            }
        }
        fit
    }

    /// A fit after a step of the numbers; the states go with it as the linear windows say, and once more from there.
    fn step(
        &self,
        h: &Hypothesis,
        fit: &Fit,
        linear: &[Linear],
        step: NumbersStep,
        loss: Loss,
    ) -> Option<Fit> {
        let NumbersStep { values, change, .. } = step;
        let replay = self.replay(&h.physics(&values)?);
        let follow = |these: &[(InState, &Linear)]| followed(&replay, these, &change);
        let these = self.states_of(fit).into_iter().zip(linear).collect::<Vec<_>>();
        let windows = in_chunks(&these, follow);
        let mut next = Fit { values, windows, cost: 0.0, covariance: None };
        next.cost = cost(h, &next, loss);
        Some(next)
    }
}

/// The states of windows after a step dp of the numbers: as the linear windows say, or as they were where that is better,
/// and a step with their old Jacobians.
fn followed(replay: &Replay, these: &[(InState, &Linear)], dp: &DVector<f64>) -> Vec<WindowFit> {
    let stepped = |(state, linear): &(InState, &Linear)| {
        let step = step_with(linear, &(&linear.r + &linear.jp * dp));
        let by = |i: usize| step.as_ref().map_or(0.0, |step| step.x[i]);
        state.1.iter().enumerate().map(|(i, x)| x + by(i)).collect::<Vec<_>>()
    };
    let mut all = At::all(replay, these.iter().map(|these| (these.0.0, stepped(these))).collect());
    let worse = |(k, at): (usize, &At)| at.r.norm_squared() > these[k].1.r.norm_squared() + LITTLE;
    let worse = all.iter().enumerate().filter(|(k, at)| worse((*k, at))).map(|(k, _)| k).collect::<Vec<_>>();
    let unmoved = At::all(replay, owned(&worse.iter().map(|k| these[*k].0).collect::<Vec<_>>()));
    for (k, unmoved) in worse.into_iter().zip(unmoved) {
        if unmoved.r.norm_squared() < all[k].r.norm_squared() {
            all[k] = unmoved;
        }
    }
    let steps = these.iter().zip(&all).map(|((_, linear), at)| step_with(linear, &at.r)).collect();
    take_steps(replay, &mut all, steps);
    all.into_iter().map(At::fit).collect()
}

/// The step of a window's state with a Jacobian; `None` of a window without a state.
fn step_with(linear: &Linear, residuals: &DVector<f64>) -> Option<NewtonStep> {
    step_of(&linear.jx, residuals).filter(|_| linear.jx.ncols() > 0)
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
        a += linear.jp_left.tr_mul(&linear.jp_left) * w;
        g += linear.jp_left.tr_mul(&linear.r_left) * w;
    }
    h.add_prior(&fit.values, &mut a, &mut g);
    for (i, unknown) in h.unknowns.iter().enumerate() {
        // A number without a trace stays where it is.
        a[(i, i)] += 1e-12 / (unknown.scale * unknown.scale);
    }
    (a, g)
}

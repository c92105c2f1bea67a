//! Steps of a hypothesis' numbers, with the states of the windows eliminated.

use nalgebra::{DMatrix, DVector};

use super::linear::{Linear, first_changes, next_changes};
use super::window_fit::{At, InState, in_chunks, newton_step, owned, take_steps};
use super::{Fit, Loss, Problem, Replay, WindowFit};
use crate::diagnose::hypothesis::{Hypothesis, Unknown};

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
/// Longest step of a number, as a multiple of its size or of a size that matters: without it one that leaves no trace is tried
/// at its bounds, where dampers are so stiff that a fit takes minutes.
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

//! Fits a hypothesis to windows: its numbers, and the state at the start of every window, together.
//!
//! Multiple shooting: the states are eliminated window by window (an orthogonal projection of residuals and
//! sensitivities), which leaves normal equations in the few numbers of the hypothesis; after each step the states follow.

use nalgebra::{DMatrix, DVector};

use super::hypothesis::{Hypothesis, Unknown};
use super::linear::{Linear, first_changes, next_changes};
use super::replay::Replay;
use super::robust::Loss;
use super::score::poor_share;
use super::test_data::TestData;
use super::window_fit::{
    At, InState, WindowFit, fit_windows, in_chunks, newton_step, other_valleys, owned, state_jacobians,
    take_steps,
};
use super::windows::Window;

/// When to end the steps with one loss.
#[derive(Debug, Clone, Copy)]
struct Patience {
    /// Most steps.
    steps: usize,
    /// Gain in the loss not worth another step: at least, and as a share of the loss.
    little: f64,
    little_share: f64,
}

/// To the end.
const FINE: Patience = Patience { steps: 10, little: 1.0, little_share: 0.0 };
/// To tell what is far from the truth.
const COARSE: Patience = Patience { steps: 5, little: 1.0, little_share: 2e-3 };
/// Damping of a step (Levenberg and Marquardt): first, factor, tries.
const FIRST_DAMPING: f64 = 1e-4;
const DAMPING_FACTOR: f64 = 10.0;
const TRIES: usize = 5;
/// Longest step of a number, as a multiple of its size or of a size that matters: without it one that leaves no trace is tried
/// at its bounds, where dampers are so stiff that a fit takes minutes.
const MOST_OF_SIZE: f64 = 10.0;
/// Share of poor windows above which no other valleys are looked for.
const MOST_POOR: f64 = 0.3;

/// A fitted hypothesis.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Its numbers, in the order of [`Hypothesis::unknowns`].
    pub values: Vec<f64>,
    /// Every window.
    pub windows: Vec<WindowFit>,
    /// Loss and prior together.
    pub cost: f64,
    /// Covariance of the numbers from the curvature; none where they leave no trace.
    pub covariance: Option<DMatrix<f64>>,
}

impl Fit {
    /// Squared error over squared noise of every window.
    fn reduced(&self) -> Vec<f64> {
        self.windows.iter().map(WindowFit::reduced).collect()
    }

    /// Whether many windows lie beyond what is felt by the losses that a fit is finished with.
    pub fn is_far(&self) -> bool {
        Loss::let_go_of_many(self.reduced())
    }

    /// Whether the model, and not the states it was given, is what misses the windows.
    pub fn misses_many(&self) -> bool {
        poor_share(&self.windows) > MOST_POOR
    }
}

/// Windows of some tests.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// All tests of the experiment.
    pub tests: &'a [TestData],
    /// The windows that count.
    pub windows: &'a [Window],
}

impl Problem<'_> {
    /// The states as measured.
    pub fn measured_states(&self) -> Vec<Vec<f64>> {
        self.windows.iter().map(|w| w.measured.clone()).collect()
    }

    /// How the residuals of each window change with its state, for the values and states of a fit; none if there is no
    /// such wall.
    pub fn chords(&self, h: &Hypothesis, fit: &Fit) -> Option<Vec<DMatrix<f64>>> {
        let replay = Replay::new(self.tests, &h.physics(&fit.values)?);
        let chords = |these: &[InState]| {
            let at = At::all(&replay, owned(these));
            state_jacobians(&replay, &at.iter().collect::<Vec<_>>())
        };
        Some(in_chunks(&self.states_of(fit), chords))
    }

    /// The windows with the states of a fit.
    pub(super) fn states_of<'f>(&'f self, fit: &'f Fit) -> Vec<InState<'f>> {
        self.windows.iter().zip(fit.windows.iter().map(|state| &state.x[..])).collect()
    }

    /// The states of a fit moved by one step with the chords of another hypothesis nearby, where that helps: a cheap look
    /// at what values would do; none if there is no such wall.
    pub fn glance(&self, h: &Hypothesis, values: &[f64], from: &Fit, chords: &[DMatrix<f64>]) -> Option<Fit> {
        let replay = Replay::new(self.tests, &h.physics(values)?);
        let look = |these: &[(InState, &DMatrix<f64>)]| {
            let (states, chords): (Vec<_>, Vec<_>) = these.iter().copied().unzip();
            let mut all = At::all(&replay, owned(&states));
            let step =
                |(at, chord): (&At, &&DMatrix<f64>)| newton_step(chord, &at.r).filter(|_| chord.ncols() > 0);
            let steps = all.iter().zip(&chords).map(step).collect();
            take_steps(&replay, &mut all, steps);
            all.into_iter().map(At::fit).collect()
        };
        let these = self.states_of(from).into_iter().zip(chords).collect::<Vec<_>>();
        let windows = in_chunks(&these, look);
        let mut found = Fit { values: values.to_vec(), windows, cost: 0.0, covariance: None };
        let loss = Loss::of_starts(from.reduced());
        found.cost = cost(h, &found, loss);
        Some(found)
    }

    /// Fits the states alone, from given ones; none if there is no such wall. `thorough` looks for other valleys of windows
    /// that stay poor.
    pub fn states(
        &self,
        h: &Hypothesis,
        values: &[f64],
        x: &[Vec<f64>],
        steps: usize,
        thorough: bool,
    ) -> Option<Fit> {
        let replay = Replay::new(self.tests, &h.physics(values)?);
        let these = self.windows.iter().zip(x.iter().map(|x| &x[..])).collect::<Vec<_>>();
        let windows = in_chunks(&these, |these| fit_windows(&replay, owned(these), steps));
        let mut found = Fit { values: values.to_vec(), windows, cost: 0.0, covariance: None };
        if thorough {
            self.search(&replay, &mut found, steps);
        }
        found.cost = cost(h, &found, Loss::NEAR);
        Some(found)
    }

    /// Looks for other states of the windows that are followed badly: those measured, for what was fitted under a model far
    /// from the truth need not be near it; and others, unless the model misses most windows: then it is not in the wrong valley
    /// of each.
    fn search(&self, replay: &Replay, found: &mut Fit, steps: usize) {
        self.retried(found, |poor| {
            let measured = poor.iter().map(|(window, _)| (*window, window.measured.clone()));
            fit_windows(replay, measured.collect(), steps)
        });
        if !found.misses_many() {
            self.retried(found, |poor| other_valleys(replay, poor, steps));
        }
    }

    /// Takes what is found for windows that are followed badly, where it is better.
    fn retried(
        &self,
        found: &mut Fit,
        find: impl Fn(&[(&Window, &WindowFit)]) -> Vec<WindowFit> + Send + Sync,
    ) {
        let poor = (0..self.windows.len()).filter(|k| found.windows[*k].is_poor()).collect::<Vec<_>>();
        let these = poor.iter().map(|k| (&self.windows[*k], &found.windows[*k])).collect::<Vec<_>>();
        let others = in_chunks(&these, find);
        for (k, other) in poor.into_iter().zip(others) {
            if other.squares < found.windows[k].squares {
                found.windows[k] = other;
            }
        }
    }

    /// Fits numbers and states from given ones, coarsely: under the widest loss, states from where they are.
    ///
    /// Enough to tell what is far from the truth.
    pub fn fit_coarsely(&self, h: &Hypothesis, start: Fit) -> Option<Fit> {
        let widest = Loss::widest(start.reduced());
        let fit = self.descend(h, start, widest, COARSE);
        let mut fit = self.again(h, fit, false)?;
        fit.cost = cost(h, &fit, Loss::Likelihood);
        Some(fit)
    }

    /// Fits numbers and states to the end, from a coarse fit.
    pub fn fit_finely(&self, h: &Hypothesis, coarse: Fit) -> Option<Fit> {
        let mut fit = coarse;
        for loss in Loss::NARROWING {
            fit = self.descend(h, fit, loss, FINE);
            // Other valleys are looked for once the numbers are about right.
            fit = self.again(h, fit, loss != Loss::MIDDLE)?;
        }
        fit.cost = cost(h, &fit, Loss::Likelihood);
        Some(fit)
    }

    /// The states fitted once more.
    fn again(&self, h: &Hypothesis, fit: Fit, thorough: bool) -> Option<Fit> {
        let x = fit.windows.iter().map(|w| w.x.clone()).collect::<Vec<_>>();
        let again = self.states(h, &fit.values, &x, 2, thorough)?;
        Some(Fit { covariance: fit.covariance, ..again })
    }

    fn descend(&self, h: &Hypothesis, mut fit: Fit, loss: Loss, patience: Patience) -> Fit {
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

fn cost(h: &Hypothesis, fit: &Fit, loss: Loss) -> f64 {
    let windows = fit.windows.iter().map(|w| loss.of(w)).sum::<f64>();
    windows + h.prior_penalty(&fit.values)
}

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

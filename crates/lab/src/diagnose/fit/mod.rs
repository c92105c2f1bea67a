//! Fits a hypothesis to windows: its numbers, and the state at the start of every window, together.
//!
//! Multiple shooting: the states are eliminated window by window, by an orthogonal projection of residuals and
//! sensitivities. That leaves normal equations in the few numbers of the hypothesis. After each step the states follow.
//!
//! | module | idea |
//! | --- | --- |
//! | [`Problem`] | a hypothesis fitted to windows: coarsely, to the end, or by the states alone |
//! | `descent` | steps of the numbers |
//! | `linear` | how every window changes with them and with the state at its start |
//! | `linearised` | the same of all windows, and what of it is still known after a step |
//! | `window_fit` | the state at the start of a window |
//! | `replay` | a window simulated from a state |
//! | [`Budget`] | how much a fit may work |
//! | `loss` | what a window costs, and how well windows are followed |

mod budget;
mod descent;
mod joint_motion;
mod linear;
mod linearised;
mod loss;
mod replay;
mod top_past;
mod window_fit;

use super::hypothesis::{Hypothesis, Physics};
use crate::experiment::{TestData, Window};
use crate::limits::{LOOKED_ABOUT_SD, MOST_MISSED};
pub use budget::Budget;
use descent::{COARSE, FINE, FIRST, LAST, cost};
pub use linear::WindowSlopes;
use linearised::Linearised;
pub use loss::{Loss, more_poor_held_out_sd, nats, poor_share, windowed_error};
use nalgebra::DMatrix;
pub use replay::{Replay, shaken};
pub use top_past::{TopPast, largest_so_far_m, top_path};
use window_fit::{
    At, InState, LITTLE, fit_windows_by, in_chunks, other_valleys, owned, state_jacobians, step_of,
    take_steps,
};
pub use window_fit::{WindowFit, fit_windows};

/// Steps of the states of windows after the numbers.
const STEPS_AGAIN: usize = 2;
/// The same from states that another hypothesis left.
const STEPS_OF_COARSE: usize = 3;

/// A fitted hypothesis.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Its numbers, in the order of [`Hypothesis::unknowns`].
    pub values: Vec<f64>,
    /// Every window.
    pub windows: Vec<WindowFit>,
    /// Loss and prior together.
    pub cost: f64,
    /// Covariance of the numbers from the curvature; `None` where they leave no trace.
    pub covariance: Option<DMatrix<f64>>,
}

impl Fit {
    /// Takes the windows of another fit of about the same values, where they are followed better.
    pub fn take_better(&mut self, other: Self) {
        for (mine, new) in self.windows.iter_mut().zip(other.windows) {
            if new.squares < mine.squares {
                *mine = new;
            }
        }
    }

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
        poor_share(&self.windows) > MOST_MISSED
    }
}

/// Takes what was found for some windows of a fit, where it is better.
fn take_better(own: &mut Fit, asked: Vec<usize>, found: Vec<WindowFit>) {
    for (k, other) in asked.into_iter().zip(found) {
        if other.squares < own.windows[k].squares {
            own.windows[k] = other;
        }
    }
}

/// Windows of some tests.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// All tests of the experiment.
    pub tests: &'a [TestData],
    /// The windows that count.
    pub windows: &'a [Window],
    /// What a fit to them may work; `None`: as much as it takes.
    pub budget: Option<&'a Budget>,
}

impl<'a> Problem<'a> {
    /// The tests under a hypothesis, its work counted.
    pub(super) fn replay(&self, physics: &Physics) -> Replay<'a> {
        Replay::new(self.tests, physics).counted(self.budget)
    }

    /// Whether a fit has worked as much as it may.
    pub(super) fn is_spent(&self) -> bool {
        self.budget.is_some_and(Budget::is_spent)
    }
}

impl Problem<'_> {
    /// The states as measured.
    pub fn measured_states(&self) -> Vec<Vec<f64>> {
        self.windows.iter().map(|w| w.measured.clone()).collect()
    }

    /// How the residuals of each window change with its state, for the values and states of a fit; `None` if there is no
    /// such wall.
    pub fn chords(&self, h: &Hypothesis, fit: &Fit) -> Option<Vec<DMatrix<f64>>> {
        let replay = self.replay(&h.physics(&fit.values)?);
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

    /// The states of a fit moved by one step with the Jacobians of another hypothesis nearby, where that helps. It is
    /// a cheap look at what values would do. `None` if there is no such wall.
    pub fn glance(&self, h: &Hypothesis, values: &[f64], from: &Fit, chords: &[DMatrix<f64>]) -> Option<Fit> {
        let replay = self.replay(&h.physics(values)?);
        let look = |these: &[(InState, &DMatrix<f64>)]| {
            let (states, chords): (Vec<_>, Vec<_>) = these.iter().copied().unzip();
            let mut all = At::all(&replay, owned(&states));
            let step =
                |(at, chord): (&At, &&DMatrix<f64>)| step_of(chord, &at.r).filter(|_| chord.ncols() > 0);
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

    /// Fits the states alone, from given ones; `None` if there is no such wall. `thorough` looks for other valleys of windows
    /// that stay poor.
    pub fn states(
        &self,
        h: &Hypothesis,
        values: &[f64],
        x: &[Vec<f64>],
        steps: usize,
        thorough: bool,
    ) -> Option<Fit> {
        let replay = self.replay(&h.physics(values)?);
        let these = self.windows.iter().zip(x.iter().map(|x| &x[..])).collect::<Vec<_>>();
        let windows = in_chunks(&these, |these| fit_windows(&replay, owned(these), steps));
        let mut found = Fit { values: values.to_vec(), windows, cost: 0.0, covariance: None };
        if thorough {
            self.search(&replay, &mut found, steps);
        }
        found.cost = cost(h, &found, Loss::NEAR);
        Some(found)
    }

    /// The states from which a fit begins. `None` also where a first look at them says that it would work more than it may.
    pub fn states_to_begin(
        &self,
        h: &Hypothesis,
        values: &[f64],
        x: &[Vec<f64>],
        steps: usize,
    ) -> Option<Fit> {
        if let Some(budget) = self.budget {
            self.states(h, values, x, 0, false)?;
            budget.look_ahead(h.unknowns.len());
        }
        if self.is_spent() { None } else { self.states(h, values, x, steps, false) }
    }

    /// The states of all windows with the numbers of a coarse fit to some, from those of another hypothesis.
    pub fn states_of_coarse(&self, h: &Hypothesis, values: &[f64], x: &[Vec<f64>]) -> Option<Fit> {
        let mut found = self.states(h, values, x, STEPS_OF_COARSE, false)?;
        found.cost = cost(h, &found, Loss::Likelihood);
        Some(found)
    }

    /// Looks for other states of the windows that are followed badly. Measured states are tried, for a fit under a
    /// model far from the truth need not be near them. Others are tried unless the model misses most windows: it
    /// cannot be in the wrong minimum of each.
    fn search(&self, replay: &Replay, found: &mut Fit, steps: usize) {
        if self.is_spent() {
            return;
        }
        self.retried(found, WindowFit::is_poor, |poor| {
            let measured = poor.iter().map(|(window, _)| (*window, window.measured.clone()));
            fit_windows(replay, measured.collect(), steps)
        });
        if !found.misses_many() {
            self.retried(found, WindowFit::is_poor, |poor| other_valleys(replay, poor, steps));
        }
    }

    /// A fit with other valleys looked for in all windows but those that are followed as well as noise lets most be. `None` where the model
    /// misses most of them, and not their states.
    pub fn looked_about(&self, h: &Hypothesis, fit: &Fit) -> Option<Fit> {
        if fit.misses_many() {
            return None;
        }
        let replay = self.replay(&h.physics(&fit.values)?);
        let mut found = fit.clone();
        let exceeds = |fit: &WindowFit| fit.exceeds_noise_by(LOOKED_ABOUT_SD);
        self.retried(&mut found, exceeds, |these| other_valleys(&replay, these, STEPS_AGAIN));
        found.cost = cost(h, &found, Loss::Likelihood);
        Some(found)
    }

    /// Windows of a fit from the states of another one, where that is better. Asked are those that are followed badly, and
    /// those that the other follows better.
    pub fn borrow_states(&self, h: &Hypothesis, own: &mut Fit, from: &Fit) {
        let Some(physics) = h.physics(&own.values) else { return };
        let replay = self.replay(&physics);
        let may_help = |k: &usize| {
            let [mine, other] = [&own.windows[*k], &from.windows[*k]];
            mine.is_poor() || other.squares + LITTLE < mine.squares
        };
        let asked = (0..self.windows.len()).filter(may_help).collect::<Vec<_>>();
        let all = self.states_of(from);
        let these = asked.iter().map(|k| all[*k]).collect::<Vec<_>>();
        let found = in_chunks(&these, |these| fit_windows(&replay, owned(these), STEPS_AGAIN));
        take_better(own, asked, found);
    }

    /// Takes what is found for those of the windows that are asked for, where it is better.
    fn retried(
        &self,
        found: &mut Fit,
        asked: impl Fn(&WindowFit) -> bool,
        find: impl Fn(&[(&Window, &WindowFit)]) -> Vec<WindowFit> + Send + Sync,
    ) {
        let poor = (0..self.windows.len()).filter(|k| asked(&found.windows[*k])).collect::<Vec<_>>();
        let these = poor.iter().map(|k| (&self.windows[*k], &found.windows[*k])).collect::<Vec<_>>();
        let others = in_chunks(&these, find);
        take_better(found, poor, others);
    }

    /// Fits numbers and states from given ones, coarsely: under the widest loss, states from where they are.
    ///
    /// Enough to tell what is far from the truth.
    pub fn fit_coarsely(&self, h: &Hypothesis, start: Fit) -> Option<Fit> {
        let widest = Loss::widest(start.reduced());
        let mut known = None;
        let fit = self.descend(h, start, widest, COARSE, &mut known);
        let mut fit = self.again(h, fit, known.as_ref(), false)?;
        fit.cost = cost(h, &fit, Loss::Likelihood);
        Some(fit)
    }

    /// Fits numbers and states to the end, from a coarse fit. `None` where it has worked as much as it may, for then it is none of the
    /// answers: what would be left to do might take many times as long.
    pub fn fit_finely(&self, h: &Hypothesis, coarse: Fit) -> Option<Fit> {
        let mut fit = coarse;
        let mut known = None;
        for loss in Loss::NARROWING {
            let patience = if loss == Loss::Likelihood { LAST } else { FINE };
            fit = self.descend(h, fit, loss, patience, &mut known);
            if self.is_spent() {
                return None;
            }
            // Other valleys are looked for once the numbers are about right.
            fit = self.again(h, fit, known.as_ref(), loss != Loss::MIDDLE)?;
        }
        fit.cost = cost(h, &fit, Loss::Likelihood);
        Some(fit)
    }

    /// The first steps of such a fit: enough to tell which of several starts come to one place.
    pub fn step_first(&self, h: &Hypothesis, start: Fit) -> Fit {
        let mut fit = self.descend(h, start, Loss::MIDDLE, FIRST, &mut None);
        fit.cost = cost(h, &fit, Loss::Likelihood);
        fit
    }

    /// The states fitted once more, where what is known of the windows promises something.
    fn again(&self, h: &Hypothesis, fit: Fit, known: Option<&Linearised>, thorough: bool) -> Option<Fit> {
        let replay = self.replay(&h.physics(&fit.values)?);
        let states = self.states_of(&fit);
        let windows = match known {
            Some(known) => {
                let these = states.into_iter().zip(known.windows.iter().map(|linear| &linear.jx));
                in_chunks(&these.collect::<Vec<_>>(), |these| fit_windows_by(&replay, these, STEPS_AGAIN))
            }
            None => in_chunks(&states, |these| fit_windows(&replay, owned(these), STEPS_AGAIN)),
        };
        let mut again = Fit { windows, ..fit };
        if thorough {
            self.search(&replay, &mut again, STEPS_AGAIN);
        }
        again.cost = cost(h, &again, Loss::NEAR);
        Some(again)
    }
}

#[cfg(test)]
mod tests {
    use super::linear::tests::swaying;
    use super::*;
    use crate::experiment::Sampled;

    #[test]
    fn analytic_windows_that_are_not_missed_are_looked_about_in_too() {
        let (mut tests, h) = swaying();
        let windows = crate::experiment::windows(&tests)[..1].to_vec();
        let window = &windows[0];
        // As it would be measured without noise.
        let mut sampled = Sampled::at_all(&tests[0].time_s[window.samples.clone()]);
        let physics = h.physics(&h.start()).expect("a wall");
        Replay::new(&tests, &physics).run(window, &window.measured, &mut sampled);
        for (theta, (simulated, _)) in
            tests[0].theta_rad[window.samples.clone()].iter_mut().zip(sampled.rows())
        {
            *theta = *simulated;
        }
        let problem = Problem { tests: &tests, windows: &windows, budget: None };
        let off = |share: f64| {
            let mut x = window.measured.clone();
            x[0] += share * window.spread[0];
            problem.states(&h, &h.start(), &[x], 0, false).expect("a wall")
        };
        let exceeding = |sd: f64| {
            let fits = (1..2000).map(|k| off(0.005 * f64::from(k)));
            fits.into_iter().find(|fit| fit.windows[0].exceeds_noise_by(sd)).expect("a state far enough off")
        };
        let [little, more] = [LOOKED_ABOUT_SD - 1.0, LOOKED_ABOUT_SD + 1.0].map(exceeding);
        assert!(!more.windows[0].is_poor() && !little.windows[0].exceeds_noise_by(LOOKED_ABOUT_SD));
        let squares = |fit: &Fit| problem.looked_about(&h, fit).expect("a wall").windows[0].squares;
        assert_eq!(squares(&little), little.windows[0].squares);
        // Steps that promise less than this are not taken.
        assert!(squares(&more) < window_fit::LITTLE, "{}", squares(&more));
    }
}

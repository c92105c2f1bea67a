//! The state at the start of a window that lets the simulation follow the measurement best.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::replay::{Followed, Replay};
use crate::experiment::Window;
pub(super) use crate::least_squares::{NewtonStep, step_of};
use crate::limits::MISSED_SD;

/// Steps of Gauss and Newton tried at shrinking lengths before giving up.
const SHORTER: [f64; 4] = [1.0, 0.4, 0.16, 0.06];
/// Gain in the sum of squares, in squared noise, that is not worth another step.
pub(super) const LITTLE: f64 = 0.5;
/// Gain that a step must promise, for a window to be simulated for it. All windows of a fit, some 300, together hold less
/// than a logarithm of likelihood then.
const LEAST_PROMISE: f64 = 0.005;
/// Share of the spread of a smoothed state over which sensitivities to it are taken.
const CHANGE_SHARE: f64 = 0.1;
/// Farthest that a step goes, in spreads of a smoothed state: eighty times as far as other starts are drawn.
const FARTHEST: f64 = 1e3;
/// Other starts drawn about the smoothed state, and how many of the best are refined.
///
/// Half of them lie farther off in velocity: where a joint shuts and opens again within the samples that are smoothed, the smoothed
/// velocity is several spreads off.
const DRAWS: usize = 64;
/// Spreads within which values, and velocities, are drawn: of the first half and of the second.
const DRAWN_WITHIN: [[f64; 2]; 2] = [[3.0, 3.0], [3.0, 12.0]];
const REFINED: usize = 3;

/// Fewest windows that are worth a thread: what goes side by side ends one by one.
const LEAST_CHUNK: usize = 24;

/// A window, and a state to start it from.
pub(super) type InState<'a> = (&'a Window, &'a [f64]);

/// Windows with states of their own.
pub(super) fn owned<'w>(these: &[InState<'w>]) -> Vec<(&'w Window, Vec<f64>)> {
    these.iter().map(|(window, x)| (*window, x.to_vec())).collect()
}

/// A window with its state fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowFit {
    /// (θ, θ') of the free bodies at the start, rad and rad/s.
    pub x: Vec<f64>,
    /// Sum of the squared residuals over the noise.
    pub squares: f64,
    /// Measured numbers less fitted ones.
    pub freedom: f64,
}

impl WindowFit {
    /// Squared error over squared noise: 1 for a perfect model.
    pub fn reduced(&self) -> f64 {
        self.squares / self.freedom
    }

    /// What is left beside a model's own error, so many times the noise, in the noise's place.
    pub fn relieved(&self, error: f64) -> Self {
        Self { squares: self.squares / (error * error), ..self.clone() }
    }

    /// Whether noise alone does not leave so much: the squared error of noise has twice its freedom as variance.
    pub fn is_poor(&self) -> bool {
        self.exceeds_noise_by(MISSED_SD)
    }

    /// Whether it leaves more than noise by so many standard deviations.
    pub fn exceeds_noise_by(&self, sd: f64) -> bool {
        self.reduced() > 1.0 + sd * (2.0 / self.freedom).sqrt()
    }
}

/// Works on windows side by side, in as many chunks as there are threads.
pub(super) fn in_chunks<T: Sync, R: Send>(of: &[T], work: impl Fn(&[T]) -> Vec<R> + Send + Sync) -> Vec<R> {
    let size = of.len().div_ceil(rayon::current_num_threads()).max(LEAST_CHUNK);
    of.par_chunks(size).flat_map_iter(work).collect()
}

/// A window and a state at its start, with the residuals it leaves.
#[derive(Debug)]
pub(super) struct At<'w> {
    pub window: &'w Window,
    pub x: Vec<f64>,
    pub r: DVector<f64>,
    /// Which changes of Table 2 occur.
    pub changes: [bool; 8],
}

impl<'w> At<'w> {
    /// Windows in states.
    pub fn all(replay: &Replay, asked: Vec<(&'w Window, Vec<f64>)>) -> Vec<Self> {
        let found = replay.followed(&asked.iter().map(|(window, x)| (*window, &x[..])).collect::<Vec<_>>());
        let all = asked.into_iter().zip(found);
        all.map(|((window, x), Followed { r, changes })| Self { window, x, r, changes }).collect()
    }

    /// The same windows in other states.
    pub fn moved(replay: &Replay, these: &[&Self], steps: &[DVector<f64>], share: f64) -> Vec<Self> {
        let plus = |(at, step): (&&Self, &DVector<f64>)| {
            let y = at.x.iter().zip(step.iter()).map(|(x, dx)| x + share * dx);
            (at.window, y.collect())
        };
        Self::all(replay, these.iter().zip(steps).map(plus).collect())
    }

    /// The fitted window it is.
    pub fn fit(self) -> WindowFit {
        let freedom = (self.window.readings - self.x.len()) as f64;
        WindowFit { squares: self.r.norm_squared(), freedom, x: self.x }
    }
}

/// Sensitivities of the residuals of windows to their states, over a share of the spread of the smoothed state. That
/// is so far inside the noise that one-sided differences serve.
pub(super) fn state_jacobians(replay: &Replay, these: &[&At]) -> Vec<DMatrix<f64>> {
    let changed = |at: &&At| {
        let one = |(i, h): (usize, &f64)| {
            let mut y = at.x.clone();
            y[i] += CHANGE_SHARE * h;
            y
        };
        at.window.spread.iter().enumerate().map(one).collect::<Vec<_>>()
    };
    let changed = these.iter().map(changed).collect::<Vec<_>>();
    let asked = these.iter().zip(&changed).flat_map(|(at, all)| all.iter().map(|y| (at.window, &y[..])));
    let mut found = replay.followed(&asked.collect::<Vec<_>>()).into_iter();
    let jacobian = |at: &&At| {
        let mut jacobian = DMatrix::zeros(at.r.len(), at.x.len());
        for ((i, h), near) in at.window.spread.iter().enumerate().zip(&mut found) {
            jacobian.set_column(i, &((near.r - &at.r) / (CHANGE_SHARE * h)));
        }
        jacobian
    };
    these.iter().map(jacobian).collect()
}

/// Whether a step leads to a state that a measurement could be of. One along a number of the state that leaves no trace, such as the
/// velocity of a joint that shuts at once, may go to 1e11 rad; from there simulations on beds hardly end.
fn is_near(at: &At, step: &NewtonStep) -> bool {
    step.x.iter().zip(&at.window.spread).all(|(dx, spread)| dx.abs() < FARTHEST * spread)
}

/// Takes a step in each window that has one that promises something and is followed better after it.
pub(super) fn take_steps(replay: &Replay, all: &mut [At], steps: Vec<Option<NewtonStep>>) {
    let of = |(i, step): (usize, Option<NewtonStep>)| {
        step.filter(|step| step.promise > LEAST_PROMISE && is_near(&all[i], step)).map(|step| (i, step.x))
    };
    let (stepping, steps): (Vec<_>, Vec<_>) = steps.into_iter().enumerate().filter_map(of).unzip();
    let these = stepping.iter().map(|i| &all[*i]).collect::<Vec<_>>();
    let moved = At::moved(replay, &these, &steps, 1.0);
    for (i, moved) in stepping.into_iter().zip(moved) {
        if moved.r.norm_squared() < all[i].r.norm_squared() {
            all[i] = moved;
        }
    }
}

/// Fits of windows, or better ones from other starts.
pub(super) fn other_valleys(replay: &Replay, fits: &[(&Window, &WindowFit)], steps: usize) -> Vec<WindowFit> {
    let starts = other_starts(replay, &fits.iter().map(|(window, _)| *window).collect::<Vec<_>>());
    let asked =
        fits.iter().zip(&starts).flat_map(|((window, _), all)| all.iter().map(|y| (*window, y.clone())));
    let mut found = fit_windows(replay, asked.collect(), steps).into_iter();
    let best = |((_, fit), starts): (&(&Window, &WindowFit), &Vec<Vec<f64>>)| {
        let better =
            |best: WindowFit, other: WindowFit| if other.squares < best.squares { other } else { best };
        found.by_ref().take(starts.len()).fold((*fit).clone(), better)
    };
    fits.iter().zip(&starts).map(best).collect()
}

/// Fits the states of windows, from given ones, each by at most `steps` steps of Gauss and Newton.
pub fn fit_windows(replay: &Replay, from: Vec<(&Window, Vec<f64>)>, steps: usize) -> Vec<WindowFit> {
    fit_those(replay, At::all(replay, from), steps, |_| true)
}

/// The same of those windows whose Jacobians from nearby promise something; the others stay where they are.
pub(super) fn fit_windows_by(
    replay: &Replay,
    from: &[(InState, &DMatrix<f64>)],
    steps: usize,
) -> Vec<WindowFit> {
    let (states, chords): (Vec<_>, Vec<_>) = from.iter().copied().unzip();
    let all = At::all(replay, owned(&states));
    let promises = |(at, chord): (&At, &&DMatrix<f64>)| {
        !at.x.is_empty() && step_of(chord, &at.r).is_none_or(|step| step.promise > LEAST_PROMISE)
    };
    let open = all.iter().zip(&chords).map(promises).collect::<Vec<_>>();
    fit_those(replay, all, steps, |i| open[i])
}

/// Fits the states of some of the windows.
fn fit_those(
    replay: &Replay,
    mut all: Vec<At>,
    steps: usize,
    these: impl Fn(usize) -> bool,
) -> Vec<WindowFit> {
    let with_state = (0..all.len()).filter(|i| !all[*i].x.is_empty());
    let mut active = with_state.filter(|i| these(*i)).collect::<Vec<_>>();
    for _ in 0..steps {
        active = improved(replay, &mut all, &active);
    }
    all.into_iter().map(At::fit).collect()
}

/// One step of those of the windows that are `active`, and one more with the same Jacobian; gives those for which it was worth
/// another.
fn improved(replay: &Replay, all: &mut [At], active: &[usize]) -> Vec<usize> {
    let these = active.iter().map(|i| &all[*i]).collect::<Vec<_>>();
    let jacobians = state_jacobians(replay, &these);
    let step = |(i, chord): (&usize, DMatrix<f64>)| Some((*i, step_of(&chord, &all[*i].r)?, chord));
    let promising = |(i, step, _): &(usize, NewtonStep, DMatrix<f64>)| {
        step.promise > LEAST_PROMISE && is_near(&all[*i], step)
    };
    let mut waiting = active.iter().zip(jacobians).filter_map(step).filter(promising).collect::<Vec<_>>();
    let mut gained = Vec::new();
    for share in SHORTER {
        // Where the whole step does not help, a shorter one must be worth its simulation.
        waiting.retain(|(_, step, _)| share == 1.0 || step.promise_of(share) > LITTLE);
        let (these, steps): (Vec<_>, Vec<_>) =
            waiting.iter().map(|(i, step, _)| (&all[*i], step.x.clone())).unzip();
        let trials = At::moved(replay, &these, &steps, share);
        let mut left = Vec::new();
        for ((i, step, chord), trial) in waiting.into_iter().zip(trials) {
            let [before, after] = [all[i].r.norm_squared(), trial.r.norm_squared()];
            if after < before {
                all[i] = trial;
                gained.extend((before - after >= LITTLE).then_some((i, chord)));
            } else {
                left.push((i, step, chord));
            }
        }
        waiting = left;
    }
    worth_another(replay, all, gained)
}

/// Takes one more step with given Jacobians in windows that gained by them; gives those that promise more even after it.
fn worth_another(replay: &Replay, all: &mut [At], gained: Vec<(usize, DMatrix<f64>)>) -> Vec<usize> {
    let promising = |all: &[At], i: usize, chord: &DMatrix<f64>| {
        step_of(chord, &all[i].r).filter(|step| step.promise > LEAST_PROMISE)
    };
    let mut steps = all.iter().map(|_| None).collect::<Vec<_>>();
    for (i, chord) in &gained {
        steps[*i] = promising(all, *i, chord);
    }
    take_steps(replay, all, steps);
    let still = gained.into_iter().filter(|(i, chord)| promising(all, *i, chord).is_some());
    still.map(|(i, _)| i).collect()
}

/// The best of some states of each window drawn about the smoothed one; the same on every call.
fn other_starts(replay: &Replay, windows: &[&Window]) -> Vec<Vec<Vec<f64>>> {
    let drawn = windows.iter().flat_map(|window| drawn_states(window).map(|y| (*window, y))).collect();
    let mut drawn = At::all(replay, drawn).into_iter().map(|at| (at.r.norm_squared(), at.x));
    let best = |with_state: bool| {
        if !with_state {
            return Vec::new();
        }
        let mut own = drawn.by_ref().take(DRAWS).collect::<Vec<_>>();
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        own.into_iter().take(REFINED).map(|(_, y)| y).collect()
    };
    windows.iter().map(|window| !window.measured.is_empty()).map(best).collect()
}

/// States drawn about the smoothed one; none of a window that has no state.
fn drawn_states(window: &Window) -> impl Iterator<Item = Vec<f64>> {
    let seed = (window.test as u64) << 32 | window.samples.start as u64;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let count = if window.measured.is_empty() { 0 } else { DRAWS };
    (0..count).map(move |draw| {
        let within = DRAWN_WITHIN[2 * draw / DRAWS];
        let about = |((m, s), share): ((&f64, &f64), &f64)| m + share * s * random.random_range(-1.0..1.0);
        window.measured.iter().zip(&window.spread).zip(within.iter().cycle()).map(about).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Freedom;
    use crate::experiment_file::Purpose;

    #[test]
    fn rejects_a_step_along_a_number_that_leaves_no_trace() {
        let window = Window {
            test: 0,
            purpose: Purpose::Fit,
            samples: 0..120,
            readings: 240,
            freedom: Freedom::Upper,
            opened: false,
            measured: vec![0.01, 0.0],
            spread: vec![1.5e-4, 1.5e-3],
        };
        let at =
            At { window: &window, x: window.measured.clone(), r: DVector::zeros(240), changes: [false; 8] };
        let step = |x: [f64; 2]| NewtonStep { x: DVector::from_row_slice(&x), promise: 1.0 };
        assert!(is_near(&at, &step([2e-3, -0.04])));
        // Each number by its own spread, and what is no number goes nowhere.
        assert!(!is_near(&at, &step([0.0, 1e11])) && !is_near(&at, &step([0.2, 0.0])));
        assert!(!is_near(&at, &step([f64::NAN, 0.0])));
    }

    #[test]
    fn analytic_the_second_half_of_other_starts_lies_farther_off_in_velocity() {
        let window = Window {
            test: 0,
            purpose: Purpose::Fit,
            samples: 0..120,
            readings: 240,
            freedom: Freedom::Both,
            opened: false,
            measured: vec![0.0; 4],
            spread: vec![1.0; 4],
        };
        let drawn = drawn_states(&window).collect::<Vec<_>>();
        assert_eq!(drawn.len(), DRAWS);
        let farthest = |half: &[Vec<f64>], number: usize| {
            half.iter().flat_map(|x| [x[number], x[number + 2]]).fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        let [near, far] = [&drawn[..DRAWS / 2], &drawn[DRAWS / 2..]];
        // Of 64 numbers drawn evenly within a reach the farthest lies beyond nine tenths of it.
        for (half, [value, rate]) in [near, far].into_iter().zip(DRAWN_WITHIN) {
            assert!((0.9 * value..value).contains(&farthest(half, 0)));
            assert!((0.9 * rate..rate).contains(&farthest(half, 1)));
        }
    }
}

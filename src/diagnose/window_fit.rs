//! The state at the start of a window that lets the simulation follow the measurement best.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::replay::Replay;
use super::windows::Window;

/// Steps of Gauss and Newton tried at shrinking lengths before giving up.
const SHORTER: [f64; 4] = [1.0, 0.4, 0.16, 0.06];
/// Gain in the sum of squares, in squared noise, that is not worth another step.
const LITTLE: f64 = 0.5;
/// Standard deviations of what noise leaves by which a window is followed badly: other starts are tried, for an impact just
/// missed or just met has valleys of its own.
const POOR_SD: f64 = 5.0;
/// Share of the spread of a smoothed state over which sensitivities to it are taken.
const CHANGE_SHARE: f64 = 0.1;
/// Other starts drawn about the smoothed state, and how many of the best are refined.
const DRAWS: usize = 32;
const REFINED: usize = 3;

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

    /// Whether noise alone does not leave so much: the squared error of noise has twice its freedom as variance.
    pub fn is_poor(&self) -> bool {
        self.reduced() > 1.0 + POOR_SD * (2.0 / self.freedom).sqrt()
    }
}

/// Sensitivity of the residuals r at x to the state, over a share of the spread of the smoothed state: so far inside the noise
/// that one-sided differences do.
pub fn state_jacobian(replay: &Replay, window: &Window, x: &[f64], r: &DVector<f64>) -> DMatrix<f64> {
    let mut jacobian = DMatrix::zeros(r.len(), x.len());
    for (i, h) in window.spread.iter().enumerate() {
        let mut y = x.to_vec();
        let h = CHANGE_SHARE * h;
        y[i] += h;
        jacobian.set_column(i, &((replay.residual(window, &y) - r) / h));
    }
    jacobian
}

/// A fit, or a better one from other starts.
pub fn other_valleys(replay: &Replay, window: &Window, fit: &WindowFit, steps: usize) -> WindowFit {
    let mut best = fit.clone();
    if fit.x.is_empty() {
        return best;
    }
    for y in other_starts(replay, window) {
        let other = fit_window(replay, window, &y, steps);
        if other.squares < best.squares {
            best = other;
        }
    }
    best
}

/// Fits the state of a window, from a given one, by at most `steps` steps of Gauss and Newton.
pub fn fit_window(replay: &Replay, window: &Window, x: &[f64], steps: usize) -> WindowFit {
    let mut x = x.to_vec();
    let mut r = replay.residual(window, &x);
    for _ in 0..steps {
        if x.is_empty() {
            break;
        }
        let Some(step) = newton_step(&state_jacobian(replay, window, &x, &r), &r) else { break };
        let before = r.norm_squared();
        for share in SHORTER {
            let y = x.iter().zip(step.iter()).map(|(x, dx)| x + share * dx).collect::<Vec<_>>();
            let trial = replay.residual(window, &y);
            if trial.norm_squared() < before {
                (x, r) = (y, trial);
                break;
            }
        }
        if before - r.norm_squared() < LITTLE {
            break;
        }
    }
    let freedom = (r.len() - x.len()) as f64;
    WindowFit { squares: r.norm_squared(), freedom, x }
}

/// -R⁻¹ Qᵀ r, the least squares step.
pub fn newton_step(jacobian: &DMatrix<f64>, r: &DVector<f64>) -> Option<DVector<f64>> {
    let qr = jacobian.clone().qr();
    qr.r().solve_upper_triangular(&-(qr.q().transpose() * r)).filter(|dx| dx.iter().all(|x| x.is_finite()))
}

/// The best of some states drawn about the smoothed one; the same on every call.
fn other_starts(replay: &Replay, window: &Window) -> Vec<Vec<f64>> {
    let seed = (window.test as u64) << 32 | window.samples.start as u64;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = || {
        let about = |(m, s): (&f64, &f64)| m + 3.0 * s * random.random_range(-1.0..1.0);
        window.measured.iter().zip(&window.spread).map(about).collect::<Vec<_>>()
    };
    let mut drawn = (0..DRAWS)
        .map(|_| draw())
        .map(|y| (replay.residual(window, &y).norm_squared(), y))
        .collect::<Vec<_>>();
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    drawn.into_iter().take(REFINED).map(|(_, y)| y).collect()
}

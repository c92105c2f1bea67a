//! Which pattern a measured wall is in where that is beyond doubt, and its state there: cubics through the samples around.

use super::test_data::TestData;
use crate::limits::{BEYOND_NOISE, OPEN_CLEAR, UNEVEN};
use mrbd_kernel::model::{Contact, Pair, Pivot, State};

/// Samples to either side of the middle.
pub const HALF: usize = 8;
/// Samples that are looked at together.
const COUNT: usize = 2 * HALF + 1;
/// Free numbers of a cubic.
const CUBIC: f64 = 4.0;
/// Samples averaged where the sign of an opening is read.
const AVERAGED: usize = 5;

/// What is free in a contact state that the measurement leaves no doubt about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// Nothing: the wall stands.
    Rest,
    /// θ_1 = θ_2 (pattern 3).
    Monolithic,
    /// θ_2 (pattern 4).
    Upper,
    /// Both (patterns 1 and 2).
    Both,
}

impl Freedom {
    /// Rotations and velocities of the free bodies that make a state: (θ, θ') of each.
    pub fn numbers(self) -> usize {
        match self {
            Freedom::Rest => 0,
            Freedom::Monolithic | Freedom::Upper => 2,
            Freedom::Both => 4,
        }
    }

    /// What a contact state leaves free.
    pub fn of(contact: Contact) -> Self {
        match (contact.ground.is_open(), contact.crack.is_open()) {
            (false, false) => Freedom::Rest,
            (true, false) => Freedom::Monolithic,
            (false, true) => Freedom::Upper,
            (true, true) => Freedom::Both,
        }
    }

    /// The numbers of a state near these rotations, rad, and velocities, rad/s, of both bodies.
    pub fn numbers_of(self, theta: Pair, omega: Pair) -> Vec<f64> {
        match self {
            Freedom::Rest => Vec::new(),
            Freedom::Monolithic => [theta, omega].map(|both| 0.5 * (both[0] + both[1])).to_vec(),
            Freedom::Upper => vec![theta[1], omega[1]],
            Freedom::Both => vec![theta[0], omega[0], theta[1], omega[1]],
        }
    }

    /// The state these numbers make, rad and rad/s, and its contact.
    pub fn state(self, x: &[f64]) -> (State, Contact) {
        let (theta, omega, closed) = match self {
            Freedom::Rest => ([0.0; 2], [0.0; 2], [true, true]),
            Freedom::Monolithic => ([x[0]; 2], [x[1]; 2], [false, true]),
            Freedom::Upper => ([0.0, x[0]], [0.0, x[1]], [true, false]),
            Freedom::Both => ([x[0], x[2]], [x[1], x[3]], [false, false]),
        };
        let pivot = |closed: bool, angle: f64| if closed { Pivot::Closed } else { Pivot::of_angle(angle) };
        let ground = pivot(closed[0], theta[0]);
        let crack = pivot(closed[1], theta[1] - theta[0]);
        (State { theta, omega }, Contact { ground, crack })
    }
}

/// A measured state: what is free, and the smoothed numbers of what is.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredState {
    /// What is free.
    pub freedom: Freedom,
    /// (θ, θ') of the free bodies, rad and rad/s.
    pub numbers: Vec<f64>,
}

/// The pattern about a sample; `None` where the samples around it leave doubt or are not all there.
pub fn measured_state(test: &TestData, k: usize) -> Option<MeasuredState> {
    if !stands_among_even(test, k) {
        return None;
    }
    let around: [Pair; COUNT] = std::array::from_fn(|i| test.from_rest_rad(k - HALF + i));
    if around.iter().flatten().any(|theta| theta.is_nan()) {
        return None;
    }
    let noise = test.noise_rad;
    let lower: [f64; COUNT] = std::array::from_fn(|i| around[i][0]);
    let upper: [f64; COUNT] = std::array::from_fn(|i| around[i][1]);
    let crack: [f64; COUNT] = std::array::from_fn(|i| around[i][1] - around[i][0]);
    let crack_noise = noise[0].hypot(noise[1]);
    let ground_closed = is_zero(&lower, noise[0]);
    let crack_closed = is_zero(&crack, crack_noise);
    let (lower_fit, upper_fit) = (local(&lower), local(&upper));
    let lower_open = is_clear(&lower, noise[0]) && is_smooth(&lower_fit, noise[0]);
    let crack_open = is_clear(&crack, crack_noise) && is_smooth(&upper_fit, noise[1]);
    let freedom = match (ground_closed, crack_closed) {
        (true, true) if is_zero(&upper, noise[1]) => Freedom::Rest,
        (true, false) if crack_open => Freedom::Upper,
        (false, true) if lower_open => Freedom::Monolithic,
        (false, false) if lower_open && crack_open => Freedom::Both,
        _ => return None,
    };
    let fits = [lower_fit, upper_fit];
    let numbers = freedom.numbers_of(fits.map(|fit| fit.value), fits.map(|fit| fit.slope / test.step_s));
    Some(MeasuredState { freedom, numbers })
}

/// Whether a sample has all its neighbours, evenly spaced.
pub(super) fn stands_among_even(test: &TestData, k: usize) -> bool {
    let around = k.checked_sub(HALF).and_then(|from| test.time_s.get(from..from + COUNT));
    around.is_some_and(|time_s| is_even(time_s, test.step_s))
}

/// Whether samples are as far apart as those of the whole test: smoothing takes them for evenly spaced.
fn is_even(time_s: &[f64], step_s: f64) -> bool {
    time_s.windows(2).all(|pair| ((pair[1] - pair[0]) / step_s - 1.0).abs() < UNEVEN)
}

/// Noise about zero: neither the sum of squares nor the mean stands out.
fn is_zero(y: &[f64; COUNT], noise: f64) -> bool {
    let n = COUNT as f64;
    let squares = y.iter().map(|v| v * v).sum::<f64>() / (noise * noise);
    let mean = y.iter().sum::<f64>() / n;
    squares < n + BEYOND_NOISE * (2.0 * n).sqrt() && mean.abs() < BEYOND_NOISE * noise / n.sqrt()
}

/// No impact inside: a cubic leaves noise.
fn is_smooth(fit: &Local, noise: f64) -> bool {
    let n = COUNT as f64;
    fit.residual / (noise * noise) < n - CUBIC + BEYOND_NOISE * (2.0 * n).sqrt()
}

/// Of one sign all along, averages of a few samples clear of zero.
fn is_clear(y: &[f64; COUNT], noise: f64) -> bool {
    let sign = y[HALF].signum();
    let n = AVERAGED as f64;
    y.windows(AVERAGED).all(|some| some.iter().sum::<f64>() / n * sign > OPEN_CLEAR * noise / n.sqrt())
}

/// A channel about the middle of 2 [`HALF`] + 1 samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Value in the middle.
    pub value: f64,
    /// Slope in the middle, per sample.
    pub slope: f64,
    /// Curvature in the middle, per sample squared.
    pub curvature: f64,
    /// Sum of the squared residuals of the cubic.
    pub residual: f64,
}

/// Least squares of a cubic: even and odd parts are orthogonal on a symmetric grid (Savitzky and Golay).
pub fn local(y: &[f64; COUNT]) -> Local {
    let x = |i: usize| i as f64 - HALF as f64;
    let moment = |p: i32| (0..COUNT).map(|i| x(i).powi(p)).sum::<f64>();
    let with = |p: i32| (0..COUNT).map(|i| x(i).powi(p) * y[i]).sum::<f64>();
    let (s0, s2, s4, s6) = (COUNT as f64, moment(2), moment(4), moment(6));
    let even = s0 * s4 - s2 * s2;
    let odd = s2 * s6 - s4 * s4;
    let a0 = (s4 * with(0) - s2 * with(2)) / even;
    let a2 = (s0 * with(2) - s2 * with(0)) / even;
    let a1 = (s6 * with(1) - s4 * with(3)) / odd;
    let a3 = (s2 * with(3) - s4 * with(1)) / odd;
    let fitted = |i: usize| a0 + x(i) * (a1 + x(i) * (a2 + x(i) * a3));
    let residual = (0..COUNT).map(|i| (y[i] - fitted(i)).powi(2)).sum();
    Local { value: a0, slope: a1, curvature: 2.0 * a2, residual }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_times_that_were_rounded_are_even_and_a_finer_stretch_is_not() {
        // 256 Hz to milliseconds: off by up to an eighth of a step.
        let rounded = (0..17).map(|k| (1000.0 * f64::from(k) / 256.0).round() / 1000.0).collect::<Vec<_>>();
        assert!(is_even(&rounded, 1.0 / 256.0));
        let finer = (0..17).map(|k| 0.0025 * f64::from(k)).collect::<Vec<_>>();
        assert!(is_even(&finer, 0.0025) && !is_even(&finer, 0.005));
    }

    #[test]
    fn analytic_a_cubic_is_given_back() {
        let at = |i: usize| {
            let x = i as f64 - HALF as f64;
            0.3 - 0.2 * x + 0.05 * x * x + 0.01 * x * x * x
        };
        let found = local(&std::array::from_fn(at));
        // Roundings of sums of cubes up to 512.
        assert!((found.value - 0.3).abs() < 1e-12 && (found.slope + 0.2).abs() < 1e-12);
        assert!((found.curvature - 0.1).abs() < 1e-12 && found.residual < 1e-20);
    }
}

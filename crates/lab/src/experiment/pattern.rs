//! Which pattern a measured wall is in where that is beyond doubt, and its state there: cubics through the samples around.

use super::local::{About, LEAST, about, around};
use super::test_data::TestData;
use crate::limits::{BEYOND_NOISE, OPEN_CLEAR, UNEVEN};
use mrbd_kernel::model::{Contact, Pair, Pivot, RockingWall, State};

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
    /// θ_1, of a strip whose top is held: θ_2 follows ([`held_state`]).
    Held,
}

impl Freedom {
    /// Rotations and velocities of the free bodies that make a state: (θ, θ') of each.
    pub fn numbers(self) -> usize {
        match self {
            Freedom::Rest => 0,
            Freedom::Monolithic | Freedom::Upper | Freedom::Held => 2,
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

    /// Changes of these numbers within what the noise of even samples leaves open.
    ///
    /// A cubic through 17 samples knows its value to 0.37 and its slope to 0.125 of the noise a sample: about that for the value, a
    /// fifth of it for the slope, over which the motion is still linear.
    pub fn spread(self, test: &TestData) -> Vec<f64> {
        let largest = test.noise_rad[0].max(test.noise_rad[1]);
        let spread = [0.5 * largest, 0.025 * largest / test.step_s];
        spread.iter().copied().cycle().take(self.numbers()).collect()
    }

    /// The numbers of a state near these rotations, rad, and velocities, rad/s, of both bodies.
    pub fn numbers_of(self, theta: Pair, omega: Pair) -> Vec<f64> {
        match self {
            Freedom::Rest => Vec::new(),
            Freedom::Monolithic => [theta, omega].map(|both| 0.5 * (both[0] + both[1])).to_vec(),
            Freedom::Upper => vec![theta[1], omega[1]],
            Freedom::Held => vec![theta[0], omega[0]],
            Freedom::Both => vec![theta[0], omega[0], theta[1], omega[1]],
        }
    }

    /// The state these numbers make, rad and rad/s, and its contact. The upper body of a held strip is only
    /// given the side it leans to.
    pub fn state(self, x: &[f64]) -> (State, Contact) {
        let (theta, omega, closed) = match self {
            Freedom::Rest => ([0.0; 2], [0.0; 2], [true, true]),
            Freedom::Monolithic => ([x[0]; 2], [x[1]; 2], [false, true]),
            Freedom::Upper => ([0.0, x[0]], [0.0, x[1]], [true, false]),
            Freedom::Both => ([x[0], x[2]], [x[1], x[3]], [false, false]),
            Freedom::Held => ([x[0], -x[0]], [x[1], -x[1]], [false, false]),
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
    /// Changes of these, within what the noise leaves open.
    pub spread: Vec<f64>,
}

/// The pattern about a sample; `None` where the samples around it leave doubt or are not all there.
pub fn measured_state(test: &TestData, k: usize) -> Option<MeasuredState> {
    if test.manner.by_time || test.manner.top_held {
        return state_by_time(test, k);
    }
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
    let opens = |y: &[f64; COUNT], own: f64, fit: &Local, noise: f64| {
        is_clear(y, y[HALF], own) && is_smooth(fit.residual, COUNT, noise)
    };
    let lower_open = opens(&lower, noise[0], &lower_fit, noise[0]);
    let crack_open = opens(&crack, crack_noise, &upper_fit, noise[1]);
    let freedom = match (ground_closed, crack_closed) {
        (true, true) if is_zero(&upper, noise[1]) => Freedom::Rest,
        (true, false) if crack_open => Freedom::Upper,
        (false, true) if lower_open => Freedom::Monolithic,
        (false, false) if lower_open && crack_open => Freedom::Both,
        _ => return None,
    };
    let fits = [lower_fit, upper_fit];
    let numbers = freedom.numbers_of(fits.map(|fit| fit.value), fits.map(|fit| fit.slope / test.step_s));
    Some(MeasuredState { freedom, numbers, spread: freedom.spread(test) })
}

/// Spread of a value, and of a slope, over the standard deviation by which a cubic knows it: as of 17 even samples.
const SPREAD_SHARE: Pair = [1.35, 0.2];

/// The same from the samples within a time, however they are spaced.
fn state_by_time(test: &TestData, k: usize) -> Option<MeasuredState> {
    let channels = test.manner.channels();
    let read = |j: usize| (test.time_s[j], test.from_rest_rad(j));
    let near = around(&test.time_s, k, test.gap_s).map(read);
    let (time_s, theta_rad): (Vec<f64>, Vec<Pair>) =
        near.filter(|(_, theta)| theta[..channels].iter().all(|t| t.is_finite())).unzip();
    let of = |read: fn(&Pair) -> f64| theta_rad.iter().map(read).collect::<Vec<_>>();
    let (lower, upper, crack) = (of(|t| t[0]), of(|t| t[1]), of(|t| t[1] - t[0]));
    let fit = |values: &[f64]| about(&time_s, values, test.time_s[k]);
    let noise = test.noise_rad;
    let lower_fit = fit(&lower)?;
    let opens = |y: &[f64], own: f64, fit: &About, noise: f64| {
        is_clear(y, y.iter().sum(), own) && is_smooth(fit.residual, fit.count, noise)
    };
    let lower_open = opens(&lower, noise[0], &lower_fit, noise[0]);
    if test.manner.top_held {
        let freedom = match is_zero(&lower, noise[0]) {
            true => Freedom::Rest,
            false if lower_open => Freedom::Held,
            false => return None,
        };
        return Some(state_of(freedom, [&lower_fit; 2], [noise[0]; 2]));
    }
    let upper_fit = fit(&upper)?;
    let crack_noise = noise[0].hypot(noise[1]);
    let crack_open = opens(&crack, crack_noise, &upper_fit, noise[1]);
    let closed = [is_zero(&lower, noise[0]), is_zero(&crack, crack_noise)];
    let freedom = match closed {
        [true, true] if is_zero(&upper, noise[1]) => Freedom::Rest,
        [true, false] if crack_open => Freedom::Upper,
        [false, true] if lower_open => Freedom::Monolithic,
        [false, false] if lower_open && crack_open => Freedom::Both,
        _ => return None,
    };
    Some(state_of(freedom, [&lower_fit, &upper_fit], noise))
}

fn state_of(freedom: Freedom, fits: [&About; 2], noise: Pair) -> MeasuredState {
    let numbers = freedom.numbers_of(fits.map(|fit| fit.state[0]), fits.map(|fit| fit.state[1]));
    let sd = |part: usize| [0, 1].map(|i| SPREAD_SHARE[part] * noise[i] * fits[i].sd[part]);
    let spread = freedom.numbers_of(sd(0), sd(1));
    MeasuredState { freedom, numbers, spread }
}

/// Whether a sample has all its neighbours, evenly spaced.
fn stands_among_even(test: &TestData, k: usize) -> bool {
    let around = k.checked_sub(HALF).and_then(|from| test.time_s.get(from..from + COUNT));
    around.is_some_and(|time_s| is_even(time_s, test.step_s))
}

/// Whether samples are as far apart as those of the whole test: smoothing takes them for evenly spaced.
fn is_even(time_s: &[f64], step_s: f64) -> bool {
    time_s.windows(2).all(|pair| ((pair[1] - pair[0]) / step_s - 1.0).abs() < UNEVEN)
}

/// The state of a held strip: its upper body leans so that the top stays where it is.
///
/// The contact is that of the rotations on the joints of this wall. Newton's method; the top moves by J_x = ∂x_C/∂θ.
pub fn held_state(wall: &RockingWall, lower: &State) -> State {
    let (theta1, omega1) = (lower.theta[0], lower.omega[0]);
    let mut theta = [theta1, lower.theta[1]];
    let place = |theta: Pair| wall.with_beds_as_at(Contact::of_rotations(theta), theta);
    for _ in 0..HELD_STEPS {
        let by_upper = wall.top_arms_m(place(theta), theta)[1];
        theta[1] -= wall.top_displacement_m(place(theta), theta) / by_upper;
    }
    let [by_lower, by_upper] = wall.top_arms_m(place(theta), theta);
    State { theta, omega: [omega1, -omega1 * by_lower / by_upper] }
}

/// Steps of Newton's method: from the mirrored rotation the error is squared every time.
const HELD_STEPS: usize = 6;

/// Noise about zero, of enough samples: neither the sum of squares nor the mean stands out.
fn is_zero(y: &[f64], noise: f64) -> bool {
    let n = y.len() as f64;
    let squares = y.iter().map(|v| v * v).sum::<f64>() / (noise * noise);
    let mean = y.iter().sum::<f64>() / n;
    y.len() >= LEAST
        && squares < n + BEYOND_NOISE * (2.0 * n).sqrt()
        && mean.abs() < BEYOND_NOISE * noise / n.sqrt()
}

/// No impact inside: of so many samples a cubic leaves noise.
fn is_smooth(residual: f64, count: usize, noise: f64) -> bool {
    let n = count as f64;
    residual / (noise * noise) < n - CUBIC + BEYOND_NOISE * (2.0 * n).sqrt()
}

/// Of one sign all along, that of `towards`: averages of a few samples clear of zero.
fn is_clear(y: &[f64], towards: f64, noise: f64) -> bool {
    let sign = towards.signum();
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

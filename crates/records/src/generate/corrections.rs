//! Peaks as designed, by small wavelets where they are, and both ends at rest where the motion began.

use super::{STEP_S, as_record};
use crate::Motion;
use crate::intensity::peak;

/// Most wavelets in a round: a peak that is lowered uncovers the next.
const MOST_WAVELETS: usize = 200;
/// Width of the wavelets of velocity in their periods: one swing and a little, for many would raise the spectrum.
const VELOCITY_WIDTH: f64 = 0.5;
/// Relative error of a peak that is left.
const CLOSE: f64 = 1e-4;
/// Frequencies of the wavelets of acceleration, Hz: high, so that velocity hardly notices; several in turn, for one alone
/// can raise beside a peak what it takes off it.
const ACCELERATION_HZ: [f64; 3] = [7.0, 4.5, 3.0];
/// Over these times at the beginning and end the motion fades, s.
const FADE_IN_S: f64 = 0.5;
const FADE_OUT_S: f64 = 2.0;
/// Samples are whole multiples of this, m/s²: five decimals in the file.
const QUANTUM_M_S2: f64 = 1e-5;

/// Brings the largest absolute acceleration to `target_m_s2`.
pub(super) fn set_acceleration(samples: &mut [f64], target_m_s2: f64) {
    for turn in 0..MOST_WAVELETS {
        let (at, excess) = excess(samples, target_m_s2);
        if excess.abs() <= CLOSE * target_m_s2 {
            return;
        }
        let change = -excess * samples[at].signum();
        let frequency_hz = ACCELERATION_HZ[turn % ACCELERATION_HZ.len()];
        let width = 1.0 / frequency_hz;
        for (i, sample) in samples.iter_mut().enumerate() {
            let time = (i as f64 - at as f64) * STEP_S;
            let phase = std::f64::consts::TAU * frequency_hz * time;
            *sample += change * (-(time / width).powi(2)).exp() * phase.cos();
        }
    }
}

/// Brings the largest absolute velocity to `target_m_s` by wavelets of a period that the motion has.
pub(super) fn set_velocity(samples: &mut [f64], target_m_s: f64, period_s: f64) {
    for _ in 0..MOST_WAVELETS {
        let velocity = Motion::of(&as_record(samples)).velocity_m_s;
        let (at, excess) = excess(&velocity, target_m_s);
        if excess.abs() <= CLOSE * target_m_s {
            return;
        }
        let change = -excess * velocity[at].signum();
        let omega = std::f64::consts::TAU / period_s;
        let width = VELOCITY_WIDTH * period_s;
        for (i, sample) in samples.iter_mut().enumerate() {
            // The derivative of change·exp(−(t/width)²)·cos ωt.
            let time = (i as f64 - at as f64) * STEP_S;
            let (sin, cos) = (omega * time).sin_cos();
            let slope = -omega * sin - 2.0 * time / (width * width) * cos;
            *sample += change * (-(time / width).powi(2)).exp() * slope;
        }
    }
}

/// Where the largest absolute value is, and how much it exceeds `target`.
fn excess(values: &[f64], target: f64) -> (usize, f64) {
    let largest = peak(values);
    let at = values.iter().position(|v| v.abs() == largest).unwrap_or(0);
    (at, largest - target)
}

/// Fades both ends and takes off what velocity and displacement would remain, by a smooth hump and its first moment.
pub(super) fn end_at_rest(samples: &mut [f64]) {
    let last = samples.len() - 1;
    let fade = |i: usize, over_s: f64| {
        let x = (i as f64 * STEP_S / over_s).min(1.0);
        (std::f64::consts::FRAC_PI_2 * x).sin().powi(2)
    };
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample *= fade(i, FADE_IN_S) * fade(last - i, FADE_OUT_S);
    }
    let hump = |i: usize| (std::f64::consts::PI * i as f64 / last as f64).sin().powi(2);
    let place = |i: usize| i as f64 / last as f64 - 0.5;
    let moments = |f: &dyn Fn(usize) -> f64| {
        (0..=last).fold([0.0, 0.0], |[m0, m1], i| [m0 + f(i), m1 + f(i) * place(i)])
    };
    let [m0, m1] = moments(&|i| samples[i]);
    // The hump is even about the middle and its moment odd, so the two corrections do not disturb each other.
    let even = m0 / moments(&hump)[0];
    let odd = m1 / moments(&|i| hump(i) * place(i))[1];
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample -= hump(i) * (even + odd * place(i));
    }
}

/// Rounds samples to whole quanta such that trapezoidal velocity and exact displacement end at zero to the last quantum.
///
/// With both ends zero, velocity ends at step·Σk and displacement at step²·Σ(N − i)·k. In quanta both are integers.
pub(super) fn round_at_rest(samples: &[f64]) -> Vec<f64> {
    let mut quanta: Vec<i64> = samples.iter().map(|a| (a / QUANTUM_M_S2).round() as i64).collect();
    let last = quanta.len() - 1;
    (quanta[0], quanta[last]) = (0, 0);
    spread(&mut quanta);
    shift(&mut quanta);
    // Division by a power of ten rounds to the double nearest to the decimal that is written.
    quanta.iter().map(|&k| k as f64 / (1.0 / QUANTUM_M_S2).round()).collect()
}

/// Brings the sum to zero by one quantum each on samples evenly over the motion.
fn spread(quanta: &mut [i64]) {
    let sum: i64 = quanta.iter().sum();
    let count = sum.unsigned_abs() as usize;
    let inner = quanta.len() - 2;
    for i in 0..count {
        quanta[1 + i * inner / count] -= sum.signum();
    }
}

/// Brings the moment to zero by moving quanta between samples, which leaves the sum.
fn shift(quanta: &mut [i64]) {
    let last = quanta.len() - 1;
    let inner = (last - 2) as i64;
    let mut moment: i64 = quanta.iter().enumerate().map(|(i, k)| (last - i) as i64 * k).sum();
    let mut turn = 0;
    while moment != 0 {
        let distance = moment.abs().min(inner - (turn % (inner / 2)));
        // A quantum taken early and given back `distance` samples later lowers the moment by it.
        let early = 1 + ((turn * 7) % (inner - distance + 1)) as usize;
        quanta[early] -= moment.signum();
        quanta[early + distance as usize] += moment.signum();
        moment -= moment.signum() * distance;
        turn += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accelerogram;

    #[test]
    fn analytic_rounded_motion_ends_at_rest_where_it_began() {
        let mut samples: Vec<f64> =
            (0..1500).map(|i| (f64::from(i) * 0.07).sin() * (f64::from(i) * 0.011).cos() + 0.01).collect();
        end_at_rest(&mut samples);
        let motion = Motion::of(&Accelerogram::new(STEP_S, round_at_rest(&samples)).expect("valid"));
        let (velocity, displacement) = (motion.velocity_m_s[1499], motion.displacement_m[1499]);
        // Integers of quanta are exact; the decimals and the 1500 additions of the test round.
        assert!(velocity.abs() < 1e-14 && displacement.abs() < 1e-12, "{velocity} {displacement}");
    }

    #[test]
    fn analytic_rounding_moves_samples_by_few_quanta() {
        let mut samples: Vec<f64> = (0..1500).map(|i| (f64::from(i) * 0.07).sin()).collect();
        end_at_rest(&mut samples);
        let moved = samples.iter().zip(round_at_rest(&samples)).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f64::max) < 10.0 * QUANTUM_M_S2);
    }
}

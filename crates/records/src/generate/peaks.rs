//! Setting the peak acceleration and velocity of a motion by small wavelets where the peaks are.

use super::{STEP_S, as_record};
use crate::Motion;
use crate::integrate::peak;

/// Most wavelets in a round: a peak that is lowered uncovers the next.
const MOST: usize = 200;
/// Relative error of a peak that is left.
/// Width of the wavelets of velocity in their periods: one swing and a little, for many would raise the spectrum.
const VELOCITY_WIDTH: f64 = 0.5;
const CLOSE: f64 = 1e-4;
/// Frequencies of the wavelets of acceleration, Hz: high, so that velocity hardly notices; several in turn, for one alone
/// can raise beside a peak what it takes off it.
const ACCELERATION_HZ: [f64; 3] = [7.0, 4.5, 3.0];

/// Brings the largest absolute acceleration to `target_m_s2`.
pub(super) fn set_acceleration(samples: &mut [f64], target_m_s2: f64) {
    for turn in 0..MOST {
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
    for _ in 0..MOST {
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

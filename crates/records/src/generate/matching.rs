//! Correcting the Fourier amplitudes of a motion towards a target response spectrum.

use super::design::Target;
use super::{STEP_S, as_record};
use crate::fft;
use crate::spectrum::{CODE_DAMPING, response_spectrum_m_s2};

/// Share of the logarithmic error that a round corrects: neighbouring periods share frequencies.
const SHARE: f64 = 0.7;
/// Largest logarithmic correction of a round.
const LARGEST: f64 = 0.7;
/// Waves longer than this carry no strength and drift the displacement, Hz.
const HIGH_PASS_HZ: f64 = 0.12;

/// Corrects `samples` once towards `target`, keeping their phases.
pub(super) fn correct(samples: &mut [f64], target: &Target) {
    let found = response_spectrum_m_s2(&as_record(samples), &target.period_s, CODE_DAMPING);
    let ratios: Vec<f64> = target.sa_m_s2.iter().zip(found).map(|(t, f)| correction(*t, f)).collect();
    let log_periods: Vec<f64> = target.period_s.iter().map(|p| p.ln()).collect();
    let length = (2 * samples.len()).next_power_of_two();
    let mut spectrum = fft::of_real(samples, length);
    for (k, value) in spectrum.iter_mut().enumerate() {
        let frequency_hz = k.min(length - k) as f64 / (length as f64 * STEP_S);
        let gain =
            high_pass(frequency_hz) * interpolate(&log_periods, &ratios, -frequency_hz.max(1e-9).ln()).exp();
        *value = [value[0] * gain, value[1] * gain];
    }
    fft::inverse(&mut spectrum);
    for (sample, value) in samples.iter_mut().zip(spectrum) {
        *sample = value[0];
    }
}

/// Logarithm of the factor on amplitudes.
fn correction(target: f64, found: f64) -> f64 {
    (SHARE * (target / found).ln()).clamp(-LARGEST, LARGEST)
}

/// Nothing at rest, nearly one from twice the corner on.
fn high_pass(frequency_hz: f64) -> f64 {
    let power = (frequency_hz / HIGH_PASS_HZ).powi(8);
    power / (1.0 + power)
}

/// Linear between points of rising `xs`, constant outside.
fn interpolate(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let after = xs.partition_point(|&point| point < x);
    match after {
        0 => ys[0],
        after if after == xs.len() => ys[after - 1],
        after => {
            let share = (x - xs[after - 1]) / (xs[after] - xs[after - 1]);
            ys[after - 1] + share * (ys[after] - ys[after - 1])
        }
    }
}

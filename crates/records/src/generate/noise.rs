//! Normal noise under an envelope that rises, stays and fades, brought to a target spectrum.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::design::Target;
use super::{STEP_S, as_record};
use crate::fft;
use crate::spectrum::{CODE_DAMPING, response_spectrum_m_s2};

/// Quiet before the shaking, s.
pub(super) const LEAD_S: f64 = 0.5;
/// Parts of the envelope in significant durations (Jennings, Housner and Tsai 1968, "Simulated earthquake motions"): a
/// parabola, a plateau, an exponential; with these the significant duration of the whole is 1.02 of the one wanted.
const RISE: f64 = 0.15;
const STAY: f64 = 0.60;
const FADE: f64 = 1.40;
const FADE_RATE: f64 = 2.0;
/// Share of the logarithmic error that a round corrects: neighbouring periods share frequencies.
const CORRECTED_SHARE: f64 = 0.7;
/// Largest logarithmic correction of a round.
const LARGEST_CORRECTION: f64 = 0.7;
/// Waves longer than this carry no strength and drift the displacement, Hz.
const HIGH_PASS_HZ: f64 = 0.12;

/// The generator of random numbers of one record: it depends on the seed and the record's number alone.
pub(super) fn generator(seed: u64, id: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(id));
    rng
}

pub(super) fn under_envelope(duration_s: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let length_s = LEAD_S + (RISE + STAY + FADE) * duration_s;
    let samples = (length_s / STEP_S).ceil() as usize;
    (0..=samples)
        .map(|i| {
            let white: f64 = StandardNormal.sample(rng);
            white * envelope((i as f64 * STEP_S - LEAD_S) / duration_s)
        })
        .collect()
}

/// The envelope at a time in significant durations.
fn envelope(time: f64) -> f64 {
    if time < RISE {
        (time / RISE).max(0.0).powi(2)
    } else if time < RISE + STAY {
        1.0
    } else {
        (-FADE_RATE * (time - RISE - STAY)).exp()
    }
}

/// Corrects `samples` once towards `target`, keeping their phases.
pub(super) fn match_spectrum(samples: &mut [f64], target: &Target) {
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
    (CORRECTED_SHARE * (target / found).ln()).clamp(-LARGEST_CORRECTION, LARGEST_CORRECTION)
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

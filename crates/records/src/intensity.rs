//! Ground velocity and displacement, and measures of how strong a record is.

use serde::Serialize;

use super::spectrum::{CODE_DAMPING, spectral_acceleration_m_s2};
use super::{Accelerogram, fft};
use mrbd_kernel::model::G_M_S2;

/// Periods of the average spectral acceleration: 0.2 to 2.0 s by 0.1 s, 19 of them.
const AVERAGE_PERIODS: std::ops::RangeInclusive<u32> = 2..=20;
/// Frequencies of the mean period, Hz (Rathje et al. 2004).
const MEAN_PERIOD_BAND_HZ: std::ops::RangeInclusive<f64> = 0.25..=20.0;
/// Largest spacing of frequencies for the mean period, Hz (Rathje et al. 2004).
const MEAN_PERIOD_SPACING_HZ: f64 = 0.05;

/// Velocity (m/s) and displacement (m) at the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Velocity at the samples, m/s; zero at the first.
    pub velocity_m_s: Vec<f64>,
    /// Displacement at the samples, m; zero at the first.
    pub displacement_m: Vec<f64>,
}

impl Motion {
    /// Integrates acceleration linear between samples: exactly, so the velocity is the trapezoidal sum.
    ///
    /// Nothing is corrected: what the samples drift shows.
    pub fn of(record: &Accelerogram) -> Self {
        let step = record.step_s();
        let samples = record.acceleration_m_s2();
        let (mut velocity, mut displacement) = (0.0, 0.0);
        let mut velocity_m_s = Vec::with_capacity(samples.len());
        let mut displacement_m = Vec::with_capacity(samples.len());
        velocity_m_s.push(velocity);
        displacement_m.push(displacement);
        for pair in samples.windows(2) {
            displacement += step * velocity + step * step * (2.0 * pair[0] + pair[1]) / 6.0;
            velocity += step * (pair[0] + pair[1]) / 2.0;
            velocity_m_s.push(velocity);
            displacement_m.push(displacement);
        }
        Self { velocity_m_s, displacement_m }
    }

    /// Largest absolute velocity, m/s.
    pub fn peak_velocity_m_s(&self) -> f64 {
        peak(&self.velocity_m_s)
    }

    /// Largest absolute displacement, m.
    pub fn peak_displacement_m(&self) -> f64 {
        peak(&self.displacement_m)
    }
}

pub(crate) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, v| f64::max(peak, v.abs()))
}

/// Intensity measures of one component.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IntensityMeasures {
    /// Largest absolute acceleration, m/s².
    pub pga_m_s2: f64,
    /// The same in g.
    pub pga_g: f64,
    /// Largest absolute velocity, m/s: trapezoidal integral from rest, no correction.
    pub pgv_m_s: f64,
    /// Largest absolute displacement, m: second integral from rest, no correction.
    pub pgd_m: f64,
    /// Arias intensity, π/2g·∫a²dt, m/s (Arias 1970), by trapezia.
    pub arias_m_s: f64,
    /// Cumulative absolute velocity, ∫|a|dt, m/s (EPRI 1988), by trapezia.
    pub cav_m_s: f64,
    /// Time from 5 % to 95 % of the Arias intensity, s (Trifunac and Brady 1975).
    pub duration_5_95_s: f64,
    /// Mean period, ΣC²/f over ΣC² for 0.25 to 20 Hz, s (Rathje, Faraj, Russell and Bray 2004).
    pub mean_period_s: f64,
    /// Pseudo-acceleration at 0.5 s, 5 % damping, m/s².
    pub sa_0p5s_m_s2: f64,
    /// Pseudo-acceleration at 1.0 s, 5 % damping, m/s².
    pub sa_1p0s_m_s2: f64,
    /// Geometric mean of the pseudo-accelerations at 0.2, 0.3, …, 2.0 s, 5 % damping, m/s².
    pub sa_average_m_s2: f64,
}

impl IntensityMeasures {
    /// Measures a record.
    pub fn of(record: &Accelerogram) -> Self {
        let motion = Motion::of(record);
        let energy = cumulative(record, |a| a * a);
        let pga_m_s2 = record.peak_m_s2();
        let sa = |period_s| spectral_acceleration_m_s2(record, period_s, CODE_DAMPING);
        Self {
            pga_m_s2,
            pga_g: pga_m_s2 / G_M_S2,
            pgv_m_s: motion.peak_velocity_m_s(),
            pgd_m: motion.peak_displacement_m(),
            arias_m_s: std::f64::consts::FRAC_PI_2 / G_M_S2 * last(&energy),
            cav_m_s: last(&cumulative(record, f64::abs)),
            duration_5_95_s: (fraction_index(&energy, 0.95) - fraction_index(&energy, 0.05))
                * record.step_s(),
            mean_period_s: mean_period_s(record),
            sa_0p5s_m_s2: sa(0.5),
            sa_1p0s_m_s2: sa(1.0),
            sa_average_m_s2: sa_average_m_s2(record),
        }
    }
}

/// Running trapezoidal integral of `f(a)` over time.
fn cumulative(record: &Accelerogram, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    for pair in record.acceleration_m_s2().windows(2) {
        sum += record.step_s() * (f(pair[0]) + f(pair[1])) / 2.0;
        sums.push(sum);
    }
    sums
}

fn last(sums: &[f64]) -> f64 {
    sums.last().copied().unwrap_or(0.0)
}

/// Where rising `sums` reach a fraction of their last value, in samples, linear between them.
fn fraction_index(sums: &[f64], fraction: f64) -> f64 {
    let level = fraction * last(sums);
    let after = sums.partition_point(|&sum| sum < level);
    if after == 0 || after == sums.len() {
        return 0.0;
    }
    let (low, high) = (sums[after - 1], sums[after]);
    (after - 1) as f64 + (level - low) / (high - low)
}

fn mean_period_s(record: &Accelerogram) -> f64 {
    let step = record.step_s();
    let shortest = (1.0 / (MEAN_PERIOD_SPACING_HZ * step)).ceil() as usize;
    let length = record.acceleration_m_s2().len().max(shortest).next_power_of_two();
    let spectrum = fft::of_real(record.acceleration_m_s2(), length);
    let (mut weighted, mut total) = (0.0, 0.0);
    for (k, [re, im]) in spectrum.iter().enumerate().take(length / 2) {
        let frequency_hz = k as f64 / (length as f64 * step);
        if MEAN_PERIOD_BAND_HZ.contains(&frequency_hz) {
            let square = re * re + im * im;
            weighted += square / frequency_hz;
            total += square;
        }
    }
    if total > 0.0 { weighted / total } else { 0.0 }
}

fn sa_average_m_s2(record: &Accelerogram) -> f64 {
    let logarithms = AVERAGE_PERIODS
        .map(|tenths| spectral_acceleration_m_s2(record, f64::from(tenths) / 10.0, CODE_DAMPING).ln());
    let count = AVERAGE_PERIODS.count() as f64;
    (logarithms.sum::<f64>() / count).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_sine_pulse_integrates_to_its_velocity_and_displacement() {
        // a = sin(2πt/T): v peaks at T/π, d ends at T²/2π.
        let (period, step) = (1.0_f64, 1e-3);
        let samples =
            (0..=1000).map(|i| (std::f64::consts::TAU * f64::from(i) * step / period).sin()).collect();
        let motion = Motion::of(&Accelerogram::new(step, samples).expect("valid"));
        let end = *motion.displacement_m.last().expect("samples");
        // Linear interpolation of a sine errs by (2π·step/T)²/12 = 3.3e-6, relative.
        assert!((motion.peak_velocity_m_s() * std::f64::consts::PI - 1.0).abs() < 4e-6);
        assert!((end * std::f64::consts::TAU - 1.0).abs() < 4e-6);
    }
}

//! Elastic response spectra.
//!
//! Nigam and Jennings (1969), "Calculation of response spectra from strong-motion earthquake records",
//! Bulletin of the Seismological Society of America 59(2): the exact solution for acceleration linear between samples.

use super::Accelerogram;

/// Points in a period at which the response is at least looked at.
///
/// Where the oscillator swings freely, a peak between two is missed by 1 − cos(π/40) = 0.31 % at most. The ground
/// adds to the curvature of a peak, which makes it up to 1 + PGA/Sa times as much. Found: 0.25 % on the generated records
/// of this repository, 0.55 % on a near-fault pulse of 16 samples a period.
const POINTS_IN_PERIOD: f64 = 40.0;

/// Damping of the spectra of codes, relative to critical.
pub const CODE_DAMPING: f64 = 0.05;

/// The recursion u(t+h), v(t+h) from u, v and the ground acceleration at both ends of a step.
pub(crate) struct Recursion {
    state: [[f64; 2]; 2],
    ground: [[f64; 2]; 2],
}

impl Recursion {
    /// For circular frequency ω (rad/s), damping ratio ζ and step h (s): the matrices A and B of the source.
    pub(crate) fn new(omega: f64, damping: f64, step: f64) -> Self {
        let root = (1.0 - damping * damping).sqrt();
        let omega_d = omega * root;
        let decay = (-damping * omega * step).exp();
        let (sin, cos) = (omega_d * step).sin_cos();
        let state = [
            [decay * (damping / root * sin + cos), decay * sin / omega_d],
            [-decay * omega / root * sin, decay * (cos - damping / root * sin)],
        ];
        let square = omega * omega;
        let cube_step = square * omega * step;
        let square_step = square * step;
        let first = (2.0 * damping * damping - 1.0) / square_step;
        let second = 2.0 * damping / cube_step;
        let slope = cos - damping / root * sin;
        let level = omega_d * sin + damping * omega * cos;
        let ground = [
            [
                decay * ((first + damping / omega) * sin / omega_d + (second + 1.0 / square) * cos) - second,
                -decay * (first * sin / omega_d + second * cos) - 1.0 / square + second,
            ],
            [
                decay * ((first + damping / omega) * slope - (second + 1.0 / square) * level)
                    + 1.0 / square_step,
                -decay * (first * slope - second * level) - 1.0 / square_step,
            ],
        ];
        Self { state, ground }
    }

    pub(crate) fn advance(&self, [u, v]: [f64; 2], a0: f64, a1: f64) -> [f64; 2] {
        let row = |i: usize| {
            let (s, g) = (self.state[i], self.ground[i]);
            s[0] * u + s[1] * v + g[0] * a0 + g[1] * a1
        };
        [row(0), row(1)]
    }
}

/// Pseudo-acceleration ω²·max|u| of an oscillator of period `period_s` (s) and relative damping, m/s².
///
/// The response is followed until half a period after the record. A period of zero gives the peak ground acceleration.
pub fn spectral_acceleration_m_s2(record: &Accelerogram, period_s: f64, damping: f64) -> f64 {
    if period_s <= 0.0 {
        return record.peak_m_s2();
    }
    let omega = std::f64::consts::TAU / period_s;
    omega * omega * peak_displacement_m(record, omega, damping, POINTS_IN_PERIOD)
}

fn peak_displacement_m(record: &Accelerogram, omega: f64, damping: f64, points_in_period: f64) -> f64 {
    let period = std::f64::consts::TAU / omega;
    let parts = (record.step_s() * points_in_period / period).ceil().max(1.0);
    let step = record.step_s() / parts;
    let recursion = Recursion::new(omega, damping, step);
    let samples = record.acceleration_m_s2();
    let mut state = [0.0, 0.0];
    let mut peak: f64 = 0.0;
    for pair in samples.windows(2) {
        let slope = (pair[1] - pair[0]) / parts;
        for part in 0..parts as usize {
            let a0 = pair[0] + slope * part as f64;
            state = recursion.advance(state, a0, a0 + slope);
            peak = peak.max(state[0].abs());
        }
    }
    for _ in 0..(period / 2.0 / step).ceil() as usize {
        state = recursion.advance(state, 0.0, 0.0);
        peak = peak.max(state[0].abs());
    }
    peak
}

/// Pseudo-accelerations at several periods (s), m/s².
pub fn response_spectrum_m_s2(record: &Accelerogram, periods_s: &[f64], damping: f64) -> Vec<f64> {
    periods_s.iter().map(|&period| spectral_acceleration_m_s2(record, period, damping)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{Pulse, Suite};

    #[test]
    fn analytic_long_step_of_acceleration_doubles_the_static_displacement() {
        // Undamped, a sudden constant acceleration: max|u| = 2a/ω², so the pseudo-acceleration is 2a.
        let record = Accelerogram::new(0.01, vec![1.0; 400]).expect("valid");
        for period in [0.1, 0.5, 1.0] {
            let value = spectral_acceleration_m_s2(&record, period, 0.0);
            // A peak between two of 40 points in a period is missed by 1 − cos(π/40) at most, of half the response.
            assert!(value <= 2.0 + 1e-9 && value > 2.0 * (1.0 - 0.0016), "{period}: {value}");
        }
    }

    #[test]
    fn analytic_resonance_grows_by_pi_a_cycle() {
        // Undamped at resonance, a = sin ωt: u = (ωt cos ωt − sin ωt)/2ω², so after n cycles ω²·max|u| → nπ.
        let (period, cycles) = (1.0, 20.0);
        let step = period / 400.0;
        let samples = (0..=(cycles * 400.0) as i32)
            .map(|i| (std::f64::consts::TAU * f64::from(i) * step).sin())
            .collect();
        let value =
            spectral_acceleration_m_s2(&Accelerogram::new(step, samples).expect("valid"), period, 0.0);
        // Interpolating the sine linearly takes (2π/400)²/12 = 2e-5 off; the end state turns smoothly, adding 1/(2n²π²).
        assert!((value / (cycles * std::f64::consts::PI) - 1.0).abs() < 2e-4, "{value}");
    }

    /// Share of the peak that is missed between the points, and the most that it can be.
    fn missed(record: &Accelerogram, period_s: f64) -> (f64, f64) {
        let omega = std::f64::consts::TAU / period_s;
        let peak_m = |points| peak_displacement_m(record, omega, CODE_DAMPING, points);
        // Sixteen times as many points miss 256 times less.
        let true_m = peak_m(16.0 * POINTS_IN_PERIOD);
        let free = 1.0 - (std::f64::consts::PI / POINTS_IN_PERIOD).cos();
        let forced = 1.0 + record.peak_m_s2() / (omega * omega * true_m);
        (1.0 - peak_m(POINTS_IN_PERIOD) / true_m, free * forced)
    }

    #[test]
    fn regress_peaks_between_points_are_missed_by_as_much_as_is_stated() {
        let suite = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/records/emilia7/suite.toml");
        let suite = Suite::load(&suite).expect("valid");
        let (mut most, periods_s) = (0.0_f64, (1..=80).map(|i| 0.05 * f64::from(i)));
        for (record, period_s) in suite.records.iter().flat_map(|r| periods_s.clone().map(move |p| (r, p))) {
            let (missed, bound) = missed(&record.horizontal, period_s);
            assert!(missed <= bound, "{} at {period_s} s: {missed} of {bound}", record.name);
            most = most.max(missed);
        }
        assert!((0.0025..0.0026).contains(&most), "{most}");
        let (velocity_m_s, period_s, oscillations, phase_rad) = (1.0, 1.0, 2.0, 0.0);
        let pulse = Pulse::MavroeidisPapageorgiou { velocity_m_s, period_s, oscillations, phase_rad };
        let (missed, bound) = missed(&pulse.accelerogram(Some(1.0 / 16.0)).expect("a pulse"), 2.5);
        assert!(missed <= bound && (0.0054..0.0056).contains(&missed), "{missed} of {bound}");
    }
}

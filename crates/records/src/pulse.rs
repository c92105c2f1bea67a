//! Pulses given by formulas, as accelerograms.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use super::Accelerogram;

/// Samples in a period where no step is given.
const SAMPLES_IN_PERIOD: f64 = 500.0;
/// Periods of a Ricker pulse kept on either side of its middle; beyond, it is below 2e-5 of its peak.
const RICKER_HALF_WIDTH: f64 = 1.2;
/// Most samples of a pulse: more come from a step given in another unit.
const MOST_SAMPLES: f64 = 1e7;

/// A pulse of ground acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Pulse {
    /// a·sin(2πt/T) for one period.
    OneSine {
        /// a, m/s².
        amplitude_m_s2: f64,
        /// T, s.
        period_s: f64,
    },
    /// a·cos(2πt/T) for one period.
    OneCosine {
        /// a, m/s².
        amplitude_m_s2: f64,
        /// T, s.
        period_s: f64,
    },
    /// a·sin(2πt/T) for half a period.
    HalfSine {
        /// a, m/s².
        amplitude_m_s2: f64,
        /// T, s: twice the length of the pulse.
        period_s: f64,
    },
    /// a·(1 − 2π²τ²/T²)·exp(−π²τ²/T²), τ from the middle (Ricker 1943, "Further developments in the wavelet theory of
    /// seismogram structure").
    Ricker {
        /// a, m/s².
        amplitude_m_s2: f64,
        /// T, s.
        period_s: f64,
    },
    /// Velocity (A/2)·(1 + cos(2πτ/γT))·cos(2πτ/T + ν) for |τ| ≤ γT/2 (Mavroeidis and Papageorgiou 2003, "A mathematical
    /// representation of near-fault ground motions").
    MavroeidisPapageorgiou {
        /// A, m/s.
        velocity_m_s: f64,
        /// T, s.
        period_s: f64,
        /// γ, more than 1: how often it oscillates.
        oscillations: f64,
        /// ν, rad.
        #[serde(default)]
        phase_rad: f64,
    },
}

/// A number of a pulse that makes no pulse: which, and what was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{name} {value}; allowed: {allowed}")]
pub struct ImpossiblePulse {
    /// The name of the number.
    pub name: &'static str,
    /// What was found.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl Pulse {
    /// T, s.
    pub fn period_s(&self) -> f64 {
        match *self {
            Pulse::OneSine { period_s, .. }
            | Pulse::OneCosine { period_s, .. }
            | Pulse::HalfSine { period_s, .. }
            | Pulse::Ricker { period_s, .. }
            | Pulse::MavroeidisPapageorgiou { period_s, .. } => period_s,
        }
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        match *self {
            Pulse::OneSine { period_s, .. } | Pulse::OneCosine { period_s, .. } => period_s,
            Pulse::HalfSine { period_s, .. } => period_s / 2.0,
            Pulse::Ricker { period_s, .. } => 2.0 * RICKER_HALF_WIDTH * period_s,
            Pulse::MavroeidisPapageorgiou { period_s, oscillations, .. } => oscillations * period_s,
        }
    }

    /// Acceleration at `time_s` after its beginning, m/s²; zero outside.
    pub fn acceleration_m_s2(&self, time_s: f64) -> f64 {
        if !(0.0..=self.duration_s()).contains(&time_s) {
            return 0.0;
        }
        let middle = time_s - self.duration_s() / 2.0;
        match *self {
            Pulse::OneSine { amplitude_m_s2, period_s } | Pulse::HalfSine { amplitude_m_s2, period_s } => {
                amplitude_m_s2 * (TAU * time_s / period_s).sin()
            }
            Pulse::OneCosine { amplitude_m_s2, period_s } => amplitude_m_s2 * (TAU * time_s / period_s).cos(),
            Pulse::Ricker { amplitude_m_s2, period_s } => {
                let square = (PI * middle / period_s).powi(2);
                amplitude_m_s2 * (1.0 - 2.0 * square) * (-square).exp()
            }
            Pulse::MavroeidisPapageorgiou { velocity_m_s, period_s, oscillations, phase_rad } => {
                // The derivative of the velocity above.
                let slow = TAU * middle / (oscillations * period_s);
                let fast = TAU * middle / period_s + phase_rad;
                let swell = slow.sin() * fast.cos() / oscillations;
                -velocity_m_s * PI / period_s * (swell + fast.sin() * (1.0 + slow.cos()))
            }
        }
    }

    /// Samples the pulse; without a step, 500 samples in a period.
    ///
    /// # Errors
    /// [`ImpossiblePulse`] for a number that makes no pulse, or a step that is not finer than its length.
    pub fn accelerogram(&self, step_s: Option<f64>) -> Result<Accelerogram, ImpossiblePulse> {
        self.check()?;
        let step_s = step_s.unwrap_or(self.period_s() / SAMPLES_IN_PERIOD);
        let steps = (self.duration_s() / step_s).round();
        let impossible = || ImpossiblePulse {
            name: "step_s",
            value: step_s,
            allowed: "between a ten-millionth of the pulse and the pulse",
        };
        if !(step_s > 0.0 && (1.0..MOST_SAMPLES).contains(&steps)) {
            return Err(impossible());
        }
        let samples =
            (0..=steps as usize).map(|i| self.acceleration_m_s2((i as f64 * step_s).min(self.duration_s())));
        Accelerogram::new(step_s, samples.collect()).map_err(|_| impossible())
    }

    fn check(&self) -> Result<(), ImpossiblePulse> {
        let positive = |name, value: f64| {
            let is_positive = value.is_finite() && value > 0.0;
            is_positive.then_some(()).ok_or(ImpossiblePulse {
                name,
                value,
                allowed: "a positive finite number",
            })
        };
        positive("period_s", self.period_s())?;
        match *self {
            Pulse::OneSine { amplitude_m_s2, .. }
            | Pulse::OneCosine { amplitude_m_s2, .. }
            | Pulse::HalfSine { amplitude_m_s2, .. }
            | Pulse::Ricker { amplitude_m_s2, .. } => positive("amplitude_m_s2", amplitude_m_s2),
            Pulse::MavroeidisPapageorgiou { velocity_m_s, oscillations, phase_rad, .. } => {
                positive("velocity_m_s", velocity_m_s)?;
                // At γ = 1 the swell has no shape left (Mavroeidis and Papageorgiou 2003).
                positive("oscillations - 1", oscillations - 1.0)?;
                let phase =
                    ImpossiblePulse { name: "phase_rad", value: phase_rad, allowed: "a finite number" };
                phase_rad.is_finite().then_some(()).ok_or(phase)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Motion;
    use super::*;

    #[test]
    fn analytic_end_velocities_of_the_pulses() {
        let (amplitude_m_s2, period_s) = (2.0, 1.0);
        // ∫a: zero over a whole period and of the Ricker wavelet, aT/π over half a sine.
        for (pulse, expected) in [
            (Pulse::OneSine { amplitude_m_s2, period_s }, 0.0),
            (Pulse::OneCosine { amplitude_m_s2, period_s }, 0.0),
            (Pulse::HalfSine { amplitude_m_s2, period_s }, 2.0 / PI),
            (Pulse::Ricker { amplitude_m_s2, period_s }, 0.0),
        ] {
            let record = pulse.accelerogram(None).expect("possible");
            let velocity = *Motion::of(&record).velocity_m_s.last().expect("samples");
            // Trapezia of 500 a period err by (2π/500)²/12 = 1.3e-5; the tails of the Ricker pulse are cut at 2e-5.
            assert!((velocity - expected).abs() < 4e-5, "{pulse:?}: {velocity}");
            assert!((record.peak_m_s2() - amplitude_m_s2).abs() < 1e-9, "{pulse:?}");
        }
    }

    #[test]
    fn analytic_near_fault_pulse_has_the_velocity_it_is_named_by() {
        let pulse = Pulse::MavroeidisPapageorgiou {
            velocity_m_s: 0.5,
            period_s: 1.5,
            oscillations: 2.0,
            phase_rad: 0.0,
        };
        let motion = Motion::of(&pulse.accelerogram(None).expect("possible"));
        let end = motion.velocity_m_s.last().expect("samples");
        // By trapezia, as above: some 1e-5 of the peak.
        assert!((motion.peak_velocity_m_s() - 0.5).abs() < 1e-5 && end.abs() < 1e-5, "{end}");
    }

    #[test]
    fn rejects_pulses_that_are_none() {
        let sine = |amplitude_m_s2, period_s| Pulse::OneSine { amplitude_m_s2, period_s };
        for (pulse, step, name) in [
            (sine(-1.0, 1.0), None, "amplitude_m_s2"),
            (sine(1.0, 0.0), None, "period_s"),
            (sine(1.0, f64::NAN), None, "period_s"),
            (sine(1.0, 1.0), Some(5.0), "step_s"),
            (sine(1.0, 1.0), Some(1e-12), "step_s"),
        ] {
            assert_eq!(pulse.accelerogram(step).expect_err("must be refused").name, name);
        }
    }
}

//! Ground velocity and displacement: integrals from rest at the first sample, without baseline correction.

use super::Accelerogram;

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

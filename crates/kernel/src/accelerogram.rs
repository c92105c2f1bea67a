//! One component of ground acceleration at a fixed step.

use std::sync::Arc;

/// Ground acceleration in m/s² at a fixed step, linear between samples; time zero is the first sample.
///
/// A value that exists is valid: at least two samples, all finite, and a positive step.
#[derive(Debug, Clone, PartialEq)]
pub struct Accelerogram {
    step_s: f64,
    acceleration_m_s2: Arc<[f64]>,
}

/// Why samples are not an accelerogram.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvalidAccelerogram {
    /// The step is not a positive finite number of seconds.
    #[error("step {0} s; allowed: a positive finite number of seconds")]
    Step(f64),
    /// Fewer than two samples.
    #[error("{0} sample(s); allowed: at least 2")]
    TooShort(usize),
    /// A sample is NaN or infinite.
    #[error("sample {index} is {value}; allowed: finite numbers")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
        /// The value found.
        value: f64,
    },
}

impl Accelerogram {
    /// Checks and keeps samples in m/s² at a step in seconds.
    ///
    /// # Errors
    /// [`InvalidAccelerogram`] for a step that is not positive, fewer than two samples, or a sample that is not finite.
    pub fn new(step_s: f64, acceleration_m_s2: Vec<f64>) -> Result<Self, InvalidAccelerogram> {
        if !(step_s.is_finite() && step_s > 0.0) {
            return Err(InvalidAccelerogram::Step(step_s));
        }
        if acceleration_m_s2.len() < 2 {
            return Err(InvalidAccelerogram::TooShort(acceleration_m_s2.len()));
        }
        if let Some((index, &value)) = acceleration_m_s2.iter().enumerate().find(|(_, a)| !a.is_finite()) {
            return Err(InvalidAccelerogram::NotFinite { index, value });
        }
        Ok(Self { step_s, acceleration_m_s2: acceleration_m_s2.into() })
    }

    /// Time between samples, s.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// Samples, m/s².
    pub fn acceleration_m_s2(&self) -> &[f64] {
        &self.acceleration_m_s2
    }

    /// Whether both are one motion, its samples shared.
    pub fn shares_samples_with(&self, other: &Self) -> bool {
        self.step_s == other.step_s && Arc::ptr_eq(&self.acceleration_m_s2, &other.acceleration_m_s2)
    }

    /// Time of the last sample, s.
    pub fn duration_s(&self) -> f64 {
        (self.acceleration_m_s2.len() - 1) as f64 * self.step_s
    }

    /// The same motion times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let acceleration_m_s2 = self.acceleration_m_s2.iter().map(|a| a * factor).collect();
        Self { step_s: self.step_s, acceleration_m_s2 }
    }

    /// Largest absolute acceleration, m/s².
    pub fn peak_m_s2(&self) -> f64 {
        self.acceleration_m_s2.iter().fold(0.0, |peak, a| f64::max(peak, a.abs()))
    }
}

//! A run held against the measurement while it goes.

use super::misfit::{BLOCKS, Sample};
use mrbd_kernel::model::{Contact, Pair, Reading};
use mrbd_kernel::simulate::Observer;
use mrbd_kernel::solver::Quintic;

/// ∫|θ_i,exp - θ_i,num| by channel and block, rad s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// By channel and block.
    pub rad_s: [[f64; BLOCKS]; 2],
}

impl Errors {
    /// None.
    pub const NONE: Self = Self { rad_s: [[0.0; BLOCKS]; 2] };

    /// Adds those of another window.
    pub fn add(&mut self, other: &Self) {
        for (blocks, others) in self.rad_s.iter_mut().zip(&other.rad_s) {
            blocks.iter_mut().zip(others).for_each(|(sum, error)| *sum += error);
        }
    }
}

/// Compares a run with its target while it goes, and ends it when its part of Eq. 8 has passed what is worth while.
#[derive(Debug)]
pub struct Comparison<'a> {
    samples: &'a [Sample],
    reading: Reading,
    next: usize,
    errors: Errors,
    /// 1 / ∫|θ_i,exp| of the whole test.
    weights: Pair,
    wme: f64,
    most_wme: f64,
    residuals: Option<Vec<f64>>,
}

impl<'a> Comparison<'a> {
    /// Before the run; `weights` are the channels' in Eq. 8 of the whole test.
    pub(super) fn new(samples: &'a [Sample], weights: Pair, most_wme: f64) -> Self {
        let reading = Reading::TRUE;
        Self { samples, reading, next: 0, errors: Errors::NONE, weights, wme: 0.0, most_wme, residuals: None }
    }

    /// Keeps the signed errors of all samples as they weigh in Eq. 8: the sum of their sizes is the WME.
    pub(super) fn keeping_residuals(mut self) -> Self {
        self.residuals = Some(Vec::with_capacity(2 * self.samples.len()));
        self
    }

    /// The signed errors, if they were to be kept.
    pub(super) fn into_residuals(self) -> Vec<f64> {
        self.residuals.unwrap_or_default()
    }

    /// Compares what sensors read of the rotations.
    #[must_use]
    pub fn read_by(self, reading: Reading) -> Self {
        Self { reading, ..self }
    }

    /// After the run.
    pub fn errors(&self) -> Errors {
        self.errors
    }

    /// This run's part of Eq. 8 so far; it only grows.
    pub fn wme(&self) -> f64 {
        self.wme
    }

    fn compare_until(&mut self, end_s: f64, theta_at: impl Fn(f64) -> Pair) {
        while let Some(sample) = self.samples.get(self.next).filter(|s| s.time_s < end_s) {
            let theta = self.reading.of(theta_at(sample.time_s));
            for (i, blocks) in self.errors.rad_s.iter_mut().enumerate() {
                let error = sample.weight_s[i] * (sample.theta_rad[i] - theta[i]);
                blocks[sample.block] += error.abs();
                self.wme += self.weights[i] * error.abs();
                if let Some(residuals) = &mut self.residuals {
                    residuals.push(self.weights[i] * error);
                }
            }
            self.next += 1;
        }
    }
}

impl Observer for Comparison<'_> {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        self.compare_until(start_s + motion.h(), |t| {
            motion.position(((t - start_s) / motion.h()).clamp(0.0, 1.0))
        });
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.compare_until(to_s, |_| [0.0, 0.0]);
    }

    fn ended(&mut self, _: f64, _: Contact, theta: Pair) {
        // A wall that collapsed stays at the rotation it collapsed at.
        if !self.seen_enough() {
            self.compare_until(f64::INFINITY, |_| theta);
        }
    }

    fn seen_enough(&self) -> bool {
        self.wme > self.most_wme
    }
}

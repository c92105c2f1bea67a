//! A run at the times of a measurement.

use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::Observer;
use mrbd_kernel::solver::Quintic;

/// Takes rotations and contact states at given times, s, as far as the run goes.
#[derive(Debug)]
pub struct Sampled<'t> {
    times: &'t [f64],
    /// Rotations as they are, rad, and the state they are in.
    pub rows: Vec<(Pair, Contact)>,
}

impl<'t> Sampled<'t> {
    /// Takes nothing yet.
    pub fn at(times: &'t [f64]) -> Self {
        Self { times, rows: Vec::with_capacity(times.len()) }
    }

    fn until(&mut self, end_s: f64, contact: Contact, theta_at: impl Fn(f64) -> Pair) {
        while let Some(&t) = self.times.get(self.rows.len()).filter(|t| **t < end_s) {
            self.rows.push((theta_at(t), contact));
        }
    }
}

impl Observer for Sampled<'_> {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        let share = |t: f64| ((t - start_s) / motion.h()).clamp(0.0, 1.0);
        self.until(start_s + motion.h(), contact, |t| motion.position(share(t)));
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.until(to_s, Contact::REST, |_| [0.0; 2]);
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        // The last sample may be the end; what was measured after a collapse has no counterpart.
        self.until(time_s + 1e-9, contact, |_| theta);
    }
}

//! Rotations of a run at the times of a measurement.

use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::Observer;
use mrbd_kernel::solver::Quintic;

/// What wants the rotations of a run at times that increase.
pub trait Sink {
    /// The next time, s; `None` after the last.
    fn next_s(&self) -> Option<f64>;

    /// Takes rotations, rad, and the contact state at the next time.
    fn take(&mut self, theta_rad: Pair, contact: Contact);

    /// Whether times after the end of a run have the rotations it ended with; otherwise they have none.
    fn rests_where_it_ended(&self) -> bool;

    /// Whether the rest of the run is not worth its time.
    fn seen_enough(&self) -> bool {
        false
    }
}

/// Watches a run for a sink.
#[derive(Debug)]
pub struct AtTimes<S>(pub S);

/// A last sample this much after the end of a run, s, lies on it: times are sums of roundings.
const ON_END_S: f64 = 1e-9;

impl<S: Sink> AtTimes<S> {
    fn until(&mut self, end_s: f64, contact: Contact, theta_at: impl Fn(f64) -> Pair) {
        while let Some(time_s) = self.0.next_s().filter(|time_s| *time_s < end_s) {
            self.0.take(theta_at(time_s), contact);
        }
    }
}

impl<S: Sink> Observer for AtTimes<S> {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        let share = |time_s: f64| ((time_s - start_s) / motion.h()).clamp(0.0, 1.0);
        self.until(start_s + motion.h(), contact, |time_s| motion.sampled(share(time_s)));
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.until(to_s, Contact::REST, |_| [0.0; 2]);
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        if !self.0.seen_enough() {
            let end_s = if self.0.rests_where_it_ended() { f64::INFINITY } else { time_s + ON_END_S };
            self.until(end_s, contact, |_| theta);
        }
    }

    fn wants_from_s(&self) -> f64 {
        // Whether it has seen enough is asked at every sample of the record.
        if self.0.seen_enough() { f64::NEG_INFINITY } else { self.0.next_s().unwrap_or(f64::INFINITY) }
    }

    fn seen_enough(&self) -> bool {
        self.0.seen_enough()
    }
}

/// Rotations and contact states of a run at given times.
pub type Sampled<'t> = AtTimes<Rows<'t>>;

/// The rows of [`Sampled`].
#[derive(Debug)]
pub struct Rows<'t> {
    times_s: &'t [f64],
    rows: Vec<(Pair, Contact)>,
    rests_where_it_ended: bool,
}

impl<'t> Sampled<'t> {
    /// At these times, s, as far as the run goes: what was measured after a collapse has no counterpart.
    pub fn at(times_s: &'t [f64]) -> Self {
        AtTimes(Rows { times_s, rows: Vec::with_capacity(times_s.len()), rests_where_it_ended: false })
    }

    /// At all of these times, s: a wall that collapsed stays where it fell.
    pub fn at_all(times_s: &'t [f64]) -> Self {
        AtTimes(Rows { rests_where_it_ended: true, ..Self::at(times_s).0 })
    }

    /// Rotations as they are, rad, and the state they are in, one row a time.
    pub fn rows(&self) -> &[(Pair, Contact)] {
        &self.0.rows
    }
}

impl Sink for Rows<'_> {
    fn next_s(&self) -> Option<f64> {
        self.times_s.get(self.rows.len()).copied()
    }

    fn take(&mut self, theta_rad: Pair, contact: Contact) {
        self.rows.push((theta_rad, contact));
    }

    fn rests_where_it_ended(&self) -> bool {
        self.rests_where_it_ended
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall that stands for a second and then lies at half a radian.
    fn fallen(mut sampled: Sampled) -> Vec<Pair> {
        sampled.stood(0.0, 1.0);
        sampled.ended(1.5, Contact::of_rotations([0.5; 2]), [0.5; 2]);
        sampled.rows().iter().map(|(theta, _)| *theta).collect()
    }

    #[test]
    fn analytic_after_the_end_of_a_run_there_is_nothing_or_where_it_ended() {
        let times_s = [0.0, 0.5, 1.5, 2.0];
        assert_eq!(fallen(Sampled::at(&times_s)), [[0.0; 2], [0.0; 2], [0.5; 2]]);
        assert_eq!(fallen(Sampled::at_all(&times_s)), [[0.0; 2], [0.0; 2], [0.5; 2], [0.5; 2]]);
    }
}

//! A test in segments that start anew from the measured motion.
//!
//! A free-running impact system forgets. After some impacts a small error of a coefficient, or of the model, is a
//! large one of the motion. So Eq. 8 over a whole test is a rough function with many local minima. Each segment
//! starts from the measured motion just before some impacts. Its error tells of these alone, and the sum over all
//! segments is smooth.
//!
//! These are not the windows of a diagnosis ([`super::Window`]): those need noise and even sampling, and their states
//! are fitted with every hypothesis. A search by Eq. 8 must also serve a sparse measurement and one without noise. So
//! a segment starts in a stretch in which the sign of every opening is plain. It starts at a state from which the
//! model itself passes through that stretch.

use nalgebra::{DMatrix, DVector};

use super::carried::{carried_along, top_path};
use super::misfit::{Sample, Target};
use super::pattern::Freedom;
use super::rotations::Sampled;
use crate::least_squares::newton_step;
use mrbd_kernel::model::{CarriedStates, Contact, Pair, Pivot, RockingWall, State};
use mrbd_kernel::simulate::{Outcome, Simulator, Start};

/// An opening counts as one when it is this many standard deviations of the noise.
const CLEAR: f64 = 3.0;
/// Least opening that counts as one where there is no noise, rad.
const LEAST_OPENING_RAD: f64 = 1e-6;
/// Shortest stretch, s: a joint that only passes through zero is within the noise for less.
const SHORTEST_S: f64 = 0.06;
/// Length at the end of a stretch that is used, s: longer ones tell its velocity no better than the model does.
const LONGEST_S: f64 = 0.25;
/// Gauss-Newton steps: the motion is nearly linear in its start over a quarter of a second.
const STEPS: usize = 3;
/// Steps of the differences for the Jacobian: rad and rad/s, small beside rotations of a hundredth.
const DELTA: [f64; 2] = [1e-6, 1e-5];
/// The model passes through the samples when what is left is within this many standard deviations of the noise ...
const NOISE_LEFT: f64 = 1.5;
/// ... or this share of the rotations.
const SHARE_LEFT: f64 = 0.005;

/// A part of a test that is simulated in one go.
#[derive(Debug, Clone)]
pub(crate) struct Segment {
    /// Where it starts; `None`: with the run itself, from rest.
    pub start: Option<Start>,
    pub end_s: f64,
    pub samples: Vec<Sample>,
}

impl Segment {
    /// The whole of a test.
    pub fn whole(target: &Target) -> Self {
        Self { start: None, end_s: target.end_s(), samples: target.samples().to_vec() }
    }
}

/// Segments from each stretch without impacts to the end of the next; the first starts from rest, as the test did.
///
/// The simulator is of a wall whose motion between impacts is that of the measured one.
pub(crate) fn segments(target: &Target, simulator: &Simulator) -> Vec<Segment> {
    let samples = target.samples();
    let noise_rad = target.noise_rad();
    let carried = carried_by_sample(samples, simulator.wall());
    let start = |stretch: Stretch| {
        let part = &samples[stretch.first..stretch.end];
        let carried = carried.get(stretch.first).copied();
        let fit = StartFit { carried, ..StartFit::new(simulator, part, stretch.contact, noise_rad) };
        fit.start().map(|start| (start, stretch))
    };
    let starts =
        stretches(samples, noise_rad, target.gap_s()).into_iter().filter_map(start).collect::<Vec<_>>();
    // Number k starts at the k-th stretch, number 0 from rest.
    let first = |k: usize| k.checked_sub(1).map_or(0, |k| starts[k].1.first);
    let end = |k: usize| starts.get(k.wrapping_sub(1)).map_or(samples.len(), |(_, stretch)| stretch.end);
    let segment = |k: usize| {
        let part = &samples[first(k)..end(k + 1)];
        let end_s = part.last().map_or(0.0, |s| s.time_s);
        Segment { start: k.checked_sub(1).map(|k| starts[k].0), end_s, samples: part.to_vec() }
    };
    (0..=starts.len()).map(segment).filter(|segment| segment.samples.len() >= 2).collect()
}

/// The carried states of the formulas of a wall along the measured motion, by sample; empty where there are none.
fn carried_by_sample(samples: &[Sample], wall: &RockingWall) -> Vec<CarriedStates> {
    if !wall.carries() {
        return Vec::new();
    }
    let motion = samples.iter().map(|sample| (sample.time_s, sample.theta_rad));
    carried_along(&top_path(motion, wall), wall)
}

/// A stretch, by the numbers of its first sample and the one after its last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stretch {
    pub first: usize,
    pub end: usize,
    pub contact: Contact,
}

/// The stretches of a measurement, in order, each cut to its last quarter of a second; empty if a channel is lost.
fn stretches(samples: &[Sample], noise_rad: Pair, gap_s: f64) -> Vec<Stretch> {
    let contact = |s: &Sample| contact(s, noise_rad);
    let together = |k: usize| {
        let (a, b) = (&samples[k - 1], &samples[k]);
        contact(a) == contact(b) && b.time_s - a.time_s <= gap_s
    };
    let mut found = Vec::new();
    let mut first = 0;
    for end in 1..=samples.len() {
        if end < samples.len() && together(end) {
            continue;
        }
        let last_s = samples[end - 1].time_s;
        if let Some(contact) =
            contact(&samples[first]).filter(|_| last_s - samples[first].time_s >= SHORTEST_S)
        {
            let used = samples[first..end].partition_point(|s| s.time_s < last_s - LONGEST_S);
            found.push(Stretch { first: first + used, end, contact });
        }
        first = end;
    }
    found
}

/// The contact state a sample shows; `None` where a channel is missing.
fn contact(s: &Sample, noise_rad: Pair) -> Option<Contact> {
    let pivot = |opening: f64, noise: f64| {
        let clear = opening.abs() > (CLEAR * noise).max(LEAST_OPENING_RAD);
        if clear { Pivot::of_angle(opening) } else { Pivot::Closed }
    };
    let [noise_1, noise_2] = noise_rad;
    let present = s.weight_s.iter().all(|weight| *weight > 0.0);
    present.then(|| Contact {
        ground: pivot(s.theta_rad[0], noise_1),
        crack: pivot(s.theta_rad[1] - s.theta_rad[0], noise_1.hypot(noise_2)),
    })
}

/// The state at the first of some samples: the one from which the model passes through them.
///
/// Between impacts the motion does not depend on any C_l. So samples without impacts tell it far better than their
/// differences would: least squares by Gauss and Newton over the model's own motion.
struct StartFit<'a> {
    simulator: &'a Simulator,
    samples: &'a [Sample],
    times_s: Vec<f64>,
    contact: Contact,
    noise_rad: Pair,
    /// The carried states of formulas there.
    carried: Option<CarriedStates>,
}

impl<'a> StartFit<'a> {
    fn new(simulator: &'a Simulator, samples: &'a [Sample], contact: Contact, noise_rad: Pair) -> Self {
        let times_s = samples.iter().map(|sample| sample.time_s).collect();
        Self { simulator, samples, times_s, contact, noise_rad, carried: None }
    }

    /// The start; `None` where the model does not pass through the samples.
    fn start(&self) -> Option<Start> {
        let freedom = Freedom::of(self.contact);
        let mut x = self.guess(freedom);
        if x.is_empty() {
            return Some(self.start_in(freedom.state(&x).0));
        }
        for _ in 0..STEPS {
            x = self.step(freedom, &x)?;
        }
        let state = freedom.state(&x).0;
        let left = self.residuals(&state)?;
        let rms = |sum: f64| (sum / (2.0 * self.samples.len() as f64)).sqrt();
        let rotations = self.samples.iter().map(|s| s.theta_rad[0].powi(2) + s.theta_rad[1].powi(2));
        let noise = (0.5 * (self.noise_rad[0].powi(2) + self.noise_rad[1].powi(2))).sqrt();
        let allowed = (NOISE_LEFT * noise).max(SHARE_LEFT * rms(rotations.sum::<f64>()));
        (rms(left.norm_squared()) <= allowed).then(|| self.start_in(state))
    }

    fn start_in(&self, state: State) -> Start {
        let time_s = self.times_s.first().copied().unwrap_or(0.0);
        Start { time_s, state, contact: Some(self.contact), carried: self.carried, ..Start::default() }
    }

    /// The first sample, and the slope to the last.
    fn guess(&self, freedom: Freedom) -> Vec<f64> {
        let (Some(a), Some(b)) = (self.samples.first(), self.samples.last()) else {
            return vec![0.0; freedom.numbers()];
        };
        let slope = [0, 1].map(|i| (b.theta_rad[i] - a.theta_rad[i]) / (b.time_s - a.time_s));
        freedom.numbers_of(a.theta_rad, slope)
    }

    fn step(&self, freedom: Freedom, x: &[f64]) -> Option<Vec<f64>> {
        let residuals = |x: &[f64]| self.residuals(&freedom.state(x).0);
        let now = residuals(x)?;
        let column = |k: usize| {
            let delta = DELTA[k % 2];
            let mut moved = x.to_vec();
            moved[k] += delta;
            Some((residuals(&moved)? - &now) / delta)
        };
        let columns = (0..x.len()).map(column).collect::<Option<Vec<_>>>()?;
        let change = newton_step(&DMatrix::from_columns(&columns), &now)?;
        Some(x.iter().zip(change.iter()).map(|(x, change)| x + change).collect())
    }

    /// Simulated less measured rotations; `None` where the run fails, or the state is not of the contact state.
    fn residuals(&self, state: &State) -> Option<DVector<f64>> {
        if Contact::of_rotations(state.theta) != self.contact {
            return None;
        }
        let reading = self.simulator.wall().wall().reading();
        let mut sampled = Sampled::at_all(&self.times_s);
        let end_s = self.times_s.last().copied().unwrap_or(0.0);
        let run = self.simulator.run_from(&self.start_in(*state), end_s, &mut sampled);
        let finished = run.outcome == Outcome::Stood && sampled.rows().len() == self.samples.len();
        let apart = |((theta, _), measured): (&(Pair, Contact), &Sample)| {
            let theta = reading.of(*theta);
            [0, 1].map(|i| theta[i] - measured.theta_rad[i])
        };
        let residuals = sampled.rows().iter().zip(self.samples).flat_map(apart);
        finished.then(|| DVector::from_iterator(2 * self.samples.len(), residuals))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(k: usize, theta_rad: Pair) -> Sample {
        Sample { time_s: 0.01 * k as f64, theta_rad, weight_s: [0.01, 0.01], block: 0 }
    }

    #[test]
    fn analytic_stretches_end_where_a_joint_changes_sides() {
        // Half a second in pattern 3a, half a second in 1a, a crossing of the ground in three samples, then 3b.
        let theta = |k: usize| match k {
            0..50 => [0.01, 0.01],
            50..100 => [0.01, 0.02],
            100..103 => [0.0, 0.02],
            _ => [-0.01, -0.01],
        };
        let samples = (0..200).map(|k| sample(k, theta(k))).collect::<Vec<_>>();
        let found = stretches(&samples, [0.0, 0.0], 0.025);
        let ends = found.iter().map(|s| (s.first, s.end, s.contact.name())).collect::<Vec<_>>();
        // A quarter of a second at the end of each: 26 samples.
        assert_eq!(ends, [(24, 50, "3a"), (74, 100, "1a"), (174, 200, "3b")]);
    }
}

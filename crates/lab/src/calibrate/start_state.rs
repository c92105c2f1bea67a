//! The motion at the start of a window: rotations and velocities from which the model passes through the samples.
//!
//! Between impacts the motion does not depend on any C_l, so a short stretch of samples without impacts tells the state at
//! its start far better than differences of samples would: least squares by Gauss and Newton over the model's own motion.

use nalgebra::{DMatrix, DVector};

use super::misfit::Sample;
use mrbd_kernel::model::{Contact, Pair, Reading, State};
use mrbd_kernel::simulate::{Observer, Outcome, Simulator, Start};
use mrbd_kernel::solver::Quintic;

/// Gauss-Newton steps: the motion is nearly linear in its start over a quarter of a second.
const STEPS: usize = 3;
/// Steps of the differences for the Jacobian: rad and rad/s, small beside rotations of a hundredth.
const DELTA: [f64; 2] = [1e-6, 1e-5];
/// The model passes through the samples when what is left is within this many standard deviations of the noise ...
const NOISE_LEFT: f64 = 1.5;
/// ... or this share of the rotations.
const SHARE_LEFT: f64 = 0.005;

/// A stretch of samples; the window starts at its first.
pub(super) struct StartFit<'a> {
    pub simulator: &'a Simulator,
    pub samples: &'a [Sample],
    pub contact: Contact,
    pub noise_rad: Pair,
}

impl StartFit<'_> {
    /// The start; none where the model does not pass through the samples.
    pub fn start(&self) -> Option<Start> {
        let free = self.free();
        let mut state = self.guess();
        if free.is_empty() {
            return Some(self.start_in(state));
        }
        for _ in 0..STEPS {
            state = self.step(&state, &free)?;
        }
        let left = self.residuals(&state)?;
        let rms = |sum: f64| (sum / (2.0 * self.samples.len() as f64)).sqrt();
        let rotations = self.samples.iter().map(|s| s.theta_rad[0].powi(2) + s.theta_rad[1].powi(2));
        let noise = (0.5 * (self.noise_rad[0].powi(2) + self.noise_rad[1].powi(2))).sqrt();
        let allowed = (NOISE_LEFT * noise).max(SHARE_LEFT * rms(rotations.sum::<f64>()));
        (rms(left.norm_squared()) <= allowed).then(|| self.start_in(state))
    }

    fn start_in(&self, state: State) -> Start {
        let time_s = self.samples.first().map_or(0.0, |s| s.time_s);
        Start { time_s, state, contact: Some(self.contact), ..Start::default() }
    }

    /// Ways to move that the contact state leaves: which rotations change together.
    fn free(&self) -> Vec<Pair> {
        match (self.contact.ground.is_open(), self.contact.crack.is_open()) {
            (false, false) => Vec::new(),
            (false, true) => vec![[0.0, 1.0]],
            (true, false) => vec![[1.0, 1.0]],
            (true, true) => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }

    fn guess(&self) -> State {
        let (Some(a), Some(b)) = (self.samples.first(), self.samples.last()) else {
            return State { theta: [0.0; 2], omega: [0.0; 2] };
        };
        let slope = [0, 1].map(|i| (b.theta_rad[i] - a.theta_rad[i]) / (b.time_s - a.time_s));
        let [ground, crack] = [self.contact.ground.is_open(), self.contact.crack.is_open()];
        let allowed = |x: Pair| {
            let lower = match (ground, crack) {
                (false, _) => 0.0,
                (true, false) => 0.5 * (x[0] + x[1]),
                (true, true) => x[0],
            };
            [lower, if crack { x[1] } else { lower }]
        };
        State { theta: allowed(a.theta_rad), omega: allowed(slope) }
    }

    fn step(&self, state: &State, free: &[Pair]) -> Option<State> {
        let residuals = self.residuals(state)?;
        let mut columns = Vec::new();
        for way in free {
            for (kind, delta) in DELTA.iter().enumerate() {
                let change = if kind == 0 { [*delta, 0.0] } else { [0.0, *delta] };
                columns.push((self.residuals(&moved(state, way, change))? - &residuals) / *delta);
            }
        }
        let jacobian = DMatrix::from_columns(&columns);
        let normal = jacobian.transpose() * &jacobian;
        let change = normal.cholesky()?.solve(&(jacobian.transpose() * -residuals));
        let next = free
            .iter()
            .enumerate()
            .fold(*state, |s, (k, way)| moved(&s, way, [change[2 * k], change[2 * k + 1]]));
        Some(next)
    }

    /// Simulated less measured rotations; none where the run fails, or the state is not of the contact state.
    fn residuals(&self, state: &State) -> Option<DVector<f64>> {
        if Contact::of_rotations(state.theta) != self.contact {
            return None;
        }
        let reading = self.simulator.wall().wall().reading();
        let mut sampled = Sampled { samples: self.samples, reading, residuals: Vec::new() };
        let end_s = self.samples.last().map_or(0.0, |s| s.time_s);
        let run = self.simulator.run_from(&self.start_in(*state), end_s, &mut sampled);
        let finished = run.outcome == Outcome::Stood && sampled.residuals.len() == 2 * self.samples.len();
        finished.then(|| DVector::from_vec(sampled.residuals))
    }
}

fn moved(state: &State, way: &Pair, [theta, omega]: Pair) -> State {
    State {
        theta: [0, 1].map(|i| state.theta[i] + theta * way[i]),
        omega: [0, 1].map(|i| state.omega[i] + omega * way[i]),
    }
}

/// Simulated less measured rotations at the samples.
struct Sampled<'a> {
    samples: &'a [Sample],
    reading: Reading,
    residuals: Vec<f64>,
}

impl Sampled<'_> {
    fn until(&mut self, end_s: f64, theta_at: impl Fn(f64) -> Pair) {
        while let Some(s) = self.samples.get(self.residuals.len() / 2).filter(|s| s.time_s < end_s) {
            let theta = self.reading.of(theta_at(s.time_s));
            self.residuals.extend([0, 1].map(|i| theta[i] - s.theta_rad[i]));
        }
    }
}

impl Observer for Sampled<'_> {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        let share = |t: f64| ((t - start_s) / motion.h()).clamp(0.0, 1.0);
        self.until(start_s + motion.h(), |t| motion.position(share(t)));
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.until(to_s, |_| [0.0, 0.0]);
    }

    fn ended(&mut self, _: f64, _: Contact, theta: Pair) {
        self.until(f64::INFINITY, |_| theta);
    }

    fn seen_enough(&self) -> bool {
        self.residuals.len() == 2 * self.samples.len()
    }
}

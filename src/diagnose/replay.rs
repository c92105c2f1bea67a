//! A window simulated from a state, against what was measured in it.

use nalgebra::DVector;

use super::hypothesis::Physics;
use super::memory::SpringMemory;
use super::test_data::TestData;
use super::windows::Window;
use crate::model::{Contact, Pair};
use crate::simulate::{Accuracy, Observer, Response, Shaking, Simulator, Start};
use crate::solver::Quintic;

/// Accuracy of windows: far below any noise, over a second.
const ACCURACY: Accuracy = Accuracy { tolerance: 1e-6 };

/// All tests under one hypothesis, ready for their windows.
#[derive(Debug)]
pub struct Replay<'a> {
    tests: &'a [TestData],
    simulators: Vec<Simulator>,
    /// By test.
    springs: Vec<SpringMemory>,
}

impl<'a> Replay<'a> {
    /// Makes the wall of a hypothesis ready under every test.
    pub fn new(tests: &'a [TestData], physics: &Physics) -> Self {
        let simulator = |test: &TestData| {
            let shaking = shaken(&test.shaking, physics.reversed_ratio);
            Simulator::new(&physics.wall, &shaking, ACCURACY)
        };
        let simulators = tests.iter().map(simulator).collect::<Vec<_>>();
        let springs = tests.iter().map(|test| SpringMemory::new(test, physics)).collect();
        Self { tests, simulators, springs }
    }

    /// Measured less simulated rotations over the noise, θ_1 and θ_2 of each sample in turn; zero where none was
    /// measured.
    pub fn residual(&self, window: &Window, x: &[f64]) -> DVector<f64> {
        let test = &self.tests[window.test];
        let simulator = &self.simulators[window.test];
        let from = window.samples.start;
        let times = &test.time_s[window.samples.clone()];
        let mut sampler = Sampler { times, theta: Vec::with_capacity(times.len()) };
        self.run(window, x, &mut sampler);
        // A run that failed says nothing of what came after.
        sampler.theta.resize(times.len(), [f64::NAN; 2]);
        let reading = simulator.wall().wall().reading();
        let residual = |i: usize| {
            let (k, channel) = (i / 2, i % 2);
            let measured = test.theta_rad[from + k][channel];
            let simulated = reading.of(sampler.theta[k])[channel];
            let r = (measured - simulated) / test.noise_rad[channel];
            if r.is_finite() { r } else { 0.0 }
        };
        DVector::from_fn(2 * times.len(), |i, _| residual(i))
    }

    /// Runs a window from a state to its last sample.
    pub fn run(&self, window: &Window, x: &[f64], observer: &mut impl Observer) -> Response {
        let time_s = &self.tests[window.test].time_s;
        let (state, contact) = window.freedom.state(x);
        let from = window.samples.start;
        let simulator = &self.simulators[window.test];
        let plastic_displacement_m =
            self.springs[window.test].plastic_m(from, simulator.wall(), contact, state.theta);
        let start = Start { time_s: time_s[from], state, contact: Some(contact), plastic_displacement_m };
        simulator.run_from(&start, time_s[window.samples.end - 1], observer)
    }
}

/// The shaking with a share of the record backwards as vertical motion.
pub(super) fn shaken(shaking: &Shaking, reversed_ratio: f64) -> Shaking {
    let mut shaking = shaking.clone();
    if reversed_ratio != 0.0
        && let Some(record) = &shaking.horizontal
    {
        let vertical = shaking.vertical.as_ref().map_or(&[][..], |v| v.acceleration_m_s2());
        let own = vertical.iter().copied().chain(std::iter::repeat(0.0));
        let backwards = record.acceleration_m_s2().iter().rev().zip(own);
        let backwards = backwards.map(|(a, own)| own + reversed_ratio * a).collect();
        shaking.vertical = crate::ground::Accelerogram::new(record.step_s(), backwards).ok();
    }
    shaking
}

/// Takes the rotations at given times, s.
struct Sampler<'t> {
    times: &'t [f64],
    theta: Vec<Pair>,
}

impl Sampler<'_> {
    fn until(&mut self, end_s: f64, theta_at: impl Fn(f64) -> Pair) {
        while let Some(&t) = self.times.get(self.theta.len()).filter(|t| **t < end_s) {
            self.theta.push(theta_at(t));
        }
    }
}

impl Observer for Sampler<'_> {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        self.until(start_s + motion.h(), |t| motion.position(((t - start_s) / motion.h()).clamp(0.0, 1.0)));
    }

    fn stood(&mut self, _: f64, to_s: f64) {
        self.until(to_s, |_| [0.0; 2]);
    }

    fn ended(&mut self, _: f64, _: Contact, theta: Pair) {
        // A collapsed wall stays where it fell; roundings of the last time are the same place.
        self.until(f64::INFINITY, |_| theta);
    }
}

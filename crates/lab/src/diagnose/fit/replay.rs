//! A window simulated from a state, against what was measured in it.

use nalgebra::DVector;

use super::memory::SpringMemory;
use crate::diagnose::hypothesis::Physics;
use crate::diagnose::measured::{TestData, Window};
use crate::experiment::Sampled;
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Prepared, Response, Shaking, Simulator, Start, simulate_watched_side_by_side,
};

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

    /// Measured less simulated rotations of windows, each from a state, over the noise: θ_1 and θ_2 of each sample in turn; zero
    /// where none was measured. Simulated side by side, which changes nothing but the time it takes.
    pub fn residuals(&self, asked: &[(&Window, &[f64])]) -> Vec<DVector<f64>> {
        let sampled = |(window, _): &(&Window, &[f64])| {
            Sampled::at_all(&self.tests[window.test].time_s[window.samples.clone()])
        };
        let mut runs = asked.iter().map(sampled).collect::<Vec<_>>();
        let mut waiting = asked.iter().zip(&mut runs);
        let mut next = || waiting.next().map(|((window, x), sampled)| (0, self.prepared(window, x, sampled)));
        simulate_watched_side_by_side(&mut next, &mut |_, _| ());
        asked.iter().zip(&runs).map(|((window, _), sampled)| self.left(window, sampled)).collect()
    }

    /// The same of one window.
    pub fn residual(&self, window: &Window, x: &[f64]) -> DVector<f64> {
        self.residuals(&[(window, x)]).swap_remove(0)
    }

    /// Runs a window from a state to its last sample.
    pub fn run(&self, window: &Window, x: &[f64], observer: &mut dyn Observer) -> Response {
        let (start, end_s) = self.ends(window, x);
        self.simulators[window.test].run_from(&start, end_s, observer)
    }

    fn prepared<'o>(
        &self,
        window: &Window,
        x: &[f64],
        observer: &'o mut dyn Observer,
    ) -> Prepared<&'o mut dyn Observer> {
        let (start, end_s) = self.ends(window, x);
        self.simulators[window.test].watched_from(&start, end_s, observer)
    }

    /// Where a window starts from a state, and its end, s.
    fn ends(&self, window: &Window, x: &[f64]) -> (Start, f64) {
        let time_s = &self.tests[window.test].time_s;
        let (state, contact) = window.freedom.state(x);
        let from = window.samples.start;
        let wall = self.simulators[window.test].wall();
        let plastic_displacement_m = self.springs[window.test].plastic_m(from, wall, contact, state.theta);
        let start = Start { time_s: time_s[from], state, contact: Some(contact), plastic_displacement_m };
        (start, time_s[window.samples.end - 1])
    }

    /// What a simulated window leaves of the measured one.
    fn left(&self, window: &Window, sampled: &Sampled) -> DVector<f64> {
        let test = &self.tests[window.test];
        let reading = self.simulators[window.test].wall().wall().reading();
        let measured = &test.theta_rad[window.samples.clone()];
        let of = |(measured, (simulated, _)): (&Pair, &(Pair, Contact))| {
            let simulated = reading.of(*simulated);
            [0, 1]
                .map(|i| (measured[i] - simulated[i]) / test.noise_rad[i])
                .map(|r| if r.is_finite() { r } else { 0.0 })
        };
        DVector::from_iterator(2 * measured.len(), measured.iter().zip(sampled.rows()).flat_map(of))
    }
}

/// The shaking with a share of the record backwards as vertical motion.
pub fn shaken(shaking: &Shaking, reversed_ratio: f64) -> Shaking {
    let mut shaking = shaking.clone();
    if reversed_ratio != 0.0
        && let Some(record) = &shaking.horizontal
    {
        let vertical = shaking.vertical.as_ref().map_or(&[][..], |v| v.acceleration_m_s2());
        let own = vertical.iter().copied().chain(std::iter::repeat(0.0));
        let backwards = record.acceleration_m_s2().iter().rev().zip(own);
        let backwards = backwards.map(|(a, own)| own + reversed_ratio * a).collect();
        shaking.vertical = mrbd_kernel::accelerogram::Accelerogram::new(record.step_s(), backwards).ok();
    }
    shaking
}

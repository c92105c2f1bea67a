//! A window simulated from a state, against what was measured in it.
//!
//! Where a spring at the top yields, its memory is part of that state. It is carried along the measured displacement of
//! the top. What is kept is how far the spring is stretched, not where its plastic displacement lies. A fitted state differs
//! from the measured one by noise. A spring so stiff that it yields within that noise would start at either limit by chance.

use crate::diagnose::hypothesis::Physics;
use crate::experiment::Sampled;
use crate::experiment::{TestData, Window};
use mrbd_kernel::model::{Contact, Effect, Pair, RockingWall, Role};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Prepared, Response, Shaking, Simulator, Start, simulate_watched_side_by_side,
};
use nalgebra::DVector;

/// Accuracy of windows: far below any noise, over a second.
const ACCURACY: Accuracy = Accuracy { tolerance: 1e-6 };

/// A window simulated from a state.
#[derive(Debug)]
pub struct Followed {
    /// Measured less simulated rotations over the noise. θ_1 and θ_2 of each sample stand in turn; zero where none was
    /// measured.
    pub r: DVector<f64>,
    /// Which changes of Table 2 occur: no other coefficient acts.
    pub changes: [bool; 8],
}

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

    /// Windows simulated from a state each, side by side, which changes nothing but the time it takes.
    pub fn followed(&self, asked: &[(&Window, &[f64])]) -> Vec<Followed> {
        let sampled = |(window, _): &(&Window, &[f64])| {
            Sampled::at_all(&self.tests[window.test].time_s[window.samples.clone()])
        };
        let mut runs = asked.iter().map(sampled).collect::<Vec<_>>();
        let mut changes = vec![[false; 8]; asked.len()];
        let mut waiting = asked.iter().zip(&mut runs).enumerate();
        let mut next =
            || waiting.next().map(|(k, ((window, x), sampled))| (k, self.prepared(window, x, sampled)));
        let mut done = |k: usize, run: Response| changes[k] = run.impacts.table2.map(|count| count > 0);
        simulate_watched_side_by_side(&mut next, &mut done);
        let left = asked.iter().zip(&runs).map(|((window, _), sampled)| self.left(window, sampled));
        left.zip(changes).map(|(r, changes)| Followed { r, changes }).collect()
    }

    /// The residuals of one window.
    pub fn residual(&self, window: &Window, x: &[f64]) -> DVector<f64> {
        self.followed(&[(window, x)]).swap_remove(0).r
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
        let contact = Some(contact);
        let start =
            Start { time_s: time_s[from], state, contact, plastic_displacement_m, ..Start::default() };
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

/// Stretch of a yielding spring along a test.
#[derive(Debug)]
pub struct SpringMemory {
    /// Elastic part of the displacement of the top, m, at every sample; empty without such a spring.
    elastic_m: Vec<f64>,
}

impl SpringMemory {
    /// Carries the spring of a wall along a test.
    pub fn new(test: &TestData, physics: &Physics) -> Self {
        let yields = |effect: &Effect| effect.entry().role == Role::Memory;
        if !physics.wall.parameters().effects.iter().any(yields) {
            return Self { elastic_m: Vec::new() };
        }
        let wall = RockingWall::new(&physics.wall);
        let (mut plastic_m, mut elastic_m) = (0.0, 0.0);
        let at = |k: usize| {
            let theta = smoothed(test, k);
            if theta.iter().all(|t| t.is_finite()) {
                let x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
                plastic_m = physics.wall.plastic_displacement_m(plastic_m, x_c);
                elastic_m = x_c - plastic_m;
            }
            elastic_m
        };
        Self { elastic_m: (0..test.theta_rad.len()).map(at).collect() }
    }

    /// Plastic displacement at a sample, m, of a wall that is there in a state like the measured one; 0 without a spring.
    pub fn plastic_m(&self, k: usize, wall: &RockingWall, contact: Contact, theta: Pair) -> f64 {
        self.elastic_m.get(k).map_or(0.0, |elastic_m| wall.top_displacement_m(contact, theta) - elastic_m)
    }
}

/// The mean of five samples: less noise, and no swing is shorter.
fn smoothed(test: &TestData, k: usize) -> Pair {
    let around = k.saturating_sub(2)..(k + 3).min(test.theta_rad.len());
    let count = around.len() as f64;
    [0, 1].map(|channel| around.clone().map(|k| test.from_rest_rad(k)[channel]).sum::<f64>() / count)
}

#[cfg(test)]
pub(super) mod tests {
    use std::path::Path;

    use super::*;
    use crate::experiment_file::Purpose;
    use mrbd_files::parse_wall;
    use mrbd_kernel::simulate::Shaking;

    /// Sways to 0.01 rad to either side, in pattern 3; a spring that yields after 0.01 mm.
    pub fn swaying() -> (TestData, Physics) {
        let text = include_str!("../../../../../src/cli/starter/wall.toml");
        let spring =
            "[[effects]]\nkind = \"yielding_spring\"\nstiffness_n_per_m = 3e7\nyield_force_n = 300.0\n";
        let wall = parse_wall(Path::new("wall.toml"), &format!("{text}\n{spring}")).expect("a wall");
        let test = TestData {
            name: "swaying".to_owned(),
            purpose: Purpose::Fit,
            shaking: Shaking { tail_s: 1.0, ..Shaking::default() },
            time_s: (0..200).map(|k| 0.005 * f64::from(k)).collect(),
            theta_rad: (0..200).map(|k| [0.01 * (0.04 * f64::from(k)).sin(); 2]).collect(),
            noise_rad: [1e-5; 2],
            rest_offset_rad: [0.0; 2],
            read_gain: [1.0; 2],
            step_s: 0.005,
            gap_s: 0.0125,
        };
        (test, Physics { wall, reversed_ratio: 0.0 })
    }

    #[test]
    fn analytic_a_stiff_spring_pulls_against_the_motion_whatever_the_noise_of_a_state() {
        let (test, physics) = swaying();
        let memory = SpringMemory::new(&test, &physics);
        let wall = RockingWall::new(&physics.wall);
        // Far from where it turns, on the way out, back and out to the other side.
        for (k, way) in [(20, 1.0), (60, -1.0), (100, -1.0), (140, 1.0)] {
            for noise_rad in [-3e-5, 0.0, 3e-5] {
                let theta = test.theta_rad[k].map(|t| t + noise_rad);
                let contact = Contact::of_rotations(theta);
                let x_c = wall.top_displacement_m(contact, theta);
                let stretch_m = x_c - memory.plastic_m(k, &wall, contact, theta);
                // Differences of lengths of some millimetres, of which a rounding is 1e-18 m.
                assert!((stretch_m - way * 1e-5).abs() < 1e-15, "{stretch_m} at sample {k}");
            }
        }
    }

    #[test]
    fn analytic_a_coefficient_whose_change_does_not_occur_does_nothing() {
        let (test, physics) = swaying();
        let tests = [test];
        let windows = crate::experiment::windows(&tests);
        let with = |l: Option<usize>| {
            let mut p = physics.wall.parameters().clone();
            l.into_iter().for_each(|l| p.restitution.coefficients[l] *= 0.5);
            Physics { wall: mrbd_kernel::model::Wall::new(p).expect("a wall"), ..physics }
        };
        let asked = windows.iter().map(|window| (window, &window.measured[..])).collect::<Vec<_>>();
        let followed = |l: Option<usize>| Replay::new(&tests, &with(l)).followed(&asked);
        let as_given = followed(None);
        for l in 0..8 {
            for (one, other) in as_given.iter().zip(followed(Some(l))) {
                assert_eq!(one.r == other.r, !one.changes[l], "C_{}", l + 1);
            }
        }
        let occurs = as_given.iter().flat_map(|window| window.changes).filter(|occurs| *occurs);
        assert!(occurs.count() > 0, "no impact in {} windows", windows.len());
    }

    #[test]
    fn analytic_without_a_spring_nothing_is_remembered() {
        let (test, physics) = swaying();
        let mut parameters = physics.wall.parameters().clone();
        parameters.effects.clear();
        let wall = mrbd_kernel::model::Wall::new(parameters).expect("the wall without its spring");
        let memory = SpringMemory::new(&test, &Physics { wall, ..physics });
        assert_eq!(memory.plastic_m(60, &RockingWall::new(&swaying().1.wall), Contact::REST, [0.01; 2]), 0.0);
    }
}

//! A window simulated from a state, against what was measured in it.
//!
//! Where laws at the top have a memory ([`TopPast`]), it is part of that state.

use super::{Budget, TopPast};
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{Freedom, Sampled, TestData, Window, held_state};
use mrbd_kernel::simulate::{
    Accuracy, Observer, Prepared, Response, Shaking, Simulator, Start, simulate_watched_side_by_side,
};
use nalgebra::DVector;

/// Accuracy of windows: far below any noise, over a second. Of 2 100 windows of five diagnoses, on sharp edges and on beds, at noises
/// from 1e-5 rad on, half are off by less than 1e-5 of the noise, 98 of a hundred by less than 0.005, and the worst by 0.02, whose
/// impacts magnify what is there before them. A hundred times as strict takes 1.05 to 2 times the steps.
const ACCURACY: Accuracy = Accuracy { tolerance: 1e-4 };

/// Steps that a window may try before it stays where it is. Of ten million windows of twelve diagnoses, with laws of every kind and
/// with beds, the longest took 57 000. A damper that goes with the 4.3rd power of velocity, tried in the place of a spring, took
/// steps without end.
const MOST_STEPS: u64 = 100_000;

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
    pasts: Vec<TopPast>,
    /// What its windows work is taken off here.
    budget: Option<&'a Budget>,
}

impl<'a> Replay<'a> {
    /// Makes the wall of a hypothesis ready under every test.
    pub fn new(tests: &'a [TestData], physics: &Physics) -> Self {
        let pasts = tests.iter().map(|test| TopPast::new(test, physics)).collect();
        Self { tests, simulators: simulators(tests, physics), pasts, budget: None }
    }

    /// The wall of another hypothesis, which may remember the same.
    pub fn near(&self, physics: &Physics) -> Self {
        let simulators = simulators(self.tests, physics);
        let pasts = self.tests.iter().zip(&self.pasts).map(|(test, past)| past.near(test, physics)).collect();
        Self { simulators, pasts, ..*self }
    }

    /// The same, its work counted.
    #[must_use]
    pub fn counted(self, budget: Option<&'a Budget>) -> Self {
        Self { budget, ..self }
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
        let mut done = |k: usize, run: Response| {
            if let Some(budget) = self.budget {
                budget.spend(run.work.evaluations);
            }
            changes[k] = run.impacts.table2.map(|count| count > 0);
        };
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

    /// Samples of a window run from a state before the first at which another contact holds than at its start.
    pub fn before_change(&self, window: &Window, x: &[f64]) -> usize {
        let mut sampled = Sampled::at_all(&self.tests[window.test].time_s[window.samples.clone()]);
        self.run(window, x, &mut sampled);
        let mut contacts = sampled.rows().iter().map(|(_, contact)| *contact).peekable();
        let first = contacts.peek().copied();
        contacts.take_while(|contact| Some(*contact) == first).count()
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
        let (mut state, contact) = window.freedom.state(x);
        let from = window.samples.start;
        let wall = self.simulators[window.test].wall();
        if window.freedom == Freedom::Held {
            state = held_state(wall, &state);
        }
        let memory = self.pasts[window.test].memory(from, wall, contact, state.theta);
        (Start::with_memory(time_s[from], state, contact, memory), time_s[window.samples.end - 1])
    }

    /// What a simulated window leaves of the measured one.
    fn left(&self, window: &Window, sampled: &Sampled) -> DVector<f64> {
        let test = &self.tests[window.test];
        let reading = self.simulators[window.test].wall().wall().reading();
        let measured = &test.theta_rad[window.samples.clone()];
        let mut r = DVector::zeros(2 * measured.len());
        for (k, (measured, (simulated, _))) in measured.iter().zip(sampled.rows()).enumerate() {
            let simulated = reading.of(*simulated);
            for i in 0..2 {
                let left = (measured[i] - simulated[i]) / test.noise_rad[i];
                r[2 * k + i] = if left.is_finite() { left } else { 0.0 };
            }
        }
        r
    }
}

/// The wall of a hypothesis under every test.
fn simulators(tests: &[TestData], physics: &Physics) -> Vec<Simulator> {
    let simulator = |test: &TestData| {
        let shaking = shaken(&test.shaking, physics.reversed_ratio);
        Simulator::new(&physics.wall, &shaking, ACCURACY).without_accounts().with_most_steps(MOST_STEPS)
    };
    tests.iter().map(simulator).collect()
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

#[cfg(test)]
pub(super) mod tests {
    use std::path::Path;

    use super::*;
    use crate::experiment_file::Purpose;
    use mrbd_files::parse_wall;
    use mrbd_kernel::simulate::{Outcome, Shaking};

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
            manner: crate::experiment::Manner::default(),
        };
        (test, Physics { wall, reversed_ratio: 0.0 })
    }

    #[test]
    fn analytic_a_window_is_whole_up_to_where_the_wall_passes_upright() {
        let (test, physics) = swaying();
        let tests = [test];
        let replay = Replay::new(&tests, &physics);
        let windows = crate::experiment::windows(&tests);
        let mut cut = 0;
        for window in &windows {
            let whole = window.samples.len();
            let before = replay.before_change(window, &window.measured);
            // The lower body turns about the same corner until its rotation changes sign; the spring moves no body by its sign.
            let mut sampled = Sampled::at_all(&tests[0].time_s[window.samples.clone()]);
            replay.run(window, &window.measured, &mut sampled);
            let signs = sampled.rows().iter().map(|(theta, _)| theta[0].signum()).collect::<Vec<_>>();
            assert!(signs[..before].iter().all(|sign| *sign == signs[0]), "{before} of {whole}");
            cut += usize::from(before < whole);
        }
        assert!(cut > 0, "no change of contact in {} windows", windows.len());
    }

    #[test]
    fn analytic_a_law_too_steep_to_be_followed_ends_its_window_where_it_is() {
        let (test, _) = swaying();
        let text = include_str!("../../../../../src/cli/starter/wall.toml");
        let law = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-c*v\"\n\
            parameters = { c = { value = 1e12, unit = \"N*s/m\" } }\n";
        let wall = parse_wall(Path::new("wall.toml"), &format!("{text}\n{law}")).expect("a wall");
        let tests = [test];
        let replay = Replay::new(&tests, &Physics { wall, reversed_ratio: 0.0 });
        let window = &crate::experiment::windows(&tests)[0];
        let run = replay.run(window, &window.measured, &mut ());
        assert!(matches!(run.outcome, Outcome::Failed { .. }), "{:?}", run.outcome);
        let left = replay.residual(window, &window.measured);
        assert!(left.iter().all(|r| r.is_finite()) && left.norm() > 100.0, "{}", left.norm());
    }

    #[test]
    fn analytic_windows_are_followed_far_more_accurately_than_they_were_measured() {
        let (test, physics) = swaying();
        let tests = [test];
        let replay = Replay::new(&tests, &physics);
        let strict = Accuracy { tolerance: 1e-11 };
        let strictly = Replay {
            simulators: replay.simulators.iter().map(|s| s.with_wall(&physics.wall, strict)).collect(),
            ..Replay::new(&tests, &physics)
        };
        let mut most = 0.0_f64;
        for window in &crate::experiment::windows(&tests) {
            let [r, exact] = [&replay, &strictly].map(|replay| replay.residual(window, &window.measured));
            most = most.max((r - exact).amax());
        }
        // The spring yields and the wall strikes. By tolerances of 1e-6, 1e-4 and 1e-3 it is 3e-6, 7e-5 and 3e-4.
        assert!(most > 0.0 && most < 2e-4, "{most}");
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
}

//! A window simulated from a state, against what was measured in it.
//!
//! Where laws at the top have a memory, it is part of that state. It is carried along the measured displacement of
//! the top. What is kept is how far the spring is stretched, not where its plastic displacement lies. A fitted state differs
//! from the measured one by noise. A spring so stiff that it yields within that noise would start at either limit by chance.
//!
//! Carried states of formulas are integrated along the measured displacement from the start of the test, at a steady velocity between
//! samples. That is approximate: the motion between samples is not steady, and at the start of a test nothing tells a state but what
//! the law says. What is forgotten fast matters little, and a state that keeps all is as wrong as the displacement is.

use super::Budget;
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{self, Freedom, Sampled, TestData, Window, carried_along, held_state};
use mrbd_formula::Formula;
use mrbd_kernel::model::{CarriedStates, Contact, Pair, RockingWall, Role, TopMemory};
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
        let simulator = |test: &TestData| {
            let shaking = shaken(&test.shaking, physics.reversed_ratio);
            Simulator::new(&physics.wall, &shaking, ACCURACY).without_accounts().with_most_steps(MOST_STEPS)
        };
        let simulators = tests.iter().map(simulator).collect::<Vec<_>>();
        let pasts = tests.iter().map(|test| TopPast::new(test, physics)).collect();
        Self { tests, simulators, pasts, budget: None }
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

/// What laws at the top keep of the past along a test.
#[derive(Debug)]
pub struct TopPast {
    /// Elastic part of the displacement of the top, m, at every sample; empty without a spring that yields.
    elastic_m: Vec<f64>,
    /// The largest displacement of the top so far, m; empty where no law depends on it.
    largest_m: Vec<f64>,
    /// The carried states of formulas; empty where there are none.
    carried: Vec<CarriedStates>,
}

impl TopPast {
    /// Carries the memory of the laws of a wall along a test.
    pub fn new(test: &TestData, physics: &Physics) -> Self {
        let p = physics.wall.parameters();
        let yields = p.effects.iter().any(|effect| effect.entry().role == Role::Memory);
        let remembers = p.formulas.iter().any(Formula::remembers);
        let carries = p.formulas.iter().any(|formula| !formula.states().is_empty());
        let (mut elastic_m, mut largest_m, mut carried) = (Vec::new(), Vec::new(), Vec::new());
        if yields || remembers || carries {
            let wall = RockingWall::new(&physics.wall);
            if yields {
                elastic_m = elastic_along_m(test, physics, &wall);
            }
            if remembers {
                largest_m = largest_so_far_m(test, &wall);
            }
            if carries {
                carried = carried_along(&top_path(test, &wall), &wall);
            }
        }
        Self { elastic_m, largest_m, carried }
    }

    /// The memory at a sample of a wall that is there in a state like the measured one.
    pub fn memory(&self, k: usize, wall: &RockingWall, contact: Contact, theta: Pair) -> TopMemory {
        let plastic = |elastic_m: &f64| wall.top_displacement_m(contact, theta) - elastic_m;
        TopMemory {
            carried: self.carried.get(k).copied(),
            plastic_m: self.elastic_m.get(k).map_or(0.0, plastic),
            largest_m: self.largest_m.get(k).copied().unwrap_or(0.0),
        }
    }
}

/// Elastic part of the displacement of a top with a spring that yields, m, at every sample of a test.
fn elastic_along_m(test: &TestData, physics: &Physics, wall: &RockingWall) -> Vec<f64> {
    let (mut plastic_m, mut elastic_m) = (0.0, 0.0);
    let smooth = smoothed(test, &MEAN);
    let at = |theta: Pair| {
        if theta.iter().all(|t| t.is_finite()) {
            let x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
            plastic_m = physics.wall.plastic_displacement_m(plastic_m, x_c);
            elastic_m = x_c - plastic_m;
        }
        elastic_m
    };
    smooth.into_iter().map(at).collect()
}

/// Times (s) and displacements of the top (m) of a test.
pub fn top_path(test: &TestData, wall: &RockingWall) -> Vec<[f64; 2]> {
    let times_s = test.time_s.iter().copied();
    experiment::top_path(times_s.zip(smoothed(test, &PARABOLA)), wall)
}

/// The largest displacement of the top so far, m, at every sample of a test.
pub fn largest_so_far_m(test: &TestData, wall: &RockingWall) -> Vec<f64> {
    let mut largest_m = 0.0_f64;
    let at = |theta: Pair| {
        if theta.iter().all(|t| t.is_finite()) {
            let x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
            largest_m = largest_m.max(x_c.abs());
        }
        largest_m
    };
    smoothed(test, &PARABOLA).into_iter().map(at).collect()
}

/// Weights of five samples: their mean, with less noise; no swing is shorter.
const MEAN: [f64; 5] = [1.0; 5];
/// The middle of the parabola through five samples (Savitzky and Golay), which does not cut the peak of a swing.
const PARABOLA: [f64; 5] = [-3.0, 12.0, 17.0, 12.0, -3.0];

/// Five samples of a test about each, with these weights. At its ends those that there are.
fn smoothed(test: &TestData, weights: &[f64; 5]) -> Vec<Pair> {
    let from_rest = (0..test.theta_rad.len()).map(|k| test.from_rest_rad(k)).collect::<Vec<_>>();
    let about = |k: usize| {
        let (mut theta, mut all) = ([0.0; 2], 0.0);
        for (i, weight) in weights.iter().enumerate() {
            if let Some([lower, upper]) = (k + i).checked_sub(2).and_then(|k| from_rest.get(k)) {
                theta = [theta[0] + weight * lower, theta[1] + weight * upper];
                all += weight;
            }
        }
        [theta[0] / all, theta[1] / all]
    };
    (0..from_rest.len()).map(about).collect()
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
    fn analytic_a_stiff_spring_pulls_against_the_motion_whatever_the_noise_of_a_state() {
        let (test, physics) = swaying();
        let memory = TopPast::new(&test, &physics);
        let wall = RockingWall::new(&physics.wall);
        // Far from where it turns, on the way out, back and out to the other side.
        for (k, way) in [(20, 1.0), (60, -1.0), (100, -1.0), (140, 1.0)] {
            for noise_rad in [-3e-5, 0.0, 3e-5] {
                let theta = test.theta_rad[k].map(|t| t + noise_rad);
                let contact = Contact::of_rotations(theta);
                let x_c = wall.top_displacement_m(contact, theta);
                let stretch_m = x_c - memory.memory(k, &wall, contact, theta).plastic_m;
                // Differences of lengths of some millimetres, of which a rounding is 1e-18 m.
                assert!((stretch_m - way * 1e-5).abs() < 1e-15, "{stretch_m} at sample {k}");
            }
        }
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

    #[test]
    fn analytic_a_carried_state_at_a_window_is_that_of_a_run_that_was_measured() {
        let law = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-z\"\n[effects.states.z]\n\
            rate = \"k*v - z/tau\"\nstart = 0.0\nunit = \"N\"\n[effects.parameters]\nk = { value = 4e5, unit = \"N/m\" }\n";
        let text = include_str!("../../../../../src/cli/starter/wall.toml");
        let (test, _) = swaying();
        for tau_s in [1e-4, 0.02, 0.3, 1e5] {
            let tau = format!("tau = {{ value = {tau_s}, unit = \"s\" }}\n");
            let wall = parse_wall(Path::new("wall.toml"), &format!("{text}\n{law}{tau}")).expect("a wall");
            let past = TopPast::new(&test, &Physics { wall: wall.clone(), reversed_ratio: 0.0 });
            let rocking = RockingWall::new(&wall);
            let x_c = |t: f64| {
                let theta = [0.01 * (8.0 * t).sin(); 2];
                rocking.top_displacement_m(Contact::of_rotations(theta), theta)
            };
            // By the classical method of Runge and Kutta over the exact motion, in parts of a twentieth of τ at most.
            let (parts, mut z, mut largest) = (2000, 0.0_f64, 0.0_f64);
            for k in 1..test.theta_rad.len() {
                let h = 0.005 / f64::from(parts);
                let from_s = 0.005 * (k - 1) as f64;
                for part in 0..parts {
                    let t = from_s + f64::from(part) * h;
                    let rate = |t: f64, z: f64| 4e5 * (x_c(t + 1e-6) - x_c(t - 1e-6)) / 2e-6 - z / tau_s;
                    let r1 = rate(t, z);
                    let r2 = rate(t + 0.5 * h, z + 0.5 * h * r1);
                    let r3 = rate(t + 0.5 * h, z + 0.5 * h * r2);
                    z += h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + rate(t + h, z + h * r3));
                }
                largest = largest.max(z.abs());
                let memory = past.memory(k, &rocking, Contact::REST, [0.0; 2]).carried.expect("a state");
                // The smoothing bends the ends of a test, of which a state forgets the first; a velocity is steady over a sample of a sway of 157.
                let ends = k < 20 || k > test.theta_rad.len() - 4;
                let off = (memory[0] - z).abs();
                assert!(ends || off < 0.03 * largest + 1e-9, "τ = {tau_s} s at {k}: {} for {z}", memory[0]);
            }
        }
    }

    #[test]
    fn analytic_without_a_spring_nothing_is_remembered() {
        let (test, physics) = swaying();
        let mut parameters = physics.wall.parameters().clone();
        parameters.effects.clear();
        let wall = mrbd_kernel::model::Wall::new(parameters).expect("the wall without its spring");
        let memory = TopPast::new(&test, &Physics { wall, ..physics });
        let none = memory.memory(60, &RockingWall::new(&swaying().1.wall), Contact::REST, [0.01; 2]);
        assert_eq!(none, TopMemory::default());
    }
}

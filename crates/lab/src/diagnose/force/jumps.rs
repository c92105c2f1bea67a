//! Velocities after impacts over those that the model gives from the states before them.
//!
//! The states come from stretches of a test in one contact state, smoothed sample by sample and clear of impacts.

use crate::diagnose::fit::{SpringMemory, shaken};
use crate::diagnose::hypothesis::Physics;
use crate::experiment::{Freedom, TestData, measured_state};
use mrbd_kernel::model::{Contact, Pair, RockingWall, State};
use mrbd_kernel::simulate::{Accuracy, Impacts, Observer, Simulator, Start};
use mrbd_kernel::solver::Quintic;
use rayon::prelude::*;

/// Samples in a row whose contact state is beyond doubt and the same.
#[derive(Debug, Clone)]
pub struct Stretch {
    /// The contact state.
    pub contact: Contact,
    /// What is free in it.
    pub freedom: Freedom,
    /// Its first sample.
    pub from: usize,
    /// Smoothed rotations and velocities of every sample.
    pub states: Vec<State>,
}

/// All stretches of a test in order, rest included.
pub fn stretches(test: &TestData) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    let mut joined = false;
    for k in 0..test.time_s.len() {
        let Some(measured) = measured_state(test, k) else {
            joined = false;
            continue;
        };
        let (state, contact) = measured.freedom.state(&measured.numbers);
        match all.last_mut().filter(|last| joined && last.contact == contact) {
            Some(last) => last.states.push(state),
            None => {
                all.push(Stretch { contact, freedom: measured.freedom, from: k, states: vec![state] });
            }
        }
        joined = true;
    }
    all
}

/// Longest stretch of doubt between two patterns that is taken for one impact or one burst, as a share of the wall's time
/// of response.
const LONGEST_DOUBT: f64 = 1.0;
/// Slowest motion after an impact, rad/s, in standard deviations of a smoothed velocity, that has a ratio.
const FAST: f64 = 10.0;
/// Samples by which a state is taken before the end of its stretch. At the end the smoothing may reach over the
/// impact by a kink too small to be seen.
const GUARD: usize = 4;
/// Standard deviation of a slope through 17 samples, in noises a sample.
const SLOPE_NOISE: f64 = 0.125;

/// A change of the measured pattern through one impact or a burst of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Jump {
    /// The test, by its place in the experiment.
    pub test: usize,
    /// When the pattern was first beyond doubt again, s.
    pub time_s: f64,
    /// Contact states before and after, as measured.
    pub contacts: [Contact; 2],
    /// Impacts of the model on the way.
    pub impacts: Impacts,
    /// Velocities right after it over those of the model, as the kinetic energy weighs them. `None` where the model
    /// is then in another pattern, or too slow.
    pub ratio: Option<f64>,
    /// Standard deviation of the ratio by the noise of the velocities after it.
    pub ratio_sd: Option<f64>,
}

impl Jump {
    /// Position of the coefficient C_l the model's only impact has; `None` for a burst, or an impact not in Table 2.
    pub fn coefficient(&self) -> Option<usize> {
        let single = self.impacts.total() == 1;
        self.impacts.table2.iter().position(|&count| single && count == 1)
    }
}

/// Every change of pattern of every test that a wall goes through with an impact.
pub fn jumps(tests: &[TestData], physics: &Physics) -> Vec<Jump> {
    let of = |(index, test): (usize, &TestData)| of_test(index, test, physics);
    tests.par_iter().enumerate().flat_map_iter(of).collect()
}

fn of_test(index: usize, test: &TestData, physics: &Physics) -> Vec<Jump> {
    let spring = SpringMemory::new(test, physics);
    let shaking = shaken(&test.shaking, physics.reversed_ratio);
    let simulator = Simulator::new(&physics.wall, &shaking, Accuracy::default());
    let longest = test.samples_in(LONGEST_DOUBT * simulator.wall().response_time_s());
    let all = stretches(test);
    let between = |pair: &[Stretch]| {
        let [before, after] = [&pair[0], &pair[1]];
        let (Some(inner), true) = (before.states.len().checked_sub(GUARD + 1), after.states.len() > GUARD)
        else {
            return None;
        };
        let (last, first) = (before.from + inner, after.from + GUARD);
        let moves = before.contact != Contact::REST && after.contact != Contact::REST;
        if !moves || first - last > longest + 2 * GUARD || before.contact == after.contact {
            return None;
        }
        let (state, contact) = (before.states[inner], before.contact);
        let plastic_displacement_m = spring.plastic_m(last, simulator.wall(), contact, state.theta);
        let (time_s, contact) = (test.time_s[last], Some(contact));
        let start = Start { time_s, state, contact, plastic_displacement_m, ..Start::default() };
        let mut end = End::default();
        let response = simulator.run_from(&start, test.time_s[first], &mut end);
        let impacts = response.impacts;
        if impacts.total() == 0 {
            return None;
        }
        let noise = test.noise_rad.map(|sigma| SLOPE_NOISE * sigma / test.step_s);
        let found = (end.contact == Some(after.contact))
            .then(|| ratio(simulator.wall(), after, &end, noise))
            .flatten();
        Some(Jump {
            test: index,
            time_s: test.time_s[first],
            contacts: [before.contact, after.contact],
            impacts,
            ratio: found.map(|f| f[0]),
            ratio_sd: found.map(|f| f[1]),
        })
    };
    all.windows(2).filter_map(between).collect()
}

/// 1 + (ω_m - ω) · M ω⁺ / (ω⁺ · M ω⁺), and its standard deviation; `None` where ω⁺ is slow.
///
/// ω⁺ are the model's velocities right after its last impact. ω are those a little later, when the measured ω_m are
/// known. Meanwhile both change by nearly the same.
fn ratio(wall: &RockingWall, after: &Stretch, end: &End, noise: Pair) -> Option<[f64; 2]> {
    let State { theta, omega: measured } = after.states[GUARD];
    if (0..2).all(|i| end.omega_after[i].abs() < FAST * noise[i]) {
        return None;
    }
    let momentum = wall.moments_n_m(after.contact, theta, end.omega_after);
    let along = |v: Pair| v[0] * momentum[0] + v[1] * momentum[1];
    let twice_energy = along(end.omega_after);
    let sd = (momentum[0] * noise[0]).hypot(momentum[1] * noise[1]) / twice_energy;
    Some([1.0 + along([0, 1].map(|i| measured[i] - end.omega[i])) / twice_energy, sd])
}

/// State at the end of a run, and velocities since the contact state last changed.
#[derive(Debug, Default)]
struct End {
    contact: Option<Contact>,
    omega: Pair,
    omega_after: Pair,
}

impl Observer for End {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        if self.contact != Some(contact) {
            self.omega_after = motion.velocity(0.0);
        }
        self.omega = motion.velocity(1.0);
        self.contact = Some(contact);
    }

    fn stood(&mut self, _: f64, _: f64) {
        (self.omega, self.omega_after, self.contact) = ([0.0; 2], [0.0; 2], Some(Contact::REST));
    }

    fn ended(&mut self, _: f64, contact: Contact, _: Pair) {
        self.contact = Some(contact);
    }
}

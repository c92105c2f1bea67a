//! Tests of a simulated wall with a law that is known, for tests of what finds it.

use std::path::{Path, PathBuf};

use super::asked::{AskedOfLaws, OpenGap, Scope};
use super::points::Points;
use super::refused::Guard;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::formula::{Atom, Law, Shape, Side, Site};
use crate::diagnose::hypothesis::{Hypothesis, Nuisance, Scales, wall_number};
use crate::diagnose::trials::{Data, FittedHypothesis, Trials, Unfinished, WallFits, against, joint_error};
use crate::experiment::{Manner, Purpose, Sampled, TestData, Window, rest_offset_rad, windows};
use mrbd_files::parse_wall;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Shaking, Simulator};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const STARTER: &str = include_str!("../../../../../src/cli/starter/wall.toml");
const STEP_S: f64 = 1.0 / 256.0;
const SHAKEN_S: f64 = 10.0;
const TAIL_S: f64 = 4.0;

/// A drag at the top that no catalogue has.
pub const DRAG: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-c*v*abs(v)\"\n\
                        [effects.parameters]\nc = { value = 4000.0, unit = \"N*(s/m)**2\" }\n";
/// Damping at the top that grows with displacement.
pub const OPENING: &str = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-c*abs(x)*v\"\n\
                           [effects.parameters]\nc = { value = 3e4, unit = \"N/m*(s/m)\" }\n";
/// A spring on one side.
pub const SPRING: &str =
    "[[effects]]\nkind = \"one_sided_spring\"\nside = \"negative\"\nstiffness_n_per_m = 5e3\n";

/// The starter's wall with effects, as TOML.
pub fn wall_with(effects: &str) -> Wall {
    parse_wall(Path::new("wall.toml"), &format!("{STARTER}\n{effects}")).expect("a wall")
}

/// What is told of the wall beforehand: stiffness to 2 %, mass to 1 %.
pub fn known(tests: &[TestData]) -> Hypothesis {
    known_to(0.02, tests)
}

/// The same with stiffness to a share.
pub fn known_to(stiffness: f64, tests: &[TestData]) -> Hypothesis {
    let wall = wall_with("");
    Hypothesis::new(wall.parameters(), &Scales::of(&wall, tests), &nuisances(stiffness), &[])
}

fn nuisances(stiffness: f64) -> [Nuisance; 2] {
    let number = |(key, sd): (&str, f64)| Nuisance::Number(wall_number(key).expect("a number"), sd);
    [("stiffness_n_per_m", stiffness), ("mass_kg", 0.01)].map(number)
}

/// An experiment on a wall: tests to fit and one held out.
pub struct Twin {
    experiment: Experiment,
    windows: [Vec<Window>; 2],
    unfinished: Unfinished,
}

impl Twin {
    /// Two tests to fit. The wall is known but for its effects, which are hidden.
    pub fn new(hidden: &Wall, noise_rad: f64) -> Self {
        Self::of_first_two(tests_of(hidden, noise_rad))
    }

    /// The same shaken so fast that the crack opens at impacts, and shuts before a stretch between these tells of it.
    pub fn opening_briefly(hidden: &Wall, noise_rad: f64) -> Self {
        Self::of_first_two(shaken(hidden, noise_rad, [[3.0, 3.0], [4.0, 4.0], [3.0, 4.0], [5.0, 4.0]]))
    }

    fn of_first_two(mut tests: Vec<TestData>) -> Self {
        tests.remove(2);
        tests[2].purpose = Purpose::HoldOut;
        Self::of(tests)
    }

    /// The same with the test held out in which it rocks farthest.
    pub fn farthest_held_out(hidden: &Wall, noise_rad: f64) -> Self {
        let mut tests = tests_of(hidden, noise_rad);
        let reach = |test: &TestData| test.theta_rad.iter().map(|theta| theta[0].abs()).fold(0.0, f64::max);
        tests.sort_by(|a, b| reach(a).total_cmp(&reach(b)));
        if let Some(farthest) = tests.last_mut() {
            farthest.purpose = Purpose::HoldOut;
        }
        Self::of(tests)
    }

    fn of(tests: Vec<TestData>) -> Self {
        let (fit, held_out) = windows(&tests).into_iter().partition(|w| w.purpose == Purpose::Fit);
        let wall = wall_with("");
        let experiment = Experiment {
            path: PathBuf::new(),
            wall_path: PathBuf::new(),
            wall_table: toml::Table::new(),
            nuisances: nuisances(0.02).to_vec(),
            hypotheses: Vec::new(),
            as_read: false,
            whole: Vec::new(),
            scales: Scales::of(&wall, &tests),
            inputs: Vec::new(),
            wall,
            tests,
        };
        Self { experiment, windows: [fit, held_out], unfinished: Unfinished::default() }
    }

    /// What is diagnosed.
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// Windows to fit and held out.
    pub fn windows(&self) -> &[Vec<Window>; 2] {
        &self.windows
    }

    /// Where hypotheses of it are tried.
    pub fn trials(&self) -> Trials<'_, ()> {
        let Self { experiment, windows, unfinished } = self;
        Trials::new(experiment, Data::new(&experiment.tests, windows), &(), unfinished)
    }
}

/// Four tests of a wall, read with white noise.
pub fn tests_of(wall: &Wall, noise_rad: f64) -> Vec<TestData> {
    shaken(wall, noise_rad, [[1.3, 1.0], [1.6, 1.3], [1.4, 0.8], [2.0, 1.6]])
}

/// The same under sweeps about these amplitudes (m/s²) and frequencies (Hz).
fn shaken(wall: &Wall, noise_rad: f64, sweeps: [[f64; 2]; 4]) -> Vec<TestData> {
    let one = |(seed, [amplitude_m_s2, frequency_hz]): (u64, [f64; 2])| {
        let record = swept(amplitude_m_s2, frequency_hz);
        let shaking = Shaking { horizontal: Some(record), vertical: None, tail_s: TAIL_S };
        let time_s = (0..).map(|k| STEP_S * f64::from(k)).take_while(|t| *t < SHAKEN_S + TAIL_S - 0.1);
        let time_s = time_s.collect::<Vec<_>>();
        let mut sampled = Sampled::at_all(&time_s);
        Simulator::new(wall, &shaking, Accuracy::default()).run(&mut sampled);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        let gain = wall.reading().gain;
        let mut read = |theta: [f64; 2]| [0, 1].map(|i| gain[i] * theta[i] + noise_rad * noise());
        let read = sampled.rows().iter().map(|(theta, _)| read(*theta));
        let theta_rad = read.collect::<Vec<_>>();
        let largest_rad = theta_rad.iter().flatten().fold(0.0, |most, t: &f64| t.abs().max(most));
        assert!((0.003..0.05).contains(&largest_rad), "rocks and stands: {largest_rad} rad in test {seed}");
        TestData {
            name: format!("test {seed}"),
            purpose: Purpose::Fit,
            shaking,
            rest_offset_rad: rest_offset_rad(&theta_rad, [noise_rad; 2]),
            theta_rad,
            time_s,
            noise_rad: [noise_rad; 2],
            read_gain: [1.0; 2],
            step_s: STEP_S,
            gap_s: 2.5 * STEP_S,
            manner: Manner::default(),
        }
    };
    (1..).zip(sweeps).map(one).collect()
}

/// Points of these tests under the wall as it is known.
pub fn points_of(tests: &[TestData]) -> Points {
    Points::new(tests, &known(tests)).expect("points")
}

/// Points of a wall without effects, with a share of a law added to what is missing in each test. Noise is white.
pub fn points_with(law: &Law, share: impl Fn(usize) -> f64) -> Points {
    let mut points = points_of(&tests_of(&wall_with(""), 3e-5));
    let added = points.of_law(law);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for row in 0..points.missing.len() {
        let noise: f64 = StandardNormal.sample(&mut random);
        points.missing[row] = noise + share(points.test[row]) * added[row];
    }
    points
}

/// A drag at the top.
pub fn drag(n: f64, size: f64) -> Law {
    Law::of(Atom {
        site: Site::Top,
        shape: Shape::Drag,
        numbers: [n, 0.0],
        size,
        reach: REACH,
        is_exact: false,
    })
}

/// [`DRAG`] and [`SPRING`] as a law of two atoms, in shares of what tests excited at the top.
pub fn drag_and_spring(points: &Points) -> Law {
    let reach = points.reach[Site::Top as usize];
    let atom = |shape: Shape, n: f64, size: f64| Atom {
        site: Site::Top,
        shape,
        numbers: [n, 0.0],
        size,
        reach,
        is_exact: false,
    };
    let spring = atom(Shape::OneSidedSpring(Side::Negative), 1.0, 5e3 * reach[0]);
    Law { second: Some(spring), ..Law::of(atom(Shape::Drag, 2.0, 4000.0 * reach[1] * reach[1])) }
}

/// Size of [`DRAG`] at the velocity in shares of which [`drag`] is told, N.
pub const DRAG_N: f64 = 4000.0 * REACH[1] * REACH[1];

/// What a wall leaves open, and which laws are asked of it.
pub fn open_gap(wall: &WallFits, scope: Scope) -> OpenGap<'_> {
    OpenGap {
        recalibrated: &wall.recalibrated,
        nearest: &wall.recalibrated,
        error: joint_error(&wall.before).expect("windows"),
        scope,
        kin: &[],
        before: None,
    }
}

/// Asks a second atom to gain so much over all windows, in natural logarithms, and nothing else.
pub struct AskedOfGain<'d> {
    /// The windows.
    pub data: Data<'d>,
    /// What it must gain.
    pub least: f64,
}

impl AskedOfLaws for AskedOfGain<'_> {
    fn is_worth_two(&self, one: &FittedHypothesis, two: &FittedHypothesis) -> bool {
        against(&self.data, one) - against(&self.data, two) > self.least
    }

    fn follows_held_out(&self, _: &FittedHypothesis) -> bool {
        true
    }

    fn leaves_nothing(&self, _: &FittedHypothesis) -> bool {
        true
    }

    fn other_law(&self, _: &FittedHypothesis) -> Vec<Guard> {
        Vec::new()
    }
}

/// Largest displacement and velocity of the top that a law is told in shares of: about those of the tests.
const REACH: [f64; 2] = [0.1, 0.6];

/// A sine that swells, sweeps and fades.
fn swept(amplitude_m_s2: f64, frequency_hz: f64) -> Accelerogram {
    let at = |k: u32| {
        let t = 0.005 * f64::from(k);
        let swell = (std::f64::consts::PI * t / SHAKEN_S).sin();
        let phase = std::f64::consts::TAU * frequency_hz * t * (1.0 + 0.06 * t);
        amplitude_m_s2 * swell * phase.sin()
    };
    Accelerogram::new(0.005, (0..=2000).map(at).collect()).expect("a record")
}

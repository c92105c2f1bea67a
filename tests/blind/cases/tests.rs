//! The tests of a case: ground motions scaled so that the wall rocks well and stands, and what is measured.

use std::path::Path;

use mrbd_files::load_wall;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate, simulate_observed};
use mrbd_records::{Accelerogram, GENERATED_STEP_S, RecordTable, generate};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_distr::{Distribution, Normal};

use super::super::compliant::{GroundMotion, run};
use super::draw::{Case, Simulator, generator, seed};
use super::hidden::Hidden;
use super::{compliant_wall, own_wall};

/// Step of records and measurements, s.
pub const STEP_S: f64 = 0.005;
/// Free motion that is measured after a record, s.
const TAIL_S: f64 = 3.0;
/// Rounds in which a ground motion is scaled.
const ROUNDS: usize = 12;
/// The largest rotation of the wall that is measured, over the target: what a test may have.
const ROCKS_BETWEEN: [f64; 2] = [0.3, 2.0];
/// The same for a test that is held out at an amplitude of its own.
const ANOTHER_AMPLITUDE: [f64; 2] = [0.75, 1.4];

/// One test: the record as the experiment has it, and the rotations as they are read.
#[derive(Debug, Clone)]
pub struct Test {
    pub record_m_s2: Vec<f64>,
    pub measured_rad: Vec<[f64; 2]>,
    /// The same before anything is read.
    pub true_rad: Vec<[f64; 2]>,
    /// Largest rotation, rad.
    pub largest_rad: f64,
}

/// Ground motions of a set: its own, generated from the rows of the paper's Table 4 with its own seed.
pub fn motions(set: &str) -> mrbd::Result<Vec<Vec<f64>>> {
    let table = RecordTable::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/table4.toml"))?;
    Ok(generate(&table, None, seed(set)).iter().map(resampled).collect())
}

/// The same straight lines at half the step.
fn resampled(record: &Accelerogram) -> Vec<f64> {
    let times = (GENERATED_STEP_S / STEP_S).round() as usize;
    let pairs = record.acceleration_m_s2().windows(2);
    let mut samples: Vec<f64> = pairs
        .flat_map(|pair| (0..times).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / times as f64))
        .collect();
    samples.extend(record.acceleration_m_s2().last());
    samples
}

/// The tests of a case.
///
/// # Errors
/// Text for people if the wall cannot be read by the library, or no scale makes it rock and stand.
pub fn tests(case: &Case, motions: &[Vec<f64>], folder: &Path) -> Result<Vec<Test>, String> {
    let mut rng = generator(&case.set, case.number, 1);
    let mut order: Vec<usize> = (0..motions.len()).collect();
    order.shuffle(&mut rng);
    let described = load(folder, "described.toml", &case.described.to_toml(&[]))?;
    let actual = match case.simulator {
        Simulator::Own => Some(load(folder, "actual.toml", &own_wall::true_wall(case))?),
        Simulator::Compliant => None,
    };
    let bench = Bench { case, described, actual };
    let count = case.fit_tests + case.hold_out_tests;
    let mut tests = Vec::new();
    // Some motions let a wall stand still or throw it down, and nothing between: then the next one is taken.
    for k in 0..3 * motions.len() {
        let polarity = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
        let is_held_out = tests.len() >= case.fit_tests;
        let amplitude = if is_held_out { case.held_out_amplitude } else { 1.0 };
        let target_rad = case.target_rad * amplitude * rng.random_range(0.7..1.3);
        let motion: Vec<f64> = motions[order[k % order.len()]].iter().map(|a| a * polarity).collect();
        let between = if amplitude == 1.0 { ROCKS_BETWEEN } else { ANOTHER_AMPLITUDE };
        tests.extend(bench.test(&motion, target_rad, between, k as u64));
        if tests.len() == count {
            return Ok(tests);
        }
    }
    Err(format!("only {} of {count} tests in which the wall rocks and stands", tests.len()))
}

/// Reads a wall the way a user's file is read; the file does not stay.
fn load(folder: &Path, name: &str, text: &str) -> Result<Wall, String> {
    let path = folder.join(name);
    std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
    let wall = load_wall(&path).map_err(|e| e.to_string());
    std::fs::remove_file(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    wall
}

struct Bench<'a> {
    case: &'a Case,
    described: Wall,
    actual: Option<Wall>,
}

impl Bench<'_> {
    /// A test by this motion; none if no scale makes the wall rock and stand.
    fn test(&self, motion: &[f64], target_rad: f64, between: [f64; 2], k: u64) -> Option<Test> {
        let mut scale = self.scale(motion, target_rad);
        let (mut too_small, mut too_large) = (None, None);
        for _ in 0..ROUNDS {
            let record_m_s2: Vec<f64> = motion.iter().map(|a| (a * scale * 1e6).round() / 1e6).collect();
            let theta = self.shaken(&record_m_s2);
            let largest_rad = theta.iter().flatten().fold(0.0, |largest: f64, t| largest.max(t.abs()));
            if largest_rad > between[1] * target_rad {
                too_large = Some(scale);
            } else if largest_rad < between[0] * target_rad {
                too_small = Some(scale);
            } else {
                let measured_rad = self.read(theta.clone(), k);
                return Some(Test { record_m_s2, measured_rad, true_rad: theta, largest_rad });
            }
            scale = match (too_small, too_large) {
                (Some(low), Some(high)) => f64::sqrt(low * high),
                (Some(_), None) => 1.25 * scale,
                _ => 0.8 * scale,
            };
        }
        None
    }

    /// The scale at which the wall as described rocks to the target; found by halving, for the motion is not monotonic.
    fn scale(&self, motion: &[f64], target_rad: f64) -> f64 {
        let peak = motion.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()));
        let (mut low, mut high) = (0.5 / peak, 12.0 / peak);
        for _ in 0..ROUNDS {
            let middle = (low * high).sqrt();
            let response = simulate(&self.described, &shaking(motion, middle), Accuracy::default());
            let largest = response.theta_max_rad.iter().fold(0.0, |l: f64, peak| l.max(peak.value.abs()));
            if response.collapsed() || largest > target_rad { high = middle } else { low = middle }
        }
        low
    }

    /// The true rotations under a record, with what is hidden in the ground motion; without noise.
    fn shaken(&self, record_m_s2: &[f64]) -> Vec<[f64; 2]> {
        let (mut gain, mut ratio, mut late) = (1.0, 0.0, 0);
        for effect in &self.case.hidden {
            match *effect {
                Hidden::RecordGain { gain: g } => gain = g,
                Hidden::VerticalGroundMotion { ratio: r } => ratio = r,
                Hidden::RecordLag { lag_s } => late = (lag_s / STEP_S).round() as usize,
                _ => {}
            }
        }
        let mut x = vec![0.0; late];
        x.extend(record_m_s2.iter().map(|a| a * gain));
        let y: Vec<f64> = x.iter().map(|a| a * ratio).collect();
        let mut theta = match &self.actual {
            Some(wall) => own(wall, x, y),
            None => {
                let ground = GroundMotion { step_s: STEP_S, x_m_s2: x, y_m_s2: y };
                run(compliant_wall::true_wall(self.case), &ground, TAIL_S).theta_rad
            }
        };
        theta.truncate(record_m_s2.len() + (TAIL_S / STEP_S) as usize);
        theta
    }

    /// What the sensors say.
    fn read(&self, mut theta: Vec<[f64; 2]>, k: u64) -> Vec<[f64; 2]> {
        let mut rng = generator(&self.case.set, self.case.number, 2 + k);
        let noise = Normal::new(0.0, self.case.noise_rad).expect("a positive standard deviation");
        for reading in &mut theta {
            for effect in &self.case.hidden {
                match *effect {
                    Hidden::SensorGain { body, gain } => reading[body] *= gain,
                    Hidden::SensorOffset { body, offset_rad } => reading[body] += offset_rad,
                    _ => {}
                }
            }
            reading.iter_mut().for_each(|theta| *theta += noise.sample(&mut rng));
        }
        theta
    }
}

fn own(wall: &Wall, x: Vec<f64>, y: Vec<f64>) -> Vec<[f64; 2]> {
    let accelerogram = |samples| Accelerogram::new(STEP_S, samples).expect("finite samples");
    let vertical = y.iter().any(|a| *a != 0.0).then(|| accelerogram(y));
    let shaking = Shaking { horizontal: Some(accelerogram(x)), vertical, tail_s: TAIL_S };
    let mut history = History::new(STEP_S);
    simulate_observed(wall, &shaking, Accuracy { tolerance: 1e-8 }, &mut history);
    history.rows.iter().map(|row| row.theta_rad).collect()
}

fn shaking(motion: &[f64], scale: f64) -> Shaking {
    let samples = motion.iter().map(|a| a * scale).collect();
    let horizontal = Some(Accelerogram::new(STEP_S, samples).expect("finite samples"));
    Shaking { horizontal, vertical: None, tail_s: TAIL_S }
}

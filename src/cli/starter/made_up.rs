//! Tests that no laboratory made: the starter's wall simulated under its experiment's records, with noise.

use std::fmt::Write;
use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

use super::{EXPERIMENT, FILES, WALL};
use crate::error::{InputError, Result};
use mrbd_files::parse_wall;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_lab::experiment::file::{ExperimentFile, TestTable};
use mrbd_records::{Accelerogram, ReadOptions, read_bytes};

/// Standard deviation of the noise, rad: that of good displacement transducers on a wall of this size.
const NOISE_RAD: f64 = 1e-4;
/// Free motion after the record, s.
const TAIL_S: f64 = 2.0;

/// The measured files of the starter's experiment: names and texts.
///
/// # Errors
/// Those of reading the starter's own files, which are defects.
pub fn tests() -> Result<Vec<(String, String)>> {
    let wall = parse_wall(Path::new(WALL.0), WALL.1)?;
    let experiment = ExperimentFile::parse(Path::new(EXPERIMENT.0), EXPERIMENT.1)?;
    let numbered = experiment.tests.iter().zip(0..);
    numbered.map(|(test, seed)| Ok((name_of(&test.measured), measured(&wall, test, seed)?))).collect()
}

fn name_of(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// Noisy rotations of a test at every sample of its record, as CSV.
fn measured(wall: &Wall, test: &TestTable, seed: u64) -> Result<String> {
    let noise = Normal::new(0.0, NOISE_RAD);
    let noise = noise.map_err(|e| InputError::file(&test.measured, e.to_string(), "a noise above 0"))?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut text = String::from("time_s,theta1_rad,theta2_rad\n");
    for row in history(wall, &record(test)?).rows {
        let [theta1, theta2] = row.theta_rad.map(|theta| theta + noise.sample(&mut rng));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{:.3},{theta1:.6},{theta2:.6}", row.time_s);
    }
    Ok(text)
}

fn record(test: &TestTable) -> Result<Accelerogram> {
    let none =
        || InputError::file(&test.measured, "a test without a record", "records for tests that are made up");
    let record = test.record.as_deref().ok_or_else(none)?;
    let name = name_of(record);
    let text = FILES.iter().find(|(file, _)| *file == name).map_or("", |(_, text)| text);
    Ok(read_bytes(record, text.as_bytes(), &ReadOptions::default())?.accelerogram.scaled(test.scale))
}

fn history(wall: &Wall, record: &Accelerogram) -> History {
    let mut history = History::new(record.step_s());
    let shaking = Shaking { horizontal: Some(record.clone()), vertical: None, tail_s: TAIL_S };
    simulate_observed(wall, &shaking, Accuracy::default(), &mut history);
    history
}

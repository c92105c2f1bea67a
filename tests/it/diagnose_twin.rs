//! Twins: tests of a wall of known truth, written as a laboratory would, and what a diagnosis says of them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mrbd_kernel::model::{Effect, ImpactLaw, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_records::{Accelerogram, ReadOptions, read};
use rand_distr::{Distribution, Normal};
use serde_json::Value;

use crate::walls::{rng, table_wall};

const STEP_S: f64 = 0.005;
/// The measurement's clock was started this much after the record's, s.
const LATE_S: f64 = 0.5;
/// Between the quiet and the noisy cases of a laboratory, rad.
const NOISE_RAD: f64 = 3e-5;

/// A shaking of the repository's own suite from where it becomes strong, s: short enough for a test.
pub fn record(number: usize, from_s: f64, length_s: f64) -> Accelerogram {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/records/emilia7");
    let mut files = std::fs::read_dir(folder)
        .expect("the suite is there")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "csv"))
        .collect::<Vec<_>>();
    files.sort();
    let whole = read(&files[number], &ReadOptions::default()).expect("a record").accelerogram;
    let [from, count] = [from_s, length_s].map(|s| (s / whole.step_s()) as usize);
    let part = whole.acceleration_m_s2()[from..from + count].to_vec();
    Accelerogram::new(whole.step_s(), part).expect("a valid part")
}

/// Writes the tests of a wall as a laboratory would, the description of the wall beside them without its effects.
pub fn write_twin(
    folder: &Path,
    described: &WallParameters,
    true_wall: &WallParameters,
    change: impl Fn([f64; 2]) -> [f64; 2],
) -> PathBuf {
    write_twins(folder, described, [true_wall; 3], [2.2; 3], change)
}

/// The same with a wall and a factor on the record for every test; the last is held out.
pub fn write_twins(
    folder: &Path,
    described: &WallParameters,
    true_walls: [&WallParameters; 3],
    scales: [f64; 3],
    change: impl Fn([f64; 2]) -> [f64; 2],
) -> PathBuf {
    let mut experiment =
        String::from("wall = \"wall.toml\"\n[prior]\nstiffness_n_per_m = 0.02\nmass_kg = 0.01\n");
    for (i, (true_wall, scale)) in true_walls.into_iter().zip(scales).enumerate() {
        let wall = Wall::new(true_wall.clone()).expect("a wall");
        let record = record(i, 4.0, 12.0).scaled(scale);
        let normal = Normal::new(0.0, NOISE_RAD).expect("a deviation");
        let mut random = rng(700, i as u64);
        let mut history = History::new(STEP_S);
        let shaking = Shaking { horizontal: Some(record.clone()), vertical: None, tail_s: 2.0 };
        simulate_observed(&wall, &shaking, Accuracy { tolerance: 1e-8 }, &mut history);
        let mut measured = String::from("time_s,theta1_rad,theta2_rad\n");
        for row in &history.rows {
            let [one, two] = change(row.theta_rad.map(|theta| theta + normal.sample(&mut random)));
            writeln!(measured, "{:.3},{one:.7},{two:.7}", row.time_s - LATE_S).expect("text");
        }
        let mut motion = String::from("time_s,acceleration_m_s2\n");
        for (k, a) in record.acceleration_m_s2().iter().enumerate() {
            writeln!(motion, "{:.3},{a:.6}", k as f64 * record.step_s()).expect("text");
        }
        let purpose = if i == 2 { "hold-out" } else { "fit" };
        write!(
            experiment,
            "[[tests]]\nname = \"test {i}\"\nrecord = \"record_{i}.csv\"\nmeasured = \"measured_{i}.csv\"\nuse = \"{purpose}\"\nstart_s = {LATE_S}\n"
        )
        .expect("text");
        std::fs::write(folder.join(format!("record_{i}.csv")), motion).expect("written");
        std::fs::write(folder.join(format!("measured_{i}.csv")), measured).expect("written");
    }
    let p = described;
    let text = format!(
        "[wall]\nthickness_m = {}\nheight_m = {}\ncrack_height_m = {}\nlength_m = {}\nmass_kg = {}\n\
         [corners]\nlower_width_m = {}\nupper_width_m = {}\n\
         [diaphragm]\nmass_kg = {:?}\ncarriage_mass_kg = {:?}\nstiffness_n_per_m = {:?}\n\
         [restitution]\ncoefficients = {:?}\nlaw = \"contact\"\n",
        p.thickness_m,
        p.height_m,
        p.crack_height_m.expect("cracked"),
        p.length_m,
        p.mass_kg,
        p.lower_width_m,
        p.upper_width_m,
        p.diaphragm_mass_kg,
        p.carriage_mass_kg,
        p.stiffness_n_per_m,
        p.restitution.coefficients
    );
    std::fs::write(folder.join("wall.toml"), text).expect("written");
    let path = folder.join("experiment.toml");
    std::fs::write(&path, experiment).expect("written");
    path
}

pub fn diagnose(experiment: &Path, out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mrbd"))
        .args(["diagnose".as_ref(), experiment.as_os_str(), "--out".as_ref(), out.as_os_str()])
        .output()
        .expect("mrbd runs")
}

pub fn diagnosed(experiment: &Path, out: &Path) -> Value {
    let output = diagnose(experiment, out);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(out.join("diagnosis.json")).expect("written");
    serde_json::from_str(&text).expect("JSON")
}

/// A wall whose floor is damped, diagnosed as one whose floor is not: its folder, the results, the verdict.
pub fn damped_twin() -> (tempfile::TempDir, PathBuf, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let mut true_wall = described.clone();
    true_wall.effects.push(Effect::with_parameters("viscous_damping", &[1500.0]).expect("an effect"));
    let experiment = write_twin(folder.path(), &described, &true_wall, |theta| theta);
    let out = folder.path().join("out");
    let found = diagnosed(&experiment, &out);
    (folder, out, found)
}

/// Diagnoses a twin of the table wall with these effects; what was named, sorted, with the first number of each.
pub fn named_in_a_twin(
    effects: &[(&str, &[f64])],
    change: impl Fn([f64; 2]) -> [f64; 2],
) -> Vec<(String, f64)> {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let mut true_wall = described.clone();
    let effect = |(name, values): &(&str, &[f64])| Effect::with_parameters(name, values).expect("an effect");
    true_wall.effects.extend(effects.iter().map(effect));
    let experiment = write_twin(folder.path(), &described, &true_wall, change);
    let found = diagnosed(&experiment, &folder.path().join("out"));
    assert_eq!(found["verdict"], "named", "{found:#}");
    let effects = found["effects"].as_array().expect("a list").iter();
    let of = |effect: &Value| {
        let numbers = effect["parameters"].as_object().expect("numbers");
        let first = numbers.values().next().and_then(Value::as_f64).expect("a number");
        (effect["name"].as_str().expect("a name").to_owned(), first)
    };
    let mut named = effects.map(of).collect::<Vec<_>>();
    named.sort_by(|a, b| a.0.cmp(&b.0));
    named
}

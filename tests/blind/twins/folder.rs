//! A twin as files.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::json;

use super::super::cases::tests::{STEP_S, tests};
use super::super::cases::walls::{TABLE_2, WallNumbers};
use super::super::cases::{draw::Case, folder};
use super::draw::{Twin, lengthened};

/// Makes a twin and writes it: wall, experiment, records, measurements, and `truth.json`.
///
/// # Errors
/// Text for people: what cannot be simulated or written.
pub fn write(twin: &Twin, motions: &[Vec<f64>], to: &Path) -> Result<(), String> {
    std::fs::create_dir_all(to).map_err(|e| format!("{}: {e}", to.display()))?;
    let truth = match &twin.case {
        None => example(twin, to)?,
        Some(case) => drawn(twin, case, motions, to)?,
    };
    put(to, "truth.json", &format!("{truth:#}\n"))
}

fn put(folder: &Path, name: &str, text: &str) -> Result<(), String> {
    std::fs::write(folder.join(name), text).map_err(|e| format!("{}: {e}", folder.join(name).display()))
}

/// The example of `mrbd init` as it is, or with the program's own budgets.
fn example(twin: &Twin, to: &Path) -> Result<serde_json::Value, String> {
    mrbd::cli::starter::write_starter(to, None).map_err(|e| e.to_string())?;
    let path = to.join("experiment.toml");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let budgets = ["most_generations", "refine_vectors", "replicates"];
    let is_kept = |line: &&str| !(twin.by_default && budgets.iter().any(|key| line.starts_with(key)));
    put(to, "experiment.toml", &text.lines().filter(is_kept).collect::<Vec<_>>().join("\n"))?;
    Ok(truth(&TABLE_2, None))
}

fn truth(coefficients: &[f64; 8], stiffness_n_per_m: Option<f64>) -> serde_json::Value {
    let mut all: serde_json::Map<_, _> =
        coefficients.iter().zip(1..).map(|(c, l)| (format!("C_{l}"), json!(c))).collect();
    all.extend(stiffness_n_per_m.map(|k_d| ("diaphragm.stiffness_n_per_m".to_owned(), json!(k_d))));
    all.into()
}

fn drawn(twin: &Twin, case: &Case, motions: &[Vec<f64>], to: &Path) -> Result<serde_json::Value, String> {
    let tests = tests(case, &lengthened(motions, twin.length_s, STEP_S), to)?;
    let k_d = case.actual.stiffness_n_per_m;
    let told = twin.stiffness_over_true.unwrap_or(1.0);
    let wall = WallNumbers { coefficients: [1.0; 8], stiffness_n_per_m: k_d * told, ..case.actual.clone() };
    put(to, "wall.toml", &wall.to_toml(&[]))?;
    put(to, "experiment.toml", &experiment(twin, case))?;
    for (k, test) in tests.iter().enumerate() {
        put(to, &format!("record_{}.csv", k + 1), &folder::record(test))?;
        put(to, &format!("measured_{}.csv", k + 1), &folder::measured(test))?;
    }
    Ok(truth(&case.actual.coefficients, twin.stiffness_over_true.map(|_| k_d)))
}

fn experiment(twin: &Twin, case: &Case) -> String {
    let mut text = "wall = \"wall.toml\"\n".to_owned();
    // Writing to a string cannot fail.
    if twin.stiffness_over_true.is_some() {
        text += "\n[prior]\nstiffness_n_per_m = 0.02\n";
    }
    text += "\n[calibrate]\ncapture_study_rad_s = []\n";
    if !twin.by_default {
        text += "most_generations = 20\nrefine_vectors = 1000\n";
    }
    for (l, [lower, upper]) in twin.bounds.iter().enumerate() {
        let key = format!("C_{}", l + 1);
        let _ = write!(
            text,
            "\n[[calibrate.parameters]]\nkey = \"{key}\"\nlower = {lower:?}\nupper = {upper:?}\n"
        );
    }
    if twin.stiffness_over_true.is_some() {
        text += "\n[[calibrate.parameters]]\nkey = \"stiffness_n_per_m\"\n";
    }
    for n in 1..=case.fit_tests {
        let _ = write!(
            text,
            "\n[[tests]]\nname = \"test {n}\"\nrecord = \"record_{n}.csv\"\nmeasured = \"measured_{n}.csv\"\n"
        );
    }
    text
}

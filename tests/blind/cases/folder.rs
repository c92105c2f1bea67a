//! An experiment as files.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};

use super::super::compliant::corner::Corners;
use super::super::laws::excited::excited;
use super::draw::{Case, Contacts, Prior};
use super::kind::{Freedom, Kind};
use super::tests::{STEP_S, Test, tests};

/// Makes a case and writes it: `wall.toml`, `experiment.toml`, records, measurements, `answer.json`.
///
/// # Errors
/// Text for people: what cannot be simulated or written.
pub fn write(case: &Case, motions: &[Vec<f64>], folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let tests = tests(case, motions, folder)?;
    let put = |name: &str, text: String| {
        std::fs::write(folder.join(name), text).map_err(|e| format!("{}: {e}", folder.join(name).display()))
    };
    put("wall.toml", case.described.to_toml(&[]))?;
    put("experiment.toml", experiment(case))?;
    for (k, test) in tests.iter().enumerate() {
        put(&format!("record_{}.csv", k + 1), record(test))?;
        put(&format!("measured_{}.csv", k + 1), measured(test))?;
    }
    put("answer.json", format!("{:#}\n", answer(case, &tests)))
}

/// Whether the answer of a folder is that of a case.
///
/// # Errors
/// Text for people where it is another's, or no answer: a folder that holds another set must not be judged as this one.
pub fn is_this(case: &Case, answer: &Path) -> Result<(), String> {
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", answer.display());
    let text = std::fs::read_to_string(answer).map_err(|e| told(&e))?;
    let found: Value = serde_json::from_str(&text).map_err(|e| told(&e))?;
    let [set, number] = ["set", "number"].map(|key| &found["case"][key]);
    if *set == json!(case.set) && *number == json!(case.number) {
        return Ok(());
    }
    let wanted = format!("case {} of the set {}", case.number, case.set);
    Err(told(&format!("holds case {number} of the set {set}, not {wanted}; give another folder with --out")))
}

fn experiment(case: &Case) -> String {
    let mut text = format!(
        "wall = \"wall.toml\"\n\n[prior]                       # relative standard deviation of what was known before\n\
         stiffness_n_per_m = {:?}\nmass_kg = {:?}\n",
        case.prior.stiffness(),
        Prior::MASS
    );
    if case.prior == Prior::StiffnessAndImpactsFree {
        text.push_str("restitution = 0.1\n");
    }
    for k in 0..case.fit_tests + case.hold_out_tests {
        let purpose = if k < case.fit_tests { "fit" } else { "hold-out" };
        let n = k + 1;
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n[[tests]]\nname = \"test {n}\"\nrecord = \"record_{n}.csv\"\nmeasured = \"measured_{n}.csv\"\n\
             use = \"{purpose}\"\n"
        );
    }
    text
}

/// The record of a test as CSV.
pub fn record(test: &Test) -> String {
    let mut text = "time_s,acceleration_m_s2\n".to_owned();
    for (k, a) in test.record_m_s2.iter().enumerate() {
        let _ = writeln!(text, "{:.3},{a:.6}", k as f64 * STEP_S);
    }
    text
}

/// What was measured in a test as CSV.
pub fn measured(test: &Test) -> String {
    let mut text = "time_s,theta1_rad,theta2_rad\n".to_owned();
    for (k, [theta1, theta2]) in test.measured_rad.iter().enumerate() {
        let _ = writeln!(text, "{:.3},{theta1:.7},{theta2:.7}", k as f64 * STEP_S);
    }
    text
}

/// What joints are made of, where that is drawn.
fn told(contacts: Contacts) -> Value {
    match contacts {
        Contacts::SharpEdges => Value::Null,
        Contacts::Corners(Corners { stiffness_n_per_m, damping_n_s_per_m }) => {
            json!({ "stiffness_n_per_m": stiffness_n_per_m, "damping_n_s_per_m": damping_n_s_per_m })
        }
        Contacts::Springs { stiffness_pa_per_m, damping_s } => {
            json!({ "stiffness_pa_per_m": stiffness_pa_per_m, "damping_s": damping_s })
        }
    }
}

/// The answer: the verdicts that are right, what is hidden, and how the case was made.
fn answer(case: &Case, tests: &[Test]) -> Value {
    let (verdict, equivalent) = match case.kind {
        // Within the scatter of the prior, recalibrating is as right as seeing nothing.
        Kind::Nothing => (json!(["none", "recalibrated", "no_power"]), json!([])),
        // Whether a formula is the right one is not told here.
        Kind::Outside(_) | Kind::Law(_) => {
            (json!(["place_only", "unknown", "formula", "formula_class"]), json!([]))
        }
        Kind::Lumped(Freedom::Nothing) | Kind::One(_) | Kind::Pair(..) => (json!("named"), json!([])),
        Kind::Lumped(_) => (json!(["class", "named"]), json!(["stiffness"])),
    };
    let hidden: Vec<Value> = case.hidden.iter().map(super::hidden::Hidden::told).collect();
    json!({
        "verdict": verdict,
        "effect": hidden.first().map(|told| told["kind"].clone()),
        "value": hidden.first().map(|told| told["value"].clone()),
        "place": hidden.first().map(|told| told["place"].clone()),
        "effects": hidden,
        "equivalent": equivalent,
        "excited": excited(case, tests),
        "case": {
            "set": case.set,
            "number": case.number,
            "kind": case.kind.name(),
            "simulator": case.formulation(),
            "prior": case.prior.name(),
            "noise_rad": case.noise_rad,
            "contacts": told(case.contacts),
            "size": case.size,
            "fit_tests": case.fit_tests,
            "hold_out_tests": case.hold_out_tests,
            "stiffness_over_described": case.actual.stiffness_n_per_m / case.described.stiffness_n_per_m,
            "mass_over_described": case.actual.mass_kg / case.described.mass_kg,
            "stiffness_n_per_m": case.actual.stiffness_n_per_m,
            "largest_rotation_rad": tests.iter().map(|test| test.largest_rad).collect::<Vec<_>>(),
        },
    })
}

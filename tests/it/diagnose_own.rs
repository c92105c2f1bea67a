//! Laws of the user's own, tried beside the catalogue.

use std::fs;
use std::path::Path;

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::model::ImpactLaw;
use serde_json::Value;

use crate::diagnose_twin::{diagnose, diagnosed, write_twin};
use crate::walls::table_wall;

/// A drag with the square of the velocity and with a power that is to be found, and a spring that is not there.
const HYPOTHESES: &str = r#"
[[hypotheses]]
name = "drag"
kind = "formula"
place = "top"
force_n = "-c*abs(v)**p*sign(v)"
[hypotheses.parameters]
c = { value = 3000.0, unit = "N*(s/m)**p" }
p = { value = 1.5, unit = "1" }

[[hypotheses]]
name = "stiffening"
kind = "formula"
place = "top"
force_n = "-k*x**3"
[hypotheses.parameters]
k = { value = 1e6, unit = "N/m**3" }
"#;

/// The second law, but for its name.
const SPRING: &str = r#"kind = "formula"
place = "top"
force_n = "-k*x**3"
[hypotheses.parameters]
k = { value = 1e6, unit = "N/m**3" }
"#;

fn append(path: &Path, text: &str) {
    let before = fs::read_to_string(path).expect("written");
    fs::write(path, before + text).expect("written again");
}

#[test]
fn analytic_a_law_of_ones_own_is_fitted_and_judged_beside_the_catalogue() {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let mut true_wall = described.clone();
    let drag = Formula::parse("-c*abs(v)*v", Place::Top, &[Parameter::new("c", 6000.0, "N*s**2/m**2")]);
    true_wall.formulas.push(drag.expect("a formula"));
    let experiment = write_twin(folder.path(), &described, &true_wall, |theta| theta);
    append(&experiment, HYPOTHESES);
    let found = diagnosed(&experiment, &folder.path().join("out"));
    let own = found["hypotheses"].as_array().expect("a list");
    assert_eq!(
        own.iter().map(|h| h["closes_gap"].as_bool()).collect::<Vec<_>>(),
        [Some(true), Some(false)],
        "{own:#?}"
    );
    let number = |i: usize, key: &str| own[0]["parameters"][i][key].as_f64().expect("a number");
    for (i, truth) in [6000.0, 2.0].into_iter().enumerate() {
        let (value, sd) = (number(i, "value"), number(i, "sd"));
        // Three standard deviations, and a tenth where they are small.
        assert!((value - truth).abs() < 3.0 * sd.max(0.03 * truth), "{value} ± {sd} for {truth}");
    }
    assert!(own[0]["windowed_error"]["held_out"].as_f64().expect("a number") < 1.1, "{own:#?}");
    let against = |h: &Value| h["against"]["all"].as_f64().expect("a number");
    assert!(against(&own[0]) < against(&own[1]));
}

#[test]
fn rejects_hypotheses_that_are_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let experiment = write_twin(folder.path(), &described, &described, |theta| theta);
    let tests = fs::read_to_string(&experiment).expect("written");
    for (found, put, parts) in [
        ("name = \"drag\"\n", "", &["hypotheses", "missing field `name`"][..]),
        ("\"stiffening\"", "\"drag\"", &["hypotheses[1].name", "\"drag\" again", "each name once"]),
        ("value = 1e6", "value = 0", &["hypotheses[1].parameters.k", "found 0", "with its sign"]),
        ("-k*x**3", "-k*x**2", &["`-k*x**2` in N/m", "allowed: N"]),
        ("-k*x**3", "-k*x**4/x", &["hypotheses[1].force_n", "`x` may be zero"]),
        ("kind = \"formula\"", "kind = \"gap\"", &["hypotheses[0]", "of gap"]),
        (
            SPRING,
            "kind = \"viscous_damping\"\ncoefficient_n_s_per_m = 100.0\n",
            &["kind `viscous_damping`", "is tried anyway"],
        ),
    ] {
        assert!(HYPOTHESES.contains(found), "{found}");
        fs::write(&experiment, tests.clone() + &HYPOTHESES.replacen(found, put, 1)).expect("written");
        let output = diagnose(&experiment, &folder.path().join("out"));
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(parts.iter().all(|part| told.contains(part)), "{parts:?} in: {told}");
    }
}

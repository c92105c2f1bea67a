//! Laws that no catalogue has: found as formulas, and the wall with them runs.

use std::process::Command;

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::model::{ImpactLaw, WallParameters};
use serde_json::json;

use crate::diagnose_twin::{diagnosed, write_twins};
use crate::walls::table_wall;

#[test]
fn analytic_twin_of_a_quadratic_drag_is_told_as_its_formula_and_its_wall_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let drag = [Parameter::new("c", 9000.0, "N*(s/m)**2")];
    let drag = Formula::parse("-c*v*abs(v)", Place::Top, &drag).expect("a formula");
    let dragged = WallParameters { formulas: vec![drag], ..described.clone() };
    // Three amplitudes: over one, nine laws tie within 2 %.
    let experiment = write_twins(folder.path(), &described, [&dragged; 3], [1.8, 2.6, 2.2], |theta| theta);
    let out = folder.path().join("out");
    let found = diagnosed(&experiment, &out);
    assert_eq!(found["verdict"], "formula", "{found:#}");
    let effect = &found["effects"][0];
    assert_eq!([&effect["kind"], &effect["place"]], ["formula", "top"]);
    assert_eq!(effect["formula"], "-c*v*abs(v)");
    let c = effect["parameters"]["c"].as_f64().expect("a number");
    // The target for the median of such errors is 2 %, and this is one case.
    assert!((c / 9000.0 - 1.0).abs() < 0.04, "{c}");
    assert_eq!(effect["units"]["c"], "N*(s/m)**2");
    let round = &effect["round_exponents"];
    assert_eq!([&round["formula"], &round["told"]["n"]], [&json!("-c*sign(v)*abs(v)**n"), &json!(2.0)]);
    let [low, high] = [0, 1].map(|i| round["interval"]["n"][i].as_f64().expect("a number"));
    // Half way to the next round one it would be no 2.
    assert!((low..=high).contains(&2.0) && low > 1.75 && high < 2.25, "{low} to {high}");
    assert!(round["beside"].is_null(), "of a coefficient nothing is told: {round}");
    let [least, most] = [0, 1].map(|i| effect["range"]["v_m_s"][i].as_f64().expect("a number"));
    assert!(least < -0.05 && most > 0.05, "{least} to {most} m/s");
    let held_out = &found["tests"][2]["windowed_error"];
    let [before, after] = ["before", "after"].map(|k| held_out[k].as_f64().expect("a number"));
    assert!(before > 1.5 && after < 1.15, "held out: {before} before, {after} after");
    let wall = out.join("wall.updated.toml");
    let record = folder.path().join("record_0.csv");
    let run = Command::new(env!("CARGO_BIN_EXE_mrbd"))
        .args(["simulate".as_ref(), wall.as_os_str(), "--record".as_ref(), record.as_os_str()])
        .output()
        .expect("mrbd runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

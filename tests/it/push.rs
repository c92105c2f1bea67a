//! `mrbd push`: what it prints, what it writes, what it refuses; and a push that was measured.

use std::path::Path;

use serde_json::Value;

use crate::pipeline_cli::{mrbd, stdout};
use crate::shared;

/// A strip held at its top by a floor so stiff that it does not give, cracked half-way.
const HELD: &str = "[wall]\nthickness_m = 0.110\nheight_m = 1.5\ncrack_height_m = 0.75\nlength_m = 0.95\n\
    density_kg_m3 = 1800.0\n[diaphragm]\nmass_kg = 0.0\nstiffness_n_per_m = 1e9\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("wall.toml"), HELD).expect("written");
    folder
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&mrbd(folder, arguments))).expect("JSON")
}

#[test]
fn analytic_a_held_strip_begins_at_twice_its_slenderness_and_ends_a_thickness_away() {
    let folder = folder();
    let found = json(folder.path(), &["push", "wall.toml", "--at", "crack", "--json"]);
    let number = |key: &str| found["curve"][key].as_f64().expect("a number");
    // 2 b/h; a floor of 1e9 N/m gives by a few nanometres.
    assert!((number("largest_force_over_weight") / (2.0 * 0.110 / 1.5) - 1.0).abs() < 1e-4, "{found}");
    // Rotations of 0.147 rad leave their square, 2 %.
    assert!((number("end_m") / 0.110 - 1.0).abs() < 0.02);
    assert_eq!((&found["top"], &found["displacement_of"]), (&"springs".into(), &"crack".into()));
    // With sharp full edges the wall is its own rigid line.
    assert_eq!(found["curve"], found["rigid"]);
    // All masses pushed: twice as much.
    let uniform = json(folder.path(), &["push", "wall.toml", "--json"]);
    let share = uniform["curve"]["largest_force_over_weight"].as_f64().expect("a number");
    assert!((share / (4.0 * 0.110 / 1.5) - 1.0).abs() < 1e-4, "{share}");
}

#[test]
fn regress_a_push_is_a_table_a_picture_a_folder_and_a_page() {
    let folder = folder();
    std::fs::write(folder.path().join("measured.csv"), "displacement_m,force_n\n0,0\n0.02,250\n0.06,140\n")
        .expect("written");
    let run = ["push", "wall.toml", "--at", "crack", "--bed", "1e9", "--measured", "measured.csv"];
    let output = mrbd(folder.path(), &[&run[..], &["--out", "p", "--plot", "push.svg"]].concat());
    let table = stdout(&output);
    assert!(table.starts_with("displacement_m,force_n,force_over_weight,") && table.lines().count() > 50);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("3 points of measured.csv"), "{told}");
    for name in ["manifest.json", "push.json", "push.csv", "report.html"] {
        assert!(folder.path().join("p").join(name).is_file(), "{name}");
    }
    let page = std::fs::read_to_string(folder.path().join("p/report.html")).expect("a page");
    assert!(page.contains("rigid line") && page.contains("measured.csv") && !page.contains("NaN"));
    assert!(std::fs::read_to_string(folder.path().join("push.svg")).expect("a picture").contains("<svg"));
    // The page can be made again from the folder alone.
    stdout(&mrbd(folder.path(), &["report", "p"]));
    assert_eq!(std::fs::read_to_string(folder.path().join("p/report.html")).expect("a page"), page);
}

#[test]
fn analytic_a_bed_of_the_wall_file_is_the_bed_of_the_command() {
    let folder = folder();
    let effect = |joint: &str| {
        format!(
            "{HELD}[[effects]]\nkind = \"compliant_joint\"\njoint = \"{joint}\"\nstiffness_pa_per_m = 1e9\n"
        )
    };
    for (name, joint) in [("both.toml", "both"), ("crack.toml", "crack")] {
        std::fs::write(folder.path().join(name), effect(joint)).expect("written");
    }
    let push = |wall: &str, more: &[&str]| json(folder.path(), &[&["push", wall, "--json"], more].concat());
    let [of_file, of_command, at_crack] =
        [push("both.toml", &[]), push("wall.toml", &["--bed", "1e9"]), push("crack.toml", &[])];
    assert_eq!((&of_file["curve"], &of_file["rigid"]), (&of_command["curve"], &of_command["rigid"]));
    assert_eq!(at_crack["beds_pa_per_m"], serde_json::json!([null, 1e9]));
    let largest = |found: &Value| found["curve"]["largest_force_over_weight"].as_f64().expect("a number");
    // Each bed takes its part of the force.
    assert!(largest(&of_file) < largest(&at_crack) && largest(&at_crack) < largest(&push("wall.toml", &[])));
}

#[test]
fn analytic_a_rival_of_a_bed_is_told_and_takes_its_part_of_the_force() {
    let folder = folder();
    let effect = "kind = \"rounded_edges\"\njoint = \"crack\"\nworn_width_m = 0.01\nradius_m = 0.5\n";
    std::fs::write(folder.path().join("worn.toml"), format!("{HELD}[[effects]]\n{effect}")).expect("written");
    let worn = json(folder.path(), &["push", "worn.toml", "--json"]);
    let sharp = json(folder.path(), &["push", "wall.toml", "--json"]);
    assert_eq!(worn["joint_laws"], serde_json::json!([null, "rounded_edges"]));
    assert_eq!(worn["beds_pa_per_m"], serde_json::json!([null, null]));
    let largest = |found: &Value| found["curve"]["largest_force_over_weight"].as_f64().expect("a number");
    assert!(largest(&worn) < largest(&sharp));
}

#[test]
fn rejects_what_is_no_push() {
    let folder = folder();
    std::fs::write(folder.path().join("m.csv"), "x,y\n1,2\n").expect("written");
    std::fs::write(folder.path().join("n.csv"), "displacement_m,force_n\n0.1,many\n").expect("written");
    for (arguments, told) in [
        (&["--bed", "-1"][..], &["--bed", "found -1", "1e6 to 1e15 Pa/m"][..]),
        (&["--measured", "m.csv"], &["m.csv", "the columns x, y", "displacement_over_thickness"]),
        (&["--measured", "n.csv"], &["n.csv:2", "\"many\" for force_n", "a finite number"]),
        (&["--measured", "no.csv"], &["no.csv"]),
        (&["--plot", "push.gif"], &["--plot", "push.gif", ".svg"]),
        (&["--at", "side"], &["side"]),
    ] {
        let output = mrbd(folder.path(), &[&["push", "wall.toml"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(told.iter().all(|part| message.contains(part)), "{told:?} in: {message}");
    }
}

#[test]
fn verified_a_measured_push_speaks_against_the_bed_of_the_released_wall() {
    let Some(data) = shared::folder("real/griffith_2004") else { return };
    let folder = folder();
    let measured = data.join("static_push_twin.csv");
    let measured = measured.to_str().expect("a path");
    let rms = |bed: Option<&str>| {
        let bed = bed.map_or(vec![], |bed| vec!["--bed", bed]);
        let run = ["push", "wall.toml", "--at", "crack", "--json", "--measured", measured];
        let found = json(folder.path(), &[&run[..], &bed].concat());
        found["measured"]["rms_over_weight"].as_f64().expect("a number")
    };
    // Its initial slope means 2.7e8 Pa/m; the bed that the released wall needs leaves over twice as much.
    let [rigid, pushed, released] = [rms(None), rms(Some("2.7e8")), rms(Some("4e7"))];
    assert!(pushed < 0.5 * rigid && pushed < 0.5 * released, "{rigid} {pushed} {released}");
}

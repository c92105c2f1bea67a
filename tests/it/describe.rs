//! `mrbd describe` and slips in files, as a user meets them.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::pipeline_cli::{mrbd, stdout};

const TABLE_WALL: &str = include_str!("../../inputs/walls/table_wall.toml");

fn folder_with(wall: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("wall.toml"), wall).expect("written");
    folder
}

/// What stderr says of arguments that are refused with 2.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = mrbd(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    message
}

#[test]
fn published_the_table_wall_is_described_by_its_table_1() {
    let folder = folder_with(TABLE_WALL);
    let json: Value =
        serde_json::from_str(&stdout(&mrbd(folder.path(), &["describe", "wall.toml", "--json"])))
            .expect("JSON");
    let number = |pointer: &str| json.pointer(pointer).and_then(Value::as_f64).expect(pointer);
    for (pointer, expected) in [
        ("/weight_n", 3614.0 * 9.81),
        ("/density_kg_m3", 3614.0 / (0.291 * 3.984 * 1.5)),
        ("/slenderness", 3.984 / 0.291),
        ("/alpha_rad", (0.271_f64 / 3.984).atan()),
        ("/lower/alpha_rad", (0.271_f64 / 2.191).atan()),
        ("/upper/alpha_rad", (0.281_f64 / 1.793).atan()),
        ("/upper/crushed_m", 0.010),
        ("/top/period_s", std::f64::consts::TAU * (842.0_f64 / 37e3).sqrt()),
        // Moments of the weights about a corner of the ground over those of the horizontal forces, in g.
        ("/opening/ground_g", (3614.0 + 179.0) * 0.271 / 2.0 / ((3614.0 / 2.0 + 842.0) * 3.984)),
    ] {
        // Roundings of a handful of products; the height of the upper body is a difference of two numbers near 3.
        assert!(
            (number(pointer) / expected - 1.0).abs() < 1e-12,
            "{pointer}: {} for {expected}",
            number(pointer)
        );
    }
    assert_eq!(json["questions"], Value::Array(Vec::new()));
    let text = stdout(&mrbd(folder.path(), &["describe", "wall.toml", "--plot", "wall.SVG"]));
    for part in ["h/b = 13.69", "35.45 kN", "2078 kg/m3", "begins to rock", "0.948 s", "law whole"] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let drawing = fs::read_to_string(folder.path().join("wall.SVG")).expect("drawn");
    // Two joints with two corners each.
    assert_eq!((drawing.matches("<circle").count(), drawing.contains("h₁ 2.191 m")), (4, true));
    let message = refused(folder.path(), &["describe", "wall.toml", "--plot", "wall.jpg"]);
    assert!(message.contains("--plot") && message.contains(".svg"), "{message}");
}

#[test]
fn rejects_slips_in_a_wall_before_any_run() {
    let folder = folder_with(&TABLE_WALL.replace("thickness_m = 0.291", "thickness_m = 291"));
    let message = refused(folder.path(), &["simulate", "wall.toml", "--tail", "1"]);
    let whole = "mrbd: wall.toml: wall.thickness_m: found 291; allowed: 0.05 to 5 m; did you mean 0.291 m (291 mm)?\n";
    assert_eq!(message, whole);
    let folder = folder_with(&TABLE_WALL.replace("mass_kg = 3614.0", "density_kg_m3 = 1.8"));
    let message = refused(folder.path(), &["describe", "wall.toml"]);
    assert!(message.contains("did you mean 1800 kg/m3 (1.8 t/m3)?"), "{message}");
}

#[test]
fn regress_a_soft_floor_is_questioned_and_simulated() {
    let slip = ("stiffness_n_per_m = 37000.0", "stiffness_n_per_m = 37.0");
    let wall = TABLE_WALL.replace(slip.0, slip.1) + "\n[initial]\ntheta1_rad = 0.01\ntheta2_rad = 0.01\n";
    assert!(wall.contains(slip.1));
    let folder = folder_with(&wall);
    for command in [&["describe", "wall.toml"][..], &["simulate", "wall.toml", "--tail", "0.1"]] {
        let output = mrbd(folder.path(), command);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && message.contains("did you mean 37000 N/m (37 kN/m)"), "{message}");
    }
}

#[test]
fn rejects_threads_that_no_machine_serves() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    stdout(&mrbd(folder.path(), &["init"]));
    let message = refused(folder.path(), &["run", "pipeline.toml", "--threads", "100000"]);
    assert!(message.contains("--threads: found 100000; allowed: 1 to "), "{message}");
}

#[test]
fn regress_a_facade_with_a_floor_is_written_described_and_without_a_question() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = mrbd(folder.path(), &["init", "né w", "--floor", "parallel"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("cd 'né w'"), "{output:?}");
    assert!(stdout(&output).lines().any(|line| line.ends_with("facade.toml")));
    let described = mrbd(&folder.path().join("né w"), &["describe", "facade.toml"]);
    assert!(described.stderr.is_empty(), "{described:?}");
    assert!(stdout(&described).contains("k_d = 1200000 N/m"));
}

#[test]
fn rejects_folders_that_cannot_be_with_the_code_of_bad_input() {
    let folder = folder_with(TABLE_WALL);
    refused(folder.path(), &["init", "wall.toml"]);
    refused(folder.path(), &["describe", "wall.toml", "--plot", "nodir/wall.svg"]);
}

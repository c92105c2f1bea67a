//! `mrbd simulate` as a user meets it: what it prints, what it writes, what it refuses.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const TABLE_WALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/walls/table_wall.toml");

fn mrbd(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mrbd")).args(arguments).output().expect("mrbd starts")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A folder with a record of two sines that rock the table wall.
fn folder_with_record() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("record.csv");
    let mut text = String::from("time_s,acceleration_m_s2\n");
    for k in 0..1000 {
        let t = f64::from(k) * 0.01;
        text += &format!("{t:.2},{:.6}\n", 0.9 * (9.0 * t).sin() + 0.9 * (23.0 * t).sin());
    }
    std::fs::write(&path, text).expect("the record");
    (folder, path)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

/// The table wall with one line of its file replaced.
fn wall_with(folder: &TempDir, old: &str, new: &str) -> PathBuf {
    let original = std::fs::read_to_string(TABLE_WALL).expect("the table wall");
    assert!(original.contains(old), "{old}");
    let path = folder.path().join("wall.toml");
    std::fs::write(&path, original.replacen(old, new, 1)).expect("the wall");
    path
}

fn rejects(arguments: &[&str], told: &[&str]) {
    let output = mrbd(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty(), "data on stdout");
    for part in told {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

#[test]
fn analytic_json_and_history_agree() {
    let (folder, record) = folder_with_record();
    let history = folder.path().join("history.csv");
    let output =
        mrbd(&["simulate", TABLE_WALL, "--record", text(&record), "--json", "--history", text(&history)]);
    assert!(output.status.success(), "{}", stderr(&output));
    let result: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(result["outcome"], "stood");
    let largest = result["theta1_max_rad"].as_f64().expect("a number");
    let mut rows = csv::Reader::from_path(&history).expect("the history");
    let header: Vec<String> = rows.headers().expect("a header").iter().map(str::to_owned).collect();
    assert_eq!(header[..4], ["time_s", "theta1_rad", "theta2_rad", "pattern"]);
    let rows: Vec<(f64, f64, f64, String)> = rows.deserialize().map(|row| row.expect("a row")).collect();
    // 999 steps of record and 5 s of free motion at 0.01 s, and the first row.
    assert_eq!(rows.len(), 1500);
    let sampled = rows.iter().map(|row| row.1.abs()).fold(0.0, f64::max);
    // A true maximum is at least the largest sample; over 0.005 s beside it the rotation falls by less than a hundredth.
    assert!(largest >= sampled && sampled > 0.99 * largest, "{largest} against {sampled}");
    assert!(largest > 1e-3, "the record must rock the wall");
    let times: f64 =
        result["pattern_time_s"].as_object().expect("an object").values().filter_map(Value::as_f64).sum();
    // A sum of some thousand steps.
    assert!((times - 14.99).abs() < 1e-9, "{times}");
}

#[test]
fn analytic_parquet_history_has_the_rows_of_the_csv() {
    let (folder, record) = folder_with_record();
    let [csv, parquet] = ["h.csv", "h.parquet"].map(|name| folder.path().join(name));
    for history in [&csv, &parquet] {
        let output = mrbd(&["simulate", TABLE_WALL, "--record", text(&record), "--history", text(history)]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let file = std::fs::File::open(&parquet).expect("the history");
    let reader =
        parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder::try_new(file).expect("Parquet");
    let rows = reader.metadata().file_metadata().num_rows();
    let units: Vec<&str> = reader.schema().fields().iter().map(|field| &*field.metadata()["unit"]).collect();
    assert_eq!(units, ["s", "rad", "rad", ""]);
    assert!(reader.schema().fields().iter().all(|field| !field.metadata()["description"].is_empty()));
    assert_eq!(rows as usize, csv::Reader::from_path(&csv).expect("the history").records().count());
}

#[test]
fn analytic_uncracked_wall_turns_as_one() {
    let (folder, record) = folder_with_record();
    let wall = wall_with(&folder, "crack_height_m = 2.191", "");
    let output = mrbd(&["simulate", text(&wall), "--record", text(&record), "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let result: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(result["theta1_max_rad"], result["theta2_max_rad"]);
    assert_eq!(result["friction_demand_crack"], Value::Null);
    for pattern in ["1a", "2a", "4a", "1b", "2b", "4b"] {
        assert_eq!(result["pattern_time_s"][pattern], 0.0, "pattern {pattern}");
    }
}

#[test]
fn rejects_walls_that_cannot_be() {
    let (folder, record) = folder_with_record();
    let cases = [
        ("crack_height_m = 2.191", "crack_height_m = 4.5", "wall.crack_height_m"),
        ("mass_kg = 179.0", "mass_kg = -1.0", "diaphragm.mass_kg"),
        ("thickness_m = 0.291", "thickness_m = nan", "wall.thickness_m"),
        ("thickness_m = 0.291", "thickness_m = \"thick\"", "wall.thickness_m"),
        ("thickness_m = 0.291", "thicknes_m = 0.291", "thicknes_m"),
        ("length_m = 1.5", "", "length_m"),
        ("lower_width_m = 0.271", "lower_width_m = 0.4", "corners.lower_width_m"),
        ("stiffness_n_per_m = 37000.0", "stiffness_n_per_m = 37e20", "diaphragm.stiffness_n_per_m"),
        ("rotation_ratio = 2.0", "rotation_ratio = 1e6", "collapse.rotation_ratio"),
        ("law = \"whole\"", "law = \"hole\"", "restitution.law"),
        ("[wall]", "[wall", "wall.toml:"),
    ];
    for (old, new, told) in cases {
        let wall = wall_with(&folder, old, new);
        rejects(&["simulate", text(&wall), "--record", text(&record)], &["wall.toml", told, "allowed"]);
    }
}

#[test]
fn rejects_unknown_effects_and_their_keys() {
    let (folder, record) = folder_with_record();
    for (effect, told) in [
        ("kind = \"magic\"", "viscous_damping"),
        ("kind = \"viscous_damping\"\ncoefficient = 3.0", "coefficient_n_s_per_m"),
    ] {
        let wall = wall_with(&folder, "[collapse]", &format!("[[effects]]\n{effect}\n\n[collapse]"));
        rejects(&["simulate", text(&wall), "--record", text(&record)], &["wall.toml", told]);
    }
}

#[test]
fn analytic_the_examples_of_the_catalogue_are_effects_that_run() {
    let listed = mrbd(&["effects"]);
    assert!(listed.status.success() && listed.stderr.is_empty());
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let examples: Vec<String> = listed
        .split("\n\n\n")
        .map(|kind| kind.lines().filter_map(|line| line.strip_prefix("    ")).collect::<Vec<_>>().join("\n"))
        .collect();
    let kinds: Value = serde_json::from_slice(&mrbd(&["effects", "--json"]).stdout).expect("JSON");
    assert_eq!(kinds.as_array().expect("a list").len(), examples.len());
    let (folder, record) = folder_with_record();
    // All of them at once, but for the laws of a joint, of which it has one.
    let laws = ["compliant_joint", "trilinear_joint", "crushing_joint", "rounded_edges"];
    let is_of = |example: &str, law: &str| example.contains(&format!("kind = \"{law}\""));
    for law in laws {
        let others = |example: &&String| is_of(example, law) || !laws.iter().any(|law| is_of(example, law));
        let together: Vec<&str> = examples.iter().filter(others).map(String::as_str).collect();
        assert_eq!(together.len(), examples.len() - 3, "{law}");
        let wall = wall_with(&folder, "[collapse]", &format!("{}\n\n[collapse]", together.join("\n\n")));
        let output = mrbd(&["simulate", text(&wall), "--record", text(&record), "--json"]);
        assert!(output.status.success(), "{}", stderr(&output));
        let results: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(results["effects"].as_array().expect("a list").len(), together.len());
    }
    rejects(&["effects", "magic"], &["magic", "`coulomb_friction`"]);
}

#[test]
fn analytic_histories_show_what_sensors_read_beside_the_truth() {
    let (folder, record) = folder_with_record();
    let sensors = "[[effects]]\nkind = \"sensor_gain\"\nbody = \"lower\"\ngain = 2.0\n\n\
                   [[effects]]\nkind = \"sensor_offset\"\nbody = \"both\"\noffset_rad = 0.25\n\n[collapse]";
    let wall = wall_with(&folder, "[collapse]", sensors);
    let [read, plain] = ["read.csv", "plain.csv"].map(|name| folder.path().join(name));
    for (wall, history) in [(text(&wall), &read), (TABLE_WALL, &plain)] {
        let output =
            mrbd(&["simulate", wall, "--record", text(&record), "--json", "--history", text(history)]);
        assert!(output.status.success(), "{}", stderr(&output));
        let results: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(results.get("sensors").is_some(), history == &read);
    }
    let [read, plain] = [read, plain].map(|path| std::fs::read_to_string(path).expect("a history"));
    let mut rows = read.lines().zip(plain.lines());
    let (header, plain_header) = rows.next().expect("a header");
    assert_eq!(header, format!("{plain_header},theta1_true_rad,theta2_true_rad"));
    for (row, plain) in rows {
        let (row, plain): (Vec<&str>, Vec<&str>) = (row.split(',').collect(), plain.split(',').collect());
        assert_eq!((row[0], row[3], row[4], row[5]), (plain[0], plain[3], plain[1], plain[2]));
        let number = |text: &str| text.parse::<f64>().expect("a number");
        assert_eq!(number(row[1]), 2.0 * number(plain[1]) + 0.25);
        assert_eq!(number(row[2]), number(plain[2]) + 0.25);
    }
}

#[test]
fn rejects_options_that_make_no_sense() {
    let (folder, record) = folder_with_record();
    let record = text(&record);
    rejects(&["simulate", "missing.toml", "--record", record], &["missing.toml"]);
    rejects(&["simulate", TABLE_WALL, "--record", "missing.csv"], &["missing.csv"]);
    rejects(&["simulate", TABLE_WALL], &["--record", "[initial]"]);
    rejects(&["simulate", TABLE_WALL, "--record", record, "--tolerance", "0"], &["--tolerance", "1e-13"]);
    rejects(&["simulate", TABLE_WALL, "--record", record, "--tail", "-1"], &["--tail"]);
    rejects(&["simulate", TABLE_WALL, "--record", record, "--scale", "inf"], &["--scale"]);
    rejects(
        &["simulate", TABLE_WALL, "--record", record, "--capture-velocity", "-1"],
        &["--capture-velocity"],
    );
    let nowhere = folder.path().join("no/folder/h.csv");
    rejects(
        &["simulate", TABLE_WALL, "--record", record, "--history", text(&nowhere)],
        &["h.csv", "--history"],
    );
    let before = std::fs::read(record).expect("the record");
    for option in ["--history", "--plot"] {
        rejects(&["simulate", TABLE_WALL, "--record", record, option, record], &[option, "which is read"]);
    }
    assert_eq!(std::fs::read(record).expect("the record"), before);
    let odd = folder.path().join("h.xlsx");
    rejects(&["simulate", TABLE_WALL, "--record", record, "--history", text(&odd)], &["h.xlsx", ".parquet"]);
}

#[test]
fn rejects_vertical_records_at_another_step() {
    let (folder, record) = folder_with_record();
    let vertical = folder.path().join("up.csv");
    std::fs::write(&vertical, "time_s,acceleration_m_s2\n0.000,0.0\n0.005,1.0\n0.010,0.5\n")
        .expect("the record");
    let arguments = ["simulate", TABLE_WALL, "--record", text(&record), "--vertical", text(&vertical)];
    rejects(&arguments, &["up.csv", "0.005", "0.01"]);
}

/// The wall and the record of `mrbd init`, a factor on the record, and one line of the wall's file replaced.
fn starter_run(scale: &str, (old, new): (&str, &str), further: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let wall = include_str!("../../src/cli/starter/wall.toml");
    assert!(wall.contains(old), "{old}");
    let path = folder.path().join("wall.toml");
    std::fs::write(&path, wall.replacen(old, new, 1)).expect("the wall");
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/records/emilia7/generated_4_600ya.csv");
    let output =
        mrbd(&[&["simulate", text(&path), "--record", record, "--scale", scale][..], further].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    output
}

fn starter_json(scale: &str, change: (&str, &str)) -> Value {
    serde_json::from_slice(&starter_run(scale, change, &["--json"]).stdout).expect("JSON")
}

const SAME: (&str, &str) = ("37e3", "37e3");

#[test]
fn regress_an_outcome_that_flips_is_undecided() {
    // The run falls at 1e-6 and stands at 1e-10; a millionth more or less on the record makes it stand.
    let result = starter_json("3.4", SAME);
    let ensemble = &result["ensemble"];
    assert_eq!(ensemble["verdict"], "undecided", "{ensemble}");
    let share = ensemble["collapsed_share"].as_f64().expect("a share");
    assert!(share > 0.0 && share < 1.0, "{share}");
    assert_eq!(ensemble["members"], 4, "the first four tell it");
    let told = String::from_utf8_lossy(&starter_run("3.4", SAME, &[]).stdout).into_owned();
    assert!(told.contains("\nUndecided: "), "{told}");
}

/// A wall that is said to stand, or to fall, does so at whatever tolerance of the solver.
#[test]
fn regress_no_outcome_that_flips_with_the_tolerance_is_called_decided() {
    let mut flips = 0;
    for scale in ["2.85", "3.05", "3.2", "3.35", "3.4", "3.5", "3.6", "3.65", "3.75", "3.85", "4.05"] {
        let outcome = |k: i32| {
            let tolerance = format!("{:e}", 10f64.powf(-6.0 - 0.5 * f64::from(k)));
            let alone = starter_run(scale, SAME, &["--json", "--alone", "--tolerance", &tolerance]);
            let alone: Value = serde_json::from_slice(&alone.stdout).expect("JSON");
            alone["collapsed"].as_bool().expect("an outcome")
        };
        let outcomes: Vec<bool> = (0..=12).map(outcome).collect();
        let ensemble = &starter_json(scale, SAME)["ensemble"];
        let flipped = outcomes.contains(&true) && outcomes.contains(&false);
        flips += u32::from(flipped);
        let decided = if outcomes[0] { "collapsed" } else { "stood" };
        assert!(!flipped || ensemble["verdict"] == "undecided", "{scale}: {outcomes:?}, {ensemble}");
        assert!([decided, "undecided"].contains(&ensemble["verdict"].as_str().expect("a word")));
    }
    // Of these scales, those at which one more run or one less decides.
    assert!(flips >= 4, "{flips}");
}

#[test]
fn regress_a_chaotic_run_is_told_without_digits_that_do_not_hold() {
    let told = String::from_utf8_lossy(&starter_run("3.5", SAME, &[]).stdout).into_owned();
    assert!(told.contains("\nUndecided: ") && told.contains(" of 12 runs collapsed"), "{told}");
    for line in told.lines().filter(|line| line.contains("largest") || line.starts_with("events")) {
        assert!(line.contains(" to "), "{line}");
    }
}

#[test]
fn regress_a_tame_run_holds_to_its_digits() {
    let result = starter_json("2", SAME);
    let ensemble = &result["ensemble"];
    assert_eq!(
        (&ensemble["verdict"], &result["model_applies"]),
        (&"stood".into(), &true.into()),
        "{ensemble}"
    );
    let digits = ensemble["digits"]["theta1_max_over_alpha1"].as_u64().expect("digits");
    assert!(digits >= 2, "{ensemble}");
    // The run lies within its own ensemble.
    let run = result["theta1_max_over_alpha1"].as_f64().expect("a number");
    let ends: [f64; 2] =
        serde_json::from_value(ensemble["theta1_max_over_alpha1"].clone()).expect("an interval");
    assert!(ends[0] <= run && run <= ends[1] && ends[0] < ends[1], "{run} in {ends:?}");
    // Alone it is the same run, and says nothing of others.
    let alone = starter_run("2", SAME, &["--json", "--alone"]);
    let mut alone: Value = serde_json::from_slice(&alone.stdout).expect("JSON");
    assert_eq!(alone["ensemble"], Value::Null);
    alone["ensemble"] = ensemble.clone();
    assert_eq!(alone, result);
}

#[test]
fn regress_a_floor_that_no_record_can_move_is_beyond_the_model() {
    let result = starter_json("3.5", ("37e3", "1e11"));
    assert_eq!(result["model_applies"], false);
    let reasons = result["beyond_model"].to_string();
    for reason in ["friction", "tensions", "period"] {
        assert!(reasons.contains(reason), "{reason} in {reasons}");
    }
    let told = starter_run("3.5", ("37e3", "1e11"), &["--alone"]).stdout;
    assert!(String::from_utf8_lossy(&told).contains("The model does not apply: "));
}

//! `mrbd records` as a user meets it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use mrbd_records::{Suite, formats_in_words};

fn mrbd(arguments: &[&str]) -> Output {
    let root = env!("CARGO_MANIFEST_DIR");
    let arguments = ["records"].iter().chain(arguments);
    Command::new(env!("CARGO_BIN_EXE_mrbd")).current_dir(root).args(arguments).output().expect("mrbd starts")
}

fn accepted(arguments: &[&str]) -> String {
    let output = mrbd(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// What stderr says of arguments that are refused with 2.
fn refused(arguments: &[&str]) -> String {
    let output = mrbd(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty() || arguments[0] == "import", "{arguments:?} prints data and fails");
    message
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn at(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().expect("UTF-8").to_owned()
}

const EMILIA: &str = "inputs/records/emilia7/suite.toml";
const SITE: &str = "inputs/site_mirandola.toml";

fn emilia(id: usize, name: &str) -> String {
    format!("inputs/records/emilia7/generated_{id}_{name}.csv")
}

#[test]
fn analytic_describe_prints_measures_as_table_and_as_json() {
    let table = accepted(&["describe", "--suite", EMILIA]);
    assert_eq!(table.lines().count(), 8, "{table}");
    assert!(table.starts_with("record") && table.contains("PGV m/s"), "{table}");
    let json: Value =
        serde_json::from_str(&accepted(&["describe", "--suite", EMILIA, "--json"])).expect("JSON");
    let suite = Suite::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(EMILIA)).expect("valid");
    for (said, record) in json.as_array().expect("a list").iter().zip(&suite.records) {
        assert_eq!(said["intensity"]["pgv_m_s"].as_f64(), Some(record.intensity.pgv_m_s));
        assert_eq!((said["scale"].as_f64(), said["generated"].as_bool()), (Some(record.scale), Some(true)));
    }
}

#[test]
fn analytic_convert_keeps_every_bit() {
    let folder = folder();
    let (file, out) = (emilia(3, "602ya"), at(&folder, "out.csv"));
    accepted(&["convert", &file, &out]);
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    assert_eq!(std::fs::read(&out).expect("written"), std::fs::read(root.join(file)).expect("kept"));
    let again = refused(&["convert", &emilia(3, "602ya"), &out]);
    assert!(again.contains("exists"), "{again}");
}

#[test]
fn analytic_check_says_whether_a_suite_is_compatible() {
    let text = accepted(&["check", EMILIA, "--site", SITE]);
    assert!(text.contains("emilia7") && text.contains(", compatible"), "{text}");
    let json: Value =
        serde_json::from_str(&accepted(&["check", EMILIA, "--site", SITE, "--json"])).expect("JSON");
    assert_eq!(json["compatible"].as_bool(), Some(true));
    let output = mrbd(&["check", EMILIA, "--site", SITE, "--above", "0.01", "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((json["compatible"].as_bool(), output.status.code()), (Some(false), Some(1)));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("emilia7") && told.contains("+1.0 %"), "{told}");
}

#[test]
fn analytic_select_finds_the_suite_that_was_hidden_among_others() {
    // Records of the generated suite beside tenfold longer waves: only the former follow the code.
    let folder = folder();
    for (id, name) in [(1, "879xa"), (2, "879ya"), (5, "335ya")] {
        accepted(&["convert", &emilia(id, name), &at(&folder, &format!("good{id}.csv"))]);
    }
    for i in 0..4 {
        let (period, out) = (format!("{}", 4 + i), at(&folder, &format!("pulse{i}.csv")));
        accepted(&[
            "pulse",
            "one-sine",
            "--amplitude",
            "1",
            "--period",
            &period,
            "--dt",
            "0.01",
            "--out",
            &out,
        ]);
    }
    let (source, out) = (folder.path().to_str().expect("UTF-8"), at(&folder, "chosen/suite.toml"));
    let bounds = ["--below", "-0.3", "--above", "0.5", "--count", "3", "--most-of-event", "1"];
    let text = accepted(&[&["select", source, "--site", SITE, "--out", &out], &bounds[..]].concat());
    assert!(text.lines().nth(1).is_some_and(|best| best.starts_with("good1 good2 good5")), "{text}");
    let suite = Suite::load(Path::new(&out)).expect("the suite that was written loads");
    assert_eq!(suite.records.len(), 3);
    // Half of the file name tells the event: then good1, good2 and good5 are of one, and at most one may be taken.
    let one_event = ["--event-prefix", "4"];
    let message = refused(&[&["select", source, "--site", SITE], &bounds[..], &one_event[..]].concat());
    assert!(message.contains("no suite of 3 among 7 records"), "{message}");
}

#[test]
fn analytic_import_checks_the_peaks_of_the_table_and_writes_the_suite() {
    let folder = folder();
    let (first, sixth) = (format!("1={}", emilia(1, "879xa")), format!("6={}", emilia(6, "170xa")));
    let vertical = format!("1={}", emilia(7, "151ya"));
    let out = at(&folder, "mine");
    accepted(&["import", "--record", &first, "--record", &sixth, "--vertical", &vertical, "--out", &out]);
    let suite = Suite::load(&folder.path().join("mine/suite.toml")).expect("valid");
    let [one, six] = &suite.records[..] else { panic!("two records") };
    assert!(!suite.generated && one.vertical.is_some() && six.vertical.is_none());
    assert_eq!((one.id, one.scale, six.id, six.scale), (1, 0.77, 6, 2.85));
    let swapped = format!("1={}", emilia(6, "170xa"));
    let message = refused(&["import", "--record", &swapped, "--out", &at(&folder, "wrong")]);
    assert!(message.contains("pga_g") && !folder.path().join("wrong/suite.toml").exists(), "{message}");
}

#[test]
fn regress_generate_without_a_table_works_anywhere_and_takes_the_papers() {
    let folder = folder();
    let output = Command::new(env!("CARGO_BIN_EXE_mrbd"))
        .current_dir(folder.path())
        .args(["records", "generate", "--out", "made"])
        .output()
        .expect("mrbd starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let named = at(&folder, "named");
    accepted(&["generate", "--table", "inputs/table4.toml", "--out", &named]);
    for entry in std::fs::read_dir(&named).expect("written") {
        let path = entry.expect("readable").path();
        let made = folder.path().join("made").join(path.file_name().expect("a name"));
        assert_eq!(std::fs::read(&made).expect("written"), std::fs::read(&path).expect("written"));
    }
}

#[test]
fn regress_help_lists_the_formats_of_the_table() {
    let help = accepted(&["--help"]);
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains(&formats_in_words("or")), "{help}");
}

#[test]
fn analytic_pulse_writes_a_record_that_reads_back() {
    let folder = folder();
    let out = at(&folder, "pulse.csv");
    accepted(&["pulse", "half-sine", "--amplitude", "2.5", "--period", "1", "--dt", "0.01", "--out", &out]);
    let json: Value = serde_json::from_str(&accepted(&["describe", &out, "--json"])).expect("JSON");
    assert_eq!((json[0]["samples"].as_u64(), json[0]["step_s"].as_f64()), (Some(51), Some(0.01)));
    assert_eq!(json[0]["intensity"]["pga_m_s2"].as_f64(), Some(2.5));
}

#[test]
fn rejects_what_makes_no_sense() {
    let folder = folder();
    let out = at(&folder, "x.csv");
    let record = emilia(3, "602ya");
    for (arguments, word) in [
        (&["describe", "none.csv"][..], "none.csv"),
        (&["convert", &record, &at(&folder, "x.AT2")], "a .csv file"),
        (&["describe", "--suite", EMILIA, "--dt", "0.01"], "--suite"),
        (&["check", EMILIA, "--site", SITE, "--from", "3"], "--from"),
        (&["check", EMILIA, "--site", EMILIA], "emilia7"),
        (&["pulse", "ricker", "--amplitude", "-1", "--period", "1", "--out", &out], "amplitude"),
        (&["generate", "--out", "inputs/records/emilia7"], "holds a suite"),
        (&["select", EMILIA, "--site", SITE, "--count", "0"], "--count"),
        (&["convert", &record, &at(&folder, "no/x.csv")], "OUT: found"),
        (&["convert", &record, "Cargo.toml/x.csv"], "OUT: found Cargo.toml/x.csv"),
        (
            &["pulse", "ricker", "--amplitude", "1", "--period", "1", "--out", &at(&folder, "no/x.csv")],
            "--out: found",
        ),
        (&["generate", "--out", "Cargo.toml"], "--out: found Cargo.toml"),
        (&["generate", "--table", "none.toml", "--out", &out], "none.toml"),
        (&["import", "--record", "9=x.csv", "--out", &out], "a row of the table"),
        (&["import", "--record", "x.csv", "--out", &out], "ROW=FILE"),
    ] {
        let message = refused(arguments);
        assert!(message.contains(word), "{arguments:?}: {message}");
    }
}

#[test]
fn analytic_a_table_of_a_spreadsheet_is_read_by_its_columns() {
    let folder = folder();
    let (table, out) = (at(&folder, "logger.csv"), at(&folder, "out.csv"));
    std::fs::write(&table, "Time;Acc\n0,00;0,1\n0,01;-0,2\n0,02;0,05\n").expect("written");
    let message = refused(&["convert", &table, &out]);
    assert!(message.contains("--columns 1,2 --unit g") && message.contains("--decimal-comma"), "{message}");
    accepted(&["convert", &table, &out, "--columns", "Time,Acc", "--unit", "g", "--decimal-comma"]);
    let text = std::fs::read_to_string(&out).expect("written");
    let samples: Vec<f64> = text.lines().skip(1).map(|row| row[5..].parse().expect("a number")).collect();
    // A product with g: one rounding each.
    assert!(samples.iter().zip([0.1, -0.2, 0.05]).all(|(a, g)| (a / 9.81 - g).abs() < 1e-15), "{text}");
    let suite = at(&folder, "suite.toml");
    let keys = "columns = \"Time,Acc\"\ndecimal_comma = true\nunit = \"g\"\n";
    std::fs::write(&suite, format!("name = \"mine\"\n{keys}[[records]]\nid = 1\nfile = \"logger.csv\"\n"))
        .expect("written");
    let of_suite = Suite::load(Path::new(&suite)).expect("a suite");
    assert_eq!(of_suite.records[0].horizontal.acceleration_m_s2(), &samples[..]);
}

#[test]
fn analytic_a_record_on_a_floor_swings_with_the_building_and_at_its_foot_with_the_ground() {
    let folder = folder();
    let [ground, site, written] = ["ground.csv", "site.toml", "top.csv"].map(|name| at(&folder, name));
    accepted(&["pulse", "one-sine", "--amplitude", "2", "--period", "0.5", "--out", &ground]);
    std::fs::write(&site, "[site]\nag_g = 0.2\nf0 = 2.5\ntc_star_s = 0.3\nsoil = \"A\"\n").expect("written");
    let floor = |out: &str, height_ratio: &str| -> Vec<Value> {
        let building = ["--height-ratio", height_ratio, "--period", "0.5", "--storeys", "3"];
        let told = accepted(&[&["floor", &ground, out, "--site", &site, "--json"], &building[..]].concat());
        serde_json::from_str(&told).expect("JSON")
    };
    let number = |row: &Value, key: &str| row[key].as_f64().expect("a number");
    for row in floor(&at(&folder, "foot.csv"), "0") {
        // The same motion, cut into shorter straight steps, with zeros after it: a peak between points of the response
        // may be met more nearly, which is 0.3 % at most.
        let ratio = number(&row, "floor_m_s2") / number(&row, "ground_m_s2");
        assert!((ratio - 1.0).abs() < 0.003, "{row}");
    }
    let top = floor(&written, "1");
    let in_tune = top.iter().find(|row| row["period_s"] == 0.5).expect("a row at 0.5 s");
    assert!(number(in_tune, "floor_m_s2") > 2.0 * number(in_tune, "ground_m_s2"), "{in_tune}");
    // A_k S_e γ_1 of a single mode, and C7.2.11's a_p (1 + z/H) of the ground's.
    let spectrum = 0.2 * 9.81 * 2.5 * 0.3 / 0.5;
    let code = 1.1 / 0.05_f64.sqrt() * spectrum * (9.0 / 7.0) * 1.01_f64.sqrt();
    assert!((number(in_tune, "code_m_s2") / code - 1.0).abs() < 1e-12);
    assert!((number(in_tune, "framed_m_s2") / (0.2 * 9.81 * 2.0 * 4.0) - 1.0).abs() < 1e-12);
    // What is written is a record of its own, and nothing is written over.
    accepted(&["describe", &written]);
    let building = ["--height-ratio", "1.5", "--period", "0.5", "--storeys", "3"];
    assert!(refused(&[&["floor", &ground, &written], &building[..]].concat()).contains("which exists"));
    let told = refused(&[&["floor", &ground, &at(&folder, "x.csv")], &building[..]].concat());
    assert!(told.contains("building.height_ratio: found 1.5"), "{told}");
}

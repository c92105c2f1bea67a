//! `mrbd margin`: the factor on each record that takes a wall beyond a limit.

use std::path::Path;

use serde_json::Value;

use crate::pipeline_cli::{mrbd, stdout};

const WALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/cli/starter/wall.toml");

/// A suite of one record of `inputs/records/emilia7`.
fn suite(folder: &Path) {
    let records = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/records/emilia7");
    let name = "generated_3_602ya.csv";
    std::fs::copy(records.join(name), folder.join(name)).expect("copied");
    let pulse = "[[records]]\nid = 2\nname = \"pulse\"\nevent = \"\"\nscale = 1.0\nstep_s = 0.005\n\
                 pulse = { kind = \"one_sine\", amplitude_m_s2 = 1.0, period_s = 0.8 }\n";
    let text = format!(
        "name = \"two\"\ngenerated = true\n[[records]]\nid = 1\nfile = \"{name}\"\nevent = \"\"\nscale = 1.0\n{pulse}"
    );
    std::fs::write(folder.join("suite.toml"), text).expect("written");
}

#[test]
fn analytic_the_factor_found_exceeds_the_limit_and_the_one_below_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    suite(folder.path());
    let search = ["margin", WALL, "--suite", "suite.toml", "--limit", "0.3", "--growth", "1.5", "--json"];
    let found: Value = serde_json::from_str(&stdout(&mrbd(folder.path(), &search))).expect("JSON");
    let record = &found["records"][0];
    assert_eq!(record["status"], "exceeded", "{found}");
    let [below, above] = ["stood_scale", "scale"].map(|key| record[key].as_f64().expect("a factor"));
    assert!(below < above && above <= 1.01 * below, "{below} {above}");
    // The same runs by the command for one run.
    let rotation = |scale: f64| {
        let scale = scale.to_string();
        let run =
            ["simulate", WALL, "--record", "generated_3_602ya.csv", "--scale", &scale, "--json", "--alone"];
        let run: Value = serde_json::from_str(&stdout(&mrbd(folder.path(), &run))).expect("JSON");
        ["theta1_max_over_alpha1", "theta2_max_over_alpha2"]
            .map(|key| run[key].as_f64().expect("a number"))
            .into_iter()
            .fold(0.0, f64::max)
    };
    assert!(rotation(below) <= 0.3 && rotation(above) > 0.3, "{} {}", rotation(below), rotation(above));
    // Intensities grow with the factor.
    let pga_g = record["pga_g"].as_f64().expect("a number");
    let described = stdout(&mrbd(folder.path(), &["records", "describe", "generated_3_602ya.csv", "--json"]));
    let described: Value = serde_json::from_str(&described).expect("JSON");
    let of_record = described[0]["intensity"]["pga_g"].as_f64().expect("a number");
    // Rounding of one product.
    assert!((pga_g / (above * of_record) - 1.0).abs() < 1e-12, "{pga_g} {above} {of_record}");
}

#[test]
fn regress_a_margin_is_a_table_a_folder_and_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    suite(folder.path());
    let run = ["margin", WALL, "--suite", "suite.toml", "--limit", "0.3", "--growth", "1.5", "--out", "m"];
    let output = mrbd(folder.path(), &run);
    let table = stdout(&output);
    assert!(table.starts_with("record,status,scale,") && table.lines().count() == 3, "{table}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("pgv_m_s: median"));
    for file in ["manifest.json", "margin.json", "margin.parquet", "report.html"] {
        assert!(folder.path().join("m").join(file).is_file(), "{file}");
    }
    let page = std::fs::read_to_string(folder.path().join("m/report.html")).expect("a page");
    assert!(page.contains("<svg") && page.contains("are generated, not measured"));
    // A second run does not replace it unless it is to.
    assert_eq!(mrbd(folder.path(), &run).status.code(), Some(2));
}

#[test]
fn rejects_limits_and_ranges_that_make_no_sense() {
    let folder = tempfile::tempdir().expect("a folder");
    suite(folder.path());
    for (option, value, told) in [
        ("--limit", "2", "below 2"),
        ("--limit", "fall", "collapse"),
        ("--from", "0", "0 < from < to"),
        ("--growth", "1", "1.0001 to 10"),
        ("--bracket", "nan", "1.0001 to 10"),
        ("--tail", "-1", "0 or more"),
        ("--tolerance", "1e-14", "1e-13 to 1e-2"),
    ] {
        let output = mrbd(folder.path(), &["margin", WALL, "--suite", "suite.toml", option, value]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(option) && message.contains(told), "{message}");
    }
}

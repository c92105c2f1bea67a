//! Sweeps under several suites, and intensity measures: what they say, and what they refuse.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::drawn_support::{drawn, incremental, monte_carlo};
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

/// As many pulses as records tell how sure a conclusion is, and one more, in the place of the two of a small study.
fn with_records(folder: &Path, name: &str, records: u32) {
    let mut suite = format!("name = {name:?}\ngenerated = true\n");
    for id in 1..=records {
        let file = format!("{name}_{id}.csv");
        suite += &format!("[[records]]\nid = {id}\nfile = {file:?}\nevent = \"none\"\nmagnitude = 6.{id}\n");
        let peak = 2.0 + f64::from(id);
        let period_s = 0.4 + 0.1 * f64::from(id % 3);
        let sample = |k: u32| {
            let t = f64::from(k) * 0.01;
            let inside = t < 2.0 * period_s;
            format!(
                "{t:.2},{:.6}\n",
                if inside { peak * (std::f64::consts::TAU * t / period_s).sin() } else { 0.0 }
            )
        };
        let text: String = (0..300).map(sample).collect();
        fs::write(folder.join(file), format!("time_s,acceleration_m_s2\n{text}")).expect("written");
    }
    fs::write(folder.join("suite.toml"), suite).expect("written");
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = mrbd(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn regress_suites_side_by_side_have_shares_and_a_page() {
    let folder = study(&SMALL.replacen("name = \"base\"", "name = \"base\"\nmembers = 2", 1));
    let at = folder.path();
    for (name, records) in [("six", 6), ("two", 2)] {
        with_records(at, name, records);
        stdout(&mrbd(at, &["run", "study.toml", "--out", name]));
    }
    let told = stdout(&mrbd(at, &["suites", "six", "two", "--out", "page", "--json"]));
    let told: Value = serde_json::from_str(&told).expect("JSON");
    let [six, two] = [0, 1].map(|i| &told["suites"][i]);
    assert_eq!((six["records"].as_u64(), six["members"].as_u64()), (Some(6), Some(3)));
    // The study varies thickness and coefficients alone, each under one floor.
    let asked: Vec<&Value> = six["conclusions"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|told| told["verdict"] != "not in this study")
        .collect();
    assert!(!asked.is_empty());
    for conclusion in asked {
        let [holds, does_not] =
            ["holds_share", "does_not_share"].map(|key| conclusion[key].as_f64().expect("a share"));
        assert!(holds >= 0.0 && does_not >= 0.0 && holds + does_not <= 1.0, "{conclusion}");
        let by_records: Vec<u64> = conclusion["by_records"]
            .as_array()
            .expect("a list")
            .iter()
            .filter_map(|by| by["records"].as_u64())
            .collect();
        assert_eq!(by_records, [5, 6]);
    }
    assert!(two["conclusions"].as_array().expect("a list").iter().all(|told| told["holds_share"].is_null()));
    let page = fs::read_to_string(at.join("page/report.html")).expect("a page");
    assert!(page.contains("six, 6 generated") && page.contains("How many records"));
    assert!(fs::read_to_string(at.join("page/suites.csv")).expect("a table").lines().count() > 2);
}

#[test]
fn regress_medians_have_intervals_where_records_tell() {
    let folder = study(&SMALL.replacen("name = \"base\"", "name = \"base\"\nmembers = 2", 1));
    let at = folder.path();
    with_records(at, "six", 6);
    stdout(&mrbd(at, &["run", "study.toml", "--out", "six"]));
    let table = stdout(&mrbd(at, &["aggregate", "six", "--csv"]));
    let mut csv = csv::Reader::from_reader(table.as_bytes());
    let head = csv.headers().expect("a head").clone();
    let place = |name: &str| head.iter().position(|column| column == name).expect("a column");
    let (low, median, high) = (place("median_low"), place("median"), place("median_high"));
    let mut rows = 0;
    for row in csv.records().map(|row| row.expect("a row")) {
        let [low, median, high] = [low, median, high].map(|place| row[place].parse::<f64>());
        // A median that may be a collapse has no upper end, one that is has no number.
        if let (Ok(low), Ok(median), Ok(high)) = (low, median, high) {
            assert!(low <= median && median <= high, "{row:?}");
            rows += 1;
        }
    }
    assert!(rows > 10, "{rows}");
    // Members are no cases of their own, and no variants.
    assert!(!table.contains('~'), "{table}");
    let findings = fs::read_to_string(at.join("six/findings.csv")).expect("findings");
    assert!(
        findings
            .lines()
            .next()
            .expect("a head")
            .contains("at_hand,holds_share,does_not_share,records,members")
    );
}

#[test]
fn regress_quantiles_of_drawn_facades_have_intervals_where_records_tell() {
    let folder = study(&monte_carlo());
    let at = folder.path();
    let few = stdout(&mrbd(at, &["run", "study.toml", "--out", "two"]));
    assert!(!few.contains("90 % intervals"), "two records tell nothing\n{few}");
    with_records(at, "six", 6);
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "six"]));
    assert!(told.contains("90 % intervals of the medians") && told.contains(" to "), "{told}");
    let table = stdout(&mrbd(at, &["aggregate", "six", "--csv"]));
    let mut csv = csv::Reader::from_reader(table.as_bytes());
    let head = csv.headers().expect("a head").clone();
    let place = |name: &str| head.iter().position(|column| column == name).expect("a column");
    let mut rows = 0;
    for row in csv.records().map(|row| row.expect("a row")) {
        for name in ["q05", "q16", "q25", "median", "q75", "q84", "q95"] {
            let ends = [format!("{name}_low"), name.to_owned(), format!("{name}_high")];
            let [low, value, high] = ends.map(|name| row[place(&name)].parse::<f64>());
            // An end among falls has no number.
            if let (Ok(low), Ok(value), Ok(high)) = (low, value, high) {
                assert!(low <= value && value <= high, "{name} of {row:?}");
                rows += 1;
            }
        }
    }
    assert!(rows > 100, "{rows}");
    let page = stdout(&mrbd(at, &["report", "six"]));
    assert!(page.contains("report.html"), "{page}");
    let page = fs::read_to_string(at.join("six/report.html")).expect("a page");
    assert!(page.contains("Over façades and records, with 90 % intervals over draws of both"));
}

#[test]
fn rejects_what_are_no_whole_sweeps_of_different_suites() {
    let folder = study(SMALL);
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "a"]));
    assert!(refused(at, &["suites", "a", "a"]).contains("found suite \"pulses\" a second time"));
    assert!(refused(at, &["suites", "nowhere"]).contains("no manifest of a sweep"));
    fs::remove_dir_all(at.join("a/runs/record=pulse_1")).expect("removed");
    let told = refused(at, &["suites", "a"]);
    assert!(told.contains("unfinished") || told.contains("damaged, or gone"), "{told}");
    let drawn = study(&monte_carlo());
    stdout(&mrbd(drawn.path(), &["run", "study.toml", "--out", "b"]));
    assert!(refused(drawn.path(), &["suites", "b"]).contains("no manifest of a sweep"));
}

#[test]
fn regress_the_peak_foretells_what_grows_with_it() {
    let folder = study(&drawn("cloud", "[cloud]\nfrom = 0.5\nto = 2.0\n"));
    let at = folder.path();
    with_records(at, "six", 6);
    stdout(&mrbd(at, &["run", "study.toml", "--out", "cloud"]));
    let told = stdout(&mrbd(at, &["measures", "cloud", "--out", "page", "--json"]));
    let told: Value = serde_json::from_str(&told).expect("JSON");
    for floor in told["floors"].as_array().expect("a list") {
        let measures = floor["measures"].as_array().expect("a list");
        let of = |name: &str| {
            let found = measures.iter().find(|of| of["measure"] == name).expect("a measure");
            (found["efficiency"].as_f64().expect("a number"), found["best_share"].as_f64().expect("a share"))
        };
        assert!(
            of("pgv_m_s").0 < of("duration_5_95_s").0,
            "how long a pulse lasts tells less than how strong it is"
        );
        let all: f64 = measures.iter().filter_map(|of| of["best_share"].as_f64()).sum();
        assert!(all >= 1.0 - 1e-12, "some measure is the best in every draw: {all}");
        assert!(measures[0]["sufficiency"]["magnitude_p"].is_number());
        assert!(measures[0]["sufficiency"]["distance_p"].is_null(), "nobody knows the distance");
    }
    assert!(fs::read_to_string(at.join("page/report.html")).expect("a page").contains("standard deviation"));
}

#[test]
fn rejects_studies_that_tell_nothing_of_measures() {
    let few = study(&monte_carlo());
    stdout(&mrbd(few.path(), &["run", "study.toml", "--out", "out"]));
    assert!(
        refused(few.path(), &["measures", "out"]).contains("found a study of 2 records; allowed: 5 or more")
    );
    let sweep = study(SMALL);
    stdout(&mrbd(sweep.path(), &["run", "study.toml", "--out", "out"]));
    assert!(refused(sweep.path(), &["measures", "out"]).contains("monte_carlo, cloud or stripes"));
    let growing = study(&incremental());
    stdout(&mrbd(growing.path(), &["run", "study.toml", "--out", "out"]));
    assert!(refused(growing.path(), &["measures", "out"]).contains("monte_carlo, cloud or stripes"));
}

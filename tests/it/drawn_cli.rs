//! Studies of drawn façades as users meet them: run, stopped, looked at, checked, and their fragilities.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use mrbd::study::runs::SCHEMA_VERSION;

use crate::campaign::contents;
use crate::drawn_support::{drawn, incremental, monte_carlo, stripes};
use crate::pipeline_cli::{mrbd, stdout, study};

fn stderr(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Stripes up to where many of these walls fall under the pulses of 0.5 s.
fn strong_stripes() -> String {
    let table = "[stripes]\nmeasure = \"pgv_m_s\"\nlevels = [0.3, 0.6, 0.9, 1.2, 1.5, 1.8]\n";
    drawn("stripes", table).replace("count = 6", "count = 24")
}

#[test]
fn regress_a_study_of_each_kind_runs_from_pipeline_to_quantiles() {
    let cloud = drawn("cloud", "[cloud]\nfrom = 1.0\nto = 3.0\n");
    for (text, kind, runs) in [
        (monte_carlo(), "monte_carlo", 24),
        (cloud, "cloud", 24),
        (stripes(), "stripes", 72),
        (incremental(), "incremental", 48),
    ] {
        let folder = study(&text);
        let at = folder.path();
        let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
        assert!(told.contains("quantiles over façades and records") && told.contains("parallel"), "{told}");
        assert!(told.lines().all(|line| line.chars().count() <= 120), "tables fit a terminal\n{told}");
        let manifest = fs::read_to_string(at.join("out/manifest.json")).expect("a manifest");
        let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
        assert_eq!((manifest["kind"].as_str(), manifest["runs"].as_u64()), (Some(kind), Some(runs)));
        let version = u64::from(SCHEMA_VERSION);
        assert_eq!(
            (manifest["seed"].as_u64(), manifest["schema_version"].as_u64()),
            (Some(3), Some(version))
        );
        let cut = &manifest["study"]["truncated_probability"]["parallel"]["crack_height_ratio"];
        // 1 - Φ(ln(0.95/0.62)/β), β = ½ ln(0.73/0.52): 0.005934 by hand.
        assert!((cut.as_f64().expect("a probability") - 0.005934).abs() < 1e-6, "{cut}");
        assert_eq!(stdout(&mrbd(at, &["aggregate", "out"])), told, "the same from the files");
        let list = stdout(&mrbd(at, &["run", "study.toml", "--dry-run"]));
        assert_eq!(list.lines().count() as u64, 1 + runs);
        let status = stdout(&mrbd(at, &["status", "out"]));
        assert!(status.contains(kind) && status.contains(&format!("{runs} of {runs} runs")), "{status}");
        let replayed = mrbd(at, &["replay", "out", "17", "--history", "h.csv"]);
        assert!(stderr(&replayed).contains("the same bits as stored"), "{}", stderr(&replayed));
        assert!(at.join("h.csv").is_file());
        assert!(!at.join("out/findings.csv").exists(), "the source's conclusions are about a sweep");
    }
}

#[test]
fn regress_a_killed_study_of_incremental_analyses_ends_in_the_same_bits() {
    let folder = study(&incremental());
    let at = folder.path();
    let run = ["run", "study.toml", "--out", "out", "--block-runs", "2", "--threads", "2"];
    let clock = Instant::now();
    stdout(&mrbd(at, &run));
    let took = clock.elapsed();
    let whole = contents(&at.join("out"));
    fs::remove_dir_all(at.join("out")).expect("removed");
    let mut kills = 0;
    // Later and later, so that every resumed process begins from another state.
    for share in [0.2, 0.3, 0.4, 0.5, 0.6, 0.3, 0.2] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mrbd"));
        let command = command.current_dir(at).args(run).arg("--resume");
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts");
        std::thread::sleep(took.mul_f64(share));
        kills += u32::from(child.try_wait().expect("a child").is_none());
        child.kill().expect("killed, or gone");
        child.wait().expect("a child");
    }
    assert!(kills > 0, "nothing was killed at work");
    stdout(&mrbd(at, &[&run[..], &["--resume"]].concat()));
    assert_eq!(contents(&at.join("out")), whole);
}

#[test]
fn regress_fragilities_of_a_study_need_no_column_names() {
    let folder = study(&strong_stripes());
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    let few = ["fragility", "out", "--threshold", "0.5", "--threshold", "0.2", "--replicates", "50"];
    let model = ["--nrml", "f.xml", "--imt", "PGV", "--out", "curves.csv", "--json"];
    let told = stdout(&mrbd(at, &[&few[..], &model].concat()));
    let json: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    let groups = json["groups"].as_array().expect("groups");
    let keys: Vec<String> =
        groups.iter().map(|g| format!("{} {}", g["group"]["configuration"], g["group"]["limit"])).collect();
    let expected = ["0.2", "0.5", "collapse"]
        .map(|limit| ["perpendicular", "parallel"].map(|floor| format!("\"{floor}\" \"{limit}\"")));
    assert_eq!(keys, expected.concat());
    assert!(groups.iter().all(|group| group["trials"] == 288.0), "24 façades, 2 records, 6 stripes");
    let failures = |i: usize| groups[i]["failures"].as_f64().expect("a count");
    for floor in 0..2 {
        assert!(failures(floor) >= failures(2 + floor) && failures(2 + floor) >= failures(4 + floor));
    }
    let median = |i: usize| groups[i]["median"].as_f64();
    assert!(median(1) < median(3) && median(3) < median(5), "a higher limit takes more");
    assert!(
        groups[3]["variance_shares"]["draw"].is_number()
            && groups[3]["variance_shares"]["record"].is_number()
    );
    let xml = fs::read_to_string(at.join("f.xml")).expect("a model");
    assert!(xml.contains("<limitStates>theta_0p2 theta_0p5 collapse</limitStates>"), "{xml}");
    assert!(xml.contains("id=\"configuration=parallel\"") && !xml.contains("limit="), "{xml}");
    assert_eq!(xml.matches("<params ").count(), 3 * xml.matches("<fragilityFunction ").count());
    let curves = fs::read_to_string(at.join("curves.csv")).expect("curves");
    assert!(curves.starts_with("configuration,limit,intensity,probability"), "{curves}");

    for (arguments, told) in [
        (&["--threshold", "2.0"][..], "--threshold: found 2"),
        (&["--threshold", "-1"], "--threshold"),
        (&["--intensity", "pgx"], "pgx"),
    ] {
        let output = mrbd(at, &[&["fragility", "out"], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(told), "{told} in {}", stderr(&output));
    }
}

#[test]
fn regress_stripes_and_incremental_analyses_tell_the_same_fragility() {
    let incremental = drawn(
        "incremental",
        "[incremental]\nlimits = [0.2]\nmeasure = \"pgv_m_s\"\nfrom = 0.1\nto = 8.0\ngrowth = 1.15\nbracket = 1.02\n",
    );
    let fragility = |text: &str, more: &[&str]| {
        let folder = study(&text.replace("count = 6", "count = 24"));
        stdout(&mrbd(folder.path(), &["run", "study.toml", "--out", "out"]));
        let told =
            mrbd(folder.path(), &[&["fragility", "out", "--replicates", "0", "--json"], more].concat());
        let json: serde_json::Value = serde_json::from_str(&stdout(&told)).expect("JSON");
        let groups = json["groups"].as_array().expect("groups").clone();
        let of = |group: &serde_json::Value| {
            group["group"]["configuration"] == "parallel" && group["group"]["limit"] == "0.2"
        };
        groups.into_iter().find(of).expect("the group")
    };
    let stripes = fragility(&strong_stripes(), &["--threshold", "0.2"]);
    let growing = fragility(&incremental, &[]);
    assert_eq!(growing["trials"], 48.0);
    let median = |group: &serde_json::Value| group["median"].as_f64().expect("a median");
    // The same façades under the same records: only the spacing of the stripes and the width of the brackets differ. A
    // median between stripes at 0.3 and 0.6 is told by those that fail at one and not at the other, to some of 48.
    assert!((median(&stripes) / median(&growing) - 1.0).abs() < 0.1, "{stripes} {growing}");
}

#[test]
fn regress_a_sample_at_a_tighter_tolerance_is_compared() {
    // Records with bursts of impacts, at a tolerance so coarse that its error shows: in one to four of a hundred runs, so
    // that among three hundred there are some for sure.
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/records/emilia7/suite.toml");
    let coarse = monte_carlo().replace("[sampling]", "[assumptions]\ntolerance = 1e-2\n[sampling]");
    let coarse = coarse.replace("count = 6", "count = 24");
    let folder = study(&coarse.replace("suite.toml", shipped.to_str().expect("UTF-8")));
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    let check = |more: &[&str]| mrbd(at, &[&["check-tolerance", "out"], more].concat());
    let told = stdout(&check(&["--sample", "300", "--tolerance", "1e-6"]));
    let share = |told: &str| -> f64 {
        let line = told.lines().find(|line| line.contains("parallel")).expect("a line");
        line.split_whitespace().nth(3).and_then(|cell| cell.parse().ok()).expect("a share")
    };
    assert!(told.contains("ill-conditioned") && share(&told) > 0.0, "{told}");
    let runs = told.lines().filter_map(|line| line.split_whitespace().nth(2)?.parse::<u64>().ok());
    assert_eq!(runs.sum::<u64>(), 300, "{told}");
    assert_eq!(stdout(&check(&["--sample", "300", "--tolerance", "1e-6", "--threads", "1"])), told);
    for wrong in ["0.1", "0", "nan"] {
        assert_eq!(check(&["--tolerance", wrong]).status.code(), Some(2), "{wrong}");
    }
}

#[test]
fn regress_medians_of_drawn_facades_are_accepted_and_checked() {
    let tight = "[[variants]]\nname = \"tight\"\nset = { tolerance = 1e-8 }\n";
    let folder = study(&format!("{}{tight}", stripes()));
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    let check = |more: &[&str]| mrbd(at, &[&["check", "out", "--baseline", "base.csv"], more].concat());
    stdout(&check(&["--accept", "--because", "the first one"]));
    let told = stdout(&check(&[]));
    // Two floors, three stripes, two bodies, over all and each of two records.
    assert!(told.starts_with("36 medians compared") && told.contains("0 figures moved"), "{told}");
    let text = fs::read_to_string(at.join("base.csv")).expect("a baseline");
    let failed =
        text.replacen("pulse_1,theta1_max_over_alpha1,6,0,", "pulse_1,theta1_max_over_alpha1,6,1,", 1);
    assert_ne!(text, failed, "the test must change the file");
    fs::write(at.join("base.csv"), failed).expect("written");
    let output = check(&[]);
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(told.contains("1 figures moved") && told.contains("pga_m_s2"), "{told}");
}

#[test]
fn rejects_results_with_columns_of_another_version() {
    let folder = study(&monte_carlo());
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    let path = at.join("out/manifest.json");
    let text = fs::read_to_string(&path).expect("a manifest");
    let now = format!("\"schema_version\": {SCHEMA_VERSION}");
    fs::write(&path, text.replace(&now, "\"schema_version\": 1")).expect("written");
    for command in
        [&["aggregate", "out"][..], &["status", "out"], &["replay", "out", "1"], &["fragility", "out"]]
    {
        let output = mrbd(at, command);
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(stderr(&output).contains("columns of version 1"), "{}", stderr(&output));
    }
    assert!(Path::new(&path).is_file());
}

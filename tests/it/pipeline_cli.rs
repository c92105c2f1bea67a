//! `mrbd run` and `mrbd aggregate` as users meet them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::pipeline_support::SMALL;

/// A folder with a small study: its pipeline, survey, coefficients and a suite of two short records.
pub fn study(pipeline: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs");
    for name in ["survey.toml", "coefficients.toml"] {
        fs::copy(inputs.join(name), folder.path().join(name)).expect("copied");
    }
    let mut suite = "name = \"pulses\"\ngenerated = true\n".to_owned();
    for (id, peak) in [(1, 3.0), (2, 5.0)] {
        let name = format!("pulse_{id}.csv");
        suite += &format!("[[records]]\nid = {id}\nfile = \"{name}\"\nevent = \"none\"\n");
        fs::write(folder.path().join(name), pulse(peak)).expect("written");
    }
    fs::write(folder.path().join("suite.toml"), suite).expect("written");
    fs::write(folder.path().join("study.toml"), pipeline).expect("written");
    folder
}

/// One sine of 0.5 s and that peak, m/s².
fn pulse(peak: f64) -> String {
    let samples = (0..=100).map(|i| {
        let time_s = 0.005 * f64::from(i);
        format!("{time_s:.3},{}\n", peak * (4.0 * std::f64::consts::PI * time_s).sin())
    });
    format!("time_s,acceleration_m_s2\n{}", samples.collect::<String>())
}

pub fn mrbd(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mrbd"));
    command.current_dir(folder).args(arguments).output().expect("the program starts")
}

pub fn stdout(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

#[test]
fn regress_a_study_runs_from_pipeline_to_findings() {
    let folder = study(SMALL);
    let told = stdout(&mrbd(folder.path(), &["run", "study.toml"]));
    for part in [
        "pulses",
        "generated, not measured",
        "perpendicular floor, b in m",
        "reverse scale effect",
        "contact",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
    assert!(told.lines().all(|line| line.chars().count() <= 120), "tables fit a terminal");
    let out = folder.path().join("outputs/small");
    assert_eq!(fs::read_to_string(out.join("plan.toml")).expect("a copy of the pipeline"), SMALL);
    let manifest = fs::read_to_string(out.join("manifest.json")).expect("a manifest");
    assert!(manifest.contains("\"runs\": 72"), "{manifest}");
    assert!(out.join("medians.parquet").is_file());
    let findings = fs::read_to_string(out.join("findings.csv")).expect("findings");
    assert!(
        findings.contains("contact,reverse scale effect,not in this study,the study has no levels of the thickness under the parallel"),
        "{findings}"
    );

    assert_eq!(
        stdout(&mrbd(folder.path(), &["aggregate", "outputs/small"])),
        told,
        "the same from the files"
    );
    let csv = stdout(&mrbd(folder.path(), &["aggregate", "outputs/small", "--csv"]));
    // 2 variants × 2 cases × 3 levels × 3 slendernesses × 4 measures, and the header.
    assert_eq!(csv.lines().count(), 2 * 2 * 3 * 3 * 4 + 1);

    let again = mrbd(folder.path(), &["run", "study.toml"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--force"));
    assert_eq!(stdout(&mrbd(folder.path(), &["run", "study.toml", "--force", "--threads", "1"])), told);
}

#[test]
fn regress_force_replaces_results_of_another_version_and_nothing_else() {
    let folder = study(SMALL);
    let told = stdout(&mrbd(folder.path(), &["run", "study.toml"]));
    let manifest = folder.path().join("outputs/small/manifest.json");
    let older =
        fs::read_to_string(&manifest).expect("a manifest").replace("\"schema_version\"", "\"schema\"");
    fs::write(&manifest, older).expect("written");
    let refused = mrbd(folder.path(), &["run", "study.toml"]);
    assert_eq!(refused.status.code(), Some(2), "what is not understood is not overwritten unasked");
    assert_eq!(stdout(&mrbd(folder.path(), &["run", "study.toml", "--force"])), told);

    fs::write(&manifest, "{\"name\": \"somebody else's\"}").expect("written");
    let refused = mrbd(folder.path(), &["run", "study.toml", "--force"]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("manifest.json"), "{message}");
    assert!(folder.path().join("outputs/small/medians.parquet").is_file(), "nothing is removed");
}

#[test]
fn regress_a_dry_run_lists_every_run_and_writes_nothing() {
    let folder = study(SMALL);
    let before = fs::read_dir(folder.path()).expect("readable").count();
    let list = stdout(&mrbd(folder.path(), &["run", "study.toml", "--dry-run"]));
    assert_eq!(list.lines().count(), 1 + 72);
    let header = list.lines().next().expect("a header");
    for column in ["run,id,variant", "record_sha256", "capture_velocity_rad_s", "lower_width_m"] {
        assert!(header.contains(column), "{column} in {header}");
    }
    assert!(!header.contains("theta1_max"), "results are not inputs");
    assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), before);
}

#[test]
fn rejects_bad_pipelines_with_file_and_key() {
    for (from, to, told) in [
        ("name = \"small\"", "name = small", "study.toml:2"),
        ("[sweep]", "[sweeep]", "sweeep"),
        ("10.0, 14.0, 18.0", "", "sweep.slenderness"),
        ("\"suite.toml\"", "\"none.toml\"", "none.toml"),
        ("\"survey.toml\"", "\"none.toml\"", "none.toml"),
        ("law = \"contact\"", "law = \"elastic\"", "elastic"),
        ("law = \"contact\"", "density_kg_m3 = 9e5", "crushes"),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "the test must change the file");
        let folder = study(&text);
        let output = mrbd(folder.path(), &["run", "study.toml"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{told} in {message}");
        assert!(output.stdout.is_empty() && !folder.path().join("outputs").exists(), "nothing half-written");
    }
}

#[test]
fn rejects_output_that_cannot_be_written() {
    let folder = study(SMALL);
    let output = mrbd(folder.path(), &["run", "study.toml", "--out", "suite.toml/out"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--out"));
    let output = mrbd(folder.path(), &["aggregate", "."]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no results"));
}

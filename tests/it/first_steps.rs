//! First steps: `mrbd init` and what it writes, suggestions for misspelt names, completions, the citation.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use crate::pipeline_cli::{mrbd, stdout};

fn started() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = stdout(&mrbd(folder.path(), &["init"]));
    assert!(files.lines().count() == 16 && files.lines().all(|file| folder.path().join(file).is_file()));
    folder
}

#[test]
fn regress_the_files_to_begin_with_run_as_they_are() {
    let folder = started();
    let record = ["--record", "records/generated_4_600ya.csv", "--scale", "3.05"];
    let told = stdout(&mrbd(folder.path(), &[&["simulate", "wall.toml"][..], &record].concat()));
    assert!(told.starts_with("The wall stood") && told.contains("impacts"), "{told}");
    let plan = stdout(&mrbd(folder.path(), &["run", "pipeline.toml", "--dry-run"]));
    // 2 floors × 2 parameters × 3 levels × 5 slendernesses × 7 records × 2 variants, and a header.
    assert_eq!(plan.lines().count(), 1 + 2 * 2 * 3 * 5 * 7 * 2);
}

#[test]
fn analytic_the_made_up_tests_are_those_of_their_wall() {
    let folder = started();
    let mut child = Command::new(env!("CARGO_BIN_EXE_mrbd"))
        .current_dir(folder.path())
        .args(["calibrate", "experiment.toml", "--evaluate"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("mrbd starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    writeln!(stdin, "0.93 1.03 0.825 0.985 0.865 0.76 0.98 0.94\n1 1 1 1 1 1 1 1").expect("written");
    drop(stdin);
    let told = stdout(&child.wait_with_output().expect("ends"));
    let wme: Vec<f64> = told.split([',', '\n']).filter_map(|cell| cell.parse().ok()).collect();
    assert_eq!(wme.len(), 6, "{told}");
    // Noise of 1e-4 rad beside mean rotations of several 1e-3 rad, on two channels; C_l = 1 is another wall.
    assert!(wme[..3].iter().all(|x| *x < 0.1) && wme[3..].iter().all(|x| *x > 0.5), "{wme:?}");
}

#[test]
fn rejects_writing_over_a_file_and_then_writes_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("experiment.toml"), "mine").expect("written");
    let output = mrbd(folder.path(), &["init"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("experiment.toml") && message.contains("nothing is written over"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
}

#[test]
fn rejects_misspelt_names_with_the_one_that_was_meant() {
    let folder = started();
    let refused = |file: &str, (from, to): (&str, &str), arguments: &[&str], meant: &str| {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).expect("a starter file");
        fs::write(&path, text.replacen(from, to, 1)).expect("written");
        let output = mrbd(folder.path(), arguments);
        fs::write(&path, text).expect("written");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(&format!("did you mean `{meant}`?")), "{meant} in {message}");
    };
    let simulate = ["simulate", "wall.toml", "--tail", "1"];
    refused("wall.toml", ("thickness_m", "thikness_m"), &simulate, "thickness_m");
    refused("wall.toml", ("[diaphragm]", "[diafragm]"), &simulate, "diaphragm");
    refused("wall.toml", ("\"contact\"", "\"contacts\""), &simulate, "contact");
    refused("pipeline.toml", ("\"stiffness\"", "\"stifness\""), &["run", "pipeline.toml"], "stiffness");
    refused("pipeline.toml", ("length_m", "lenght_m"), &["run", "pipeline.toml"], "length_m");
    let calibrate = ["calibrate", "experiment.toml", "--out", "out"];
    refused("experiment.toml", ("most_generations", "max_generations"), &calibrate, "most_generations");
    let prior = ("[calibrate]", "[prior]\nstifness_n_per_m = 0.02\n[calibrate]");
    refused("experiment.toml", prior, &calibrate, "stiffness_n_per_m");
    refused("records/suite.toml", ("distance_km", "distance"), &["run", "pipeline.toml"], "distance_km");
}

#[test]
fn regress_completions_know_every_command() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = stdout(&mrbd(folder.path(), &["completions", shell]));
        for name in ["init", "simulate", "fragility", "--capture-velocity"] {
            // Fish writes long options without their dashes.
            assert!(script.contains(name.trim_start_matches('-')), "{name} for {shell}");
        }
    }
}

#[test]
fn regress_the_citation_is_of_this_version() {
    let citation = include_str!("../../CITATION.cff");
    assert!(citation.contains(&format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"))));
}

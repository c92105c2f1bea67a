//! `mrbd replay`.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

#[test]
fn regress_a_run_is_replayed_alone_to_the_same_bits() {
    let folder = study(SMALL);
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    for run in ["0", "41", "71"] {
        let plain = mrbd(at, &["replay", "out", run, "--json"]);
        assert!(String::from_utf8_lossy(&plain.stderr).contains("the same bits as stored"));
        let file = format!("{run}.csv");
        let observed = mrbd(at, &["replay", "out", run, "--json", "--history", &file]);
        assert_eq!(stdout(&plain), stdout(&observed), "a history changes nothing");
        let rows = fs::read_to_string(at.join(file)).expect("a history");
        assert!(rows.starts_with("time_s,theta1_rad,theta2_rad,pattern") && rows.lines().count() > 100);
    }
    let list = stdout(&mrbd(at, &["run", "study.toml", "--dry-run"]));
    let id = list.lines().nth(1 + 41).and_then(|line| line.split(',').nth(1)).expect("an id");
    let by_id = mrbd(at, &["replay", "out", id]);
    assert!(String::from_utf8_lossy(&by_id.stderr).contains("run 41 ("), "found by its id");
}

#[test]
fn rejects_runs_that_are_none_and_inputs_that_changed() {
    let folder = study(SMALL);
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out", "--shard", "1/1"]));
    let refused = |run: &str, told: &str| {
        let output = mrbd(at, &["replay", "out", run]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told) && output.stdout.is_empty(), "{told} in {message}");
    };
    refused("72", "a position from 0 to 71");
    refused("none", "an id of the study");
    let record = fs::read_to_string(at.join("pulse_2.csv")).expect("a record");
    fs::write(at.join("pulse_2.csv"), record.replacen("0.005,", "0.005,1", 1)).expect("written");
    refused("1", "records that changed: pulse_2;");
    fs::write(at.join("survey.toml"), "source = \"none\"").expect("written");
    refused("1", "survey.toml has changed (SHA-256 ");
    fs::remove_file(at.join("survey.toml")).expect("removed");
    refused("1", "there is no ");
}

#[test]
fn regress_a_run_is_replayed_from_anywhere_and_after_a_move() {
    let folder = study(SMALL);
    let replay = |from: &Path, out: &str| mrbd(from, &["replay", out, "7"]);
    let is_same =
        |output: &Output| String::from_utf8_lossy(&output.stderr).contains("the same bits as stored");
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    stdout(&mrbd(folder.path(), &["run", "study.toml", "--out", "results/of/a"]));
    let out = folder.path().join("results/of/a");
    assert!(is_same(&replay(elsewhere.path(), out.to_str().expect("UTF-8"))), "from another folder");
    fs::rename(&out, elsewhere.path().join("a")).expect("moved");
    assert!(is_same(&replay(elsewhere.path(), "a")), "the results alone were moved");
    fs::rename(elsewhere.path().join("a"), &out).expect("moved back");
    fs::rename(folder.path(), elsewhere.path().join("all")).expect("moved");
    assert!(is_same(&replay(elsewhere.path(), "all/results/of/a")), "results and inputs were moved together");
    fs::rename(elsewhere.path().join("all/results/of/a"), elsewhere.path().join("a")).expect("moved");
    let lost = replay(elsewhere.path(), "a");
    let message = String::from_utf8_lossy(&lost.stderr);
    assert!(lost.status.code() == Some(2) && message.matches("there is no ").count() == 2, "{message}");
}

//! `mrbd replay` and `mrbd slurm`.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::campaign::contents;
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
    refused("1", "records that changed");
    fs::write(at.join("survey.toml"), "source = \"none\"").expect("written");
    refused("1", "survey.toml: found a file that changed");
}

/// A stand-in for Slurm's: it runs every task of an array in falling order, then what depends on it.
const SBATCH: &str = r#"#!/bin/sh
for word; do script=$word; done
echo "$*" >> sbatch.log
tasks=$(sed -n 's/^#SBATCH --array=1-\([0-9]*\).*/\1/p' "$script")
case $tasks in
"") sh "$script" > merged.txt ;;
*) while [ "$tasks" -gt 0 ]; do
    SLURM_ARRAY_TASK_ID=$tasks sh "$script" || exit 1
    tasks=$((tasks - 1))
  done
  echo "17;cluster" ;;
esac
"#;

#[cfg(unix)]
#[test]
fn regress_the_scripts_for_slurm_give_the_bits_of_one_process() {
    use std::os::unix::fs::PermissionsExt;
    let folder = study(SMALL);
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "whole"]));
    let options =
        ["--tasks", "3", "--at-once", "2", "--account", "ab-1", "--partition", "long", "--cpus", "1"];
    // A name with a space and a quote, as shared file systems have them.
    let command =
        stdout(&mrbd(at, &[&["slurm", "study.toml", "--out", "the user's out"][..], &options].concat()));
    fs::write(at.join("sbatch"), SBATCH).expect("written");
    fs::set_permissions(at.join("sbatch"), fs::Permissions::from_mode(0o755)).expect("made to run");
    let path = format!("{}:{}", at.display(), std::env::var("PATH").unwrap_or_default());
    let output = Command::new("sh").args(["-c", &command]).current_dir(at).env("PATH", path).output();
    stdout(&output.expect("a shell"));
    assert_eq!(contents(&at.join("the user's out")), contents(&at.join("whole")));
    assert_eq!(fs::read_to_string(at.join("merged.txt")).expect("medians"), told);
    let log = fs::read_to_string(at.join("sbatch.log")).expect("a log");
    assert!(log.contains("--dependency=afterany:17 "), "{log}");
    let array = fs::read_to_string(at.join("the user's out-slurm/array.sh")).expect("a script");
    for line in ["--array=1-3%2", "--account=ab-1", "--partition=long", "--requeue", "--signal=B:TERM@60"] {
        assert!(array.contains(&format!("#SBATCH {line}\n")), "{line} in {array}");
    }
}

#[test]
fn rejects_options_that_a_script_cannot_hold() {
    let folder = study(SMALL);
    for (options, told) in [
        (["--tasks", "1001"], "--array-limit"),
        (["--account", "two words"], "--account"),
        (["--partition", "a\nb"], "--partition"),
        (["--time", ""], "--time"),
    ] {
        let output = mrbd(folder.path(), &[&["slurm", "study.toml"][..], &options].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{told} in {message}");
        assert!(!Path::new(&folder.path().join("outputs")).exists(), "nothing is written");
    }
}

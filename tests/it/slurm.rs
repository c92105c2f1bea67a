//! `mrbd slurm`: the scripts it writes, run by a stand-in for Slurm. A real one is in slurm_cluster.rs.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::campaign::contents;
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;
use crate::variance::sharp;

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

/// Runs the command that `mrbd slurm` prints, with the stand-in.
#[cfg(unix)]
fn submit(at: &Path, command: &str) {
    use std::os::unix::fs::PermissionsExt;
    fs::write(at.join("sbatch"), SBATCH).expect("written");
    fs::set_permissions(at.join("sbatch"), fs::Permissions::from_mode(0o755)).expect("made to run");
    let path = format!("{}:{}", at.display(), std::env::var("PATH").unwrap_or_default());
    let output = Command::new("sh").args(["-c", command]).current_dir(at).env("PATH", path).output();
    stdout(&output.expect("a shell"));
}

#[cfg(unix)]
#[test]
fn regress_an_array_of_a_study_of_variance_gives_the_bits_of_one_process() {
    let folder = study(&sharp());
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "whole", "--block-runs", "16"]));
    let command =
        ["slurm", "study.toml", "--out", "array", "--block-runs", "16", "--tasks", "3", "--cpus", "1"];
    submit(at, &stdout(&mrbd(at, &command)));
    assert_eq!(contents(&at.join("array")), contents(&at.join("whole")));
    assert_eq!(fs::read_to_string(at.join("merged.txt")).expect("shares"), told);
}

#[cfg(unix)]
#[test]
fn regress_the_scripts_for_slurm_give_the_bits_of_one_process() {
    let folder = study(SMALL);
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "whole", "--block-runs", "4"]));
    // Names with spaces, quotes and a percent sign, as shared file systems have them.
    let mut command = vec!["slurm", "study.toml", "--out", "the user's 10%A out", "--block-runs", "4"];
    command.extend(["--tasks", "3", "--at-once", "2", "--cpus", "1", "--partition", "long"]);
    command.extend(["--account", "the \"lab\" a", "--sbatch=--qos=high", "--sbatch", "--comment=it's"]);
    let command = stdout(&mrbd(at, &command));
    submit(at, &command);
    assert_eq!(contents(&at.join("the user's 10%A out")), contents(&at.join("whole")));
    assert_eq!(fs::read_to_string(at.join("merged.txt")).expect("medians"), told);
    let log = fs::read_to_string(at.join("sbatch.log")).expect("a log");
    assert!(log.contains("--dependency=afterany:17 "), "{log}");
    for script in ["array.sh", "merge.sh"] {
        let text = fs::read_to_string(at.join("the user's 10%A out-slurm").join(script)).expect("a script");
        let common = [
            r#""--account=the \"lab\" a""#,
            "--partition=long",
            "--qos=high",
            r#""--comment=it's""#,
            "--time=04:00:00",
            "--cpus-per-task=1",
        ];
        let of_array = ["--array=1-3%2", "--requeue", "--signal=B:USR1@120"];
        let more = if script == "array.sh" { &of_array[..] } else { &[] };
        for line in common.iter().chain(more) {
            assert!(text.contains(&format!("#SBATCH {line}\n")), "{line} in {text}");
        }
        let log = text.lines().find(|line| line.contains("--output=")).expect("a log");
        assert!(log.contains("the user's 10%%A out-slurm/") && log.ends_with(".log\""), "{log}");
    }
}

#[test]
fn rejects_options_that_a_cluster_or_a_script_cannot_take() {
    let folder = study(SMALL);
    for (options, told) in [
        (["--tasks", "1001"], "--array-limit"),
        (["--tasks", "3"], "1 to 2, the blocks of the study"),
        (["--account", " "], "--account"),
        (["--partition", "a\nb"], "--partition"),
        (["--sbatch", "qos=long"], "an option of sbatch"),
        (["--sbatch", "--comment=a\\b"], "--sbatch"),
        (["--scripts", "a\\b"], "--scripts"),
        (["--time", "four hours"], "minutes:seconds"),
        // Warned at once, a task would never end.
        (["--time", "3"], "more than 180 s"),
    ] {
        let output = mrbd(folder.path(), &[&["slurm", "study.toml"][..], &options].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{told} in {message}");
        assert!(!folder.path().join("outputs").exists(), "nothing is written");
    }
}

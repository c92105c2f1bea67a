//! `mrbd run` killed, interrupted and out of disk, as it happens to users.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::campaign::contents;
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

/// Options of all of these: blocks so small that there are many stops between them.
const RUN: [&str; 6] = ["run", "study.toml", "--out", "out", "--block-runs", "4"];

pub fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    RUN.into_iter().chain(more.iter().copied()).collect()
}

fn start(folder: &Path, more: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mrbd"));
    let command = command.current_dir(folder).args(arguments(more));
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

/// What an undisturbed study holds.
pub fn undisturbed(folder: &tempfile::TempDir) -> BTreeMap<PathBuf, String> {
    stdout(&mrbd(folder.path(), &arguments(&["--threads", "1"])));
    let contents = contents(&folder.path().join("out"));
    fs::remove_dir_all(folder.path().join("out")).expect("removed");
    contents
}

/// Finished blocks and parts.
fn finished(folder: &Path) -> BTreeSet<PathBuf> {
    if !folder.join("out").is_dir() {
        return BTreeSet::new();
    }
    let paths = contents(&folder.join("out")).into_keys();
    paths.filter(|path| path.extension().is_some_and(|e| e == "parquet")).collect()
}

#[test]
fn regress_killed_at_random_moments_nothing_finished_is_lost() {
    let folder = study(SMALL);
    let clock = Instant::now();
    let whole = undisturbed(&folder);
    // Kills at any moment of the whole, its end and the time after it too.
    let longest = clock.elapsed().mul_f64(1.2);
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let mut kills = 0;
    while kills < 24 {
        let before = finished(folder.path());
        let mut child = start(folder.path(), &["--resume", "--threads", "2"]);
        std::thread::sleep(longest.mul_f64(random.random_range(0.0..1.0)));
        let ended = child.try_wait().expect("a child").is_some();
        child.kill().expect("killed, or gone");
        let output = child.wait_with_output().expect("a child");
        let after = finished(folder.path());
        let is_together = after.iter().any(|path| path.starts_with("runs"));
        assert!(is_together || before.is_subset(&after), "finished blocks are gone");
        kills += u32::from(!ended);
        if ended {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            assert_eq!(contents(&folder.path().join("out")), whole);
            fs::remove_dir_all(folder.path().join("out")).expect("removed");
        }
    }
    stdout(&mrbd(folder.path(), &arguments(&["--resume"])));
    assert_eq!(contents(&folder.path().join("out")), whole);
}

#[cfg(unix)]
#[test]
fn regress_an_interrupt_stops_cleanly_and_says_how_to_go_on() {
    // Runs enough, each long enough by its tolerance, to be interrupted: a block that waits for the disk holds no other up.
    let slenderness: Vec<f64> = (0..20).map(|k| 10.0 + 0.4 * f64::from(k)).collect();
    let pipeline = SMALL.replace("[sweep]\n", "[assumptions]\ntolerance = 1e-11\n[sweep]\n");
    let folder = study(&pipeline.replace("[10.0, 14.0, 18.0]", &format!("{slenderness:?}")));
    let whole = undisturbed(&folder);
    for signal in ["INT", "TERM"] {
        let child = start(folder.path(), &["--threads", "1"]);
        while !folder.path().join("out/blocks").is_dir() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-s", signal, &id]).status().expect("kill").success());
        let output = child.wait_with_output().expect("a child");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        let again = "mrbd run study.toml --out out --block-runs 4 --resume";
        assert!(message.contains(again), "{message}");
        assert!(
            !contents(&folder.path().join("out"))
                .keys()
                .any(|path| path.to_string_lossy().contains(".unfinished"))
        );
        stdout(&mrbd(folder.path(), &arguments(&["--resume"])));
        assert_eq!(contents(&folder.path().join("out")), whole);
        fs::remove_dir_all(folder.path().join("out")).expect("removed");
    }
}

#[cfg(unix)]
#[test]
fn regress_a_full_disk_is_an_error_that_leaves_what_is_there_valid() {
    let folder = study(SMALL);
    let whole = undisturbed(&folder);
    stdout(&mrbd(folder.path(), &arguments(&["--shard", "1/3"])));
    let before = contents(&folder.path().join("out"));
    // No file may grow beyond 16 or 80 blocks of 512 bytes: less than a block of runs, less than a part.
    for limit in ["16", "80"] {
        let program = env!("CARGO_BIN_EXE_mrbd");
        let command = format!("trap '' XFSZ; ulimit -f {limit}; exec {program} {} --resume", RUN.join(" "));
        let output = Command::new("sh").args(["-c", &command]).current_dir(folder.path()).output();
        let output = output.expect("a shell");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{limit}: {message}");
        assert!(message.contains("too large") && message.contains("to go on when"), "{limit}: {message}");
        let after = contents(&folder.path().join("out"));
        assert!(before.iter().all(|(path, sha256)| after.get(path) == Some(sha256)), "{limit}");
        stdout(&mrbd(folder.path(), &["aggregate", "out", "--csv"]));
    }
    stdout(&mrbd(folder.path(), &arguments(&["--resume"])));
    assert_eq!(contents(&folder.path().join("out")), whole);
}

#[test]
fn regress_shards_by_the_scheduler_and_their_merge_give_the_bits_of_one_process() {
    let folder = study(SMALL);
    let whole = undisturbed(&folder);
    let again = mrbd(folder.path(), &["merge", "out"]);
    assert_eq!(again.status.code(), Some(2), "nothing to merge");
    for index in ["3", "1", "2"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mrbd"));
        command.env("SLURM_ARRAY_TASK_ID", index).env("SLURM_ARRAY_TASK_COUNT", "3");
        command.env("SLURM_ARRAY_TASK_MIN", "1").current_dir(folder.path());
        let output = command.args(arguments(&["--shard", "auto"])).output().expect("the program starts");
        assert!(stdout(&output).is_empty(), "a shard has no medians");
        let early = mrbd(folder.path(), &["merge", "out"]);
        assert_eq!(early.status.success(), index == "2", "{}", String::from_utf8_lossy(&early.stderr));
    }
    assert_eq!(contents(&folder.path().join("out")), whole);
}

#[test]
fn rejects_shards_that_are_none() {
    let folder = study(SMALL);
    for shard in ["0/3", "4/3", "three", "auto"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mrbd"));
        let command = command.env_remove("SLURM_ARRAY_TASK_ID").env_remove("JOB_COMPLETION_INDEX");
        let output = command.current_dir(folder.path()).args(arguments(&["--shard", shard])).output();
        let output = output.expect("the program starts");
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains("--shard"));
        assert!(!folder.path().join("out").exists(), "nothing is written");
    }
}

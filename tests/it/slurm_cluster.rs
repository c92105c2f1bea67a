//! `mrbd slurm` on a real Slurm: a cluster of one node, this machine, which tests/slurm/with_cluster.sh brings up.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::campaign::contents;
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

/// Longest wait for anything: Slurm looks at time limits every half minute.
const PATIENCE: Duration = Duration::from_secs(150);

/// Folder of the results, by a name that scripts trip over.
const OUT: &str = "the user's 10%A out";

/// Runs of a block: a few hundredths of a second.
const BLOCK_RUNS: &str = "20";

/// Bit of SIGTERM, number 15, in the masks of /proc/PID/status.
const TERM: u64 = 1 << 14;

fn wait_for<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let clock = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(clock.elapsed() < PATIENCE, "no {what}\n{}", slurm("scontrol", &["show", "job"]));
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn slurm(program: &str, arguments: &[&str]) -> String {
    stdout(&Command::new(program).args(arguments).output().expect("Slurm is installed"))
}

fn signal(name: &str, process: u32) {
    let status = Command::new("kill").args(["-s", name, &process.to_string()]).status();
    assert!(status.expect("kill").success(), "{name} to {process}");
}

/// A field of /proc/PID/status; none where the process has gone.
fn status(process: u32, field: &str) -> Option<String> {
    let text = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    text.lines().find_map(|line| line.strip_prefix(field)).map(|value| value.trim().to_owned())
}

/// A job array that was submitted.
struct Array {
    job: String,
    logs: PathBuf,
}

impl Array {
    /// By the command that `mrbd slurm` printed.
    fn submit(at: &Path, command: &str) -> Self {
        let output = Command::new("sh").args(["-c", command]).current_dir(at).output().expect("a shell");
        let told = stdout(&output);
        let job =
            told.strip_prefix("array ").and_then(|told| told.split_once(',')).expect("the job's number").0;
        Self { job: job.to_owned(), logs: at.join(format!("{OUT}-slurm")) }
    }

    fn task(&self, index: u32) -> String {
        format!("{}_{index}", self.job)
    }

    /// The process of `mrbd` of a task, as soon as it is at work, and held there.
    fn hold(&self, index: u32) -> u32 {
        let variables = [format!("SLURM_ARRAY_JOB_ID={}", self.job), format!("SLURM_ARRAY_TASK_ID={index}")];
        let process = wait_for("process of the task", || {
            let entries = fs::read_dir("/proc").expect("readable").flatten();
            let mut processes = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
            processes.find(|&process| {
                let environment = fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
                let has =
                    |variable: &String| environment.split(|b| *b == 0).any(|v| v == variable.as_bytes());
                // Its handlers are in place: bit of SIGTERM among the caught signals.
                let caught = status(process, "SigCgt:").and_then(|mask| u64::from_str_radix(&mask, 16).ok());
                let is_mrbd = status(process, "Name:").is_some_and(|name| name == "mrbd");
                is_mrbd && caught.is_some_and(|mask| mask & TERM != 0) && variables.iter().all(has)
            })
        });
        signal("STOP", process);
        process
    }

    fn log(&self, index: u32) -> String {
        fs::read_to_string(self.logs.join(format!("{}.log", self.task(index)))).expect("a log")
    }

    /// The log of the merge, when nothing is queued any more.
    fn merged(&self) -> String {
        wait_for("end", || slurm("squeue", &["--noheader"]).is_empty().then_some(()));
        let logs = fs::read_dir(&self.logs).expect("readable").map(|entry| entry.expect("readable").path());
        let is_merge = |path: &PathBuf| path.to_string_lossy().contains("/merge-");
        // The number in its name is the job's; the last one is the largest.
        let last = logs.filter(is_merge).max_by_key(|path| (path.as_os_str().len(), path.clone()));
        fs::read_to_string(last.expect("a log")).expect("readable")
    }
}

/// How often a task began.
fn starts(log: &str) -> usize {
    log.matches(" runs to do on 1 thread").count()
}

#[test]
#[ignore = "needs a Slurm cluster: make test-slurm"]
fn regress_killed_warned_lost_and_cancelled_tasks_in_slurm_end_in_the_bits_of_one_process() {
    // Runs that take milliseconds, and seconds of them for each task: long enough to be caught at work.
    let many: Vec<f64> = (0..120).map(|step| 10.0 + 0.1 * f64::from(step)).collect();
    let slow = SMALL.replace("[sweep]\n", "[assumptions]\ntolerance = 1e-13\n[sweep]\n");
    let folder = study(&slow.replace("[10.0, 14.0, 18.0]", &format!("{many:?}")));
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "whole", "--block-runs", BLOCK_RUNS]));
    let mut command = vec!["slurm", "study.toml", "--out", OUT, "--block-runs", BLOCK_RUNS, "--tasks", "4"];
    command.extend(["--cpus", "1", "--time", "10", "--warning-s", "59", "--partition", "main"]);
    command.extend(["--account", "the o'hara \"lab\"", "--sbatch=--comment=a b"]);
    let command = stdout(&mrbd(at, &command));
    let array = Array::submit(at, &command);
    let held = [1, 2, 3, 4].map(|index| array.hold(index));

    let about = slurm("scontrol", &["show", "job", &array.task(4)]);
    for told in ["Account=the o'hara \"lab\"", "Comment=a b", "Partition=main", "Requeue=1"] {
        assert!(about.contains(told), "{told} in {about}");
    }

    // 1: cancelled by the user. It stores what it has and does not come again.
    slurm("scancel", &[&array.task(1)]);
    wait_for("end of the cancelled task", || status(held[0], "State:").is_none().then_some(()));
    let cancelled = array.log(1);
    assert!(
        cancelled.contains("runs were done, and stored") && !cancelled.contains("queues again"),
        "{cancelled}"
    );

    // 2: killed, say for want of memory, and queued again by the user.
    signal("KILL", held[1]);
    wait_for("failure", || {
        slurm("scontrol", &["show", "job", &array.task(2)]).contains("JobState=FAILED").then_some(())
    });
    slurm("scontrol", &["requeue", &array.task(2)]);

    // 3: its time comes to an end. The program is held until the warning has reached it.
    slurm("scontrol", &["update", &format!("JobId={}", array.task(3)), "TimeLimit=1"]);
    wait_for("warning", || {
        let pending = status(held[2], "ShdPnd:").and_then(|mask| u64::from_str_radix(&mask, 16).ok());
        pending.filter(|mask| mask & TERM != 0)
    });
    signal("CONT", held[2]);
    wait_for("the task queued again", || array.log(3).contains("queues again").then_some(()));

    // 4: its node is lost, and comes back.
    let node = slurm("sinfo", &["--noheader", "--format=%N"]);
    let node = format!("NodeName={}", node.trim());
    slurm("scontrol", &["update", &node, "State=DOWN", "Reason=test"]);
    wait_for("end of the lost task", || status(held[3], "State:").is_none().then_some(()));
    slurm("scontrol", &["update", &node, "State=RESUME"]);

    let merged = array.merged();
    assert!(merged.contains("allowed: all runs"), "the cancelled task's runs are missing: {merged}");
    assert_eq!([1, 2, 3, 4].map(|index| starts(&array.log(index))), [1, 2, 2, 2]);

    let again = Array::submit(at, &command);
    assert!(again.merged().contains(told.trim()), "the medians of one process");
    assert_eq!(contents(&at.join(OUT)), contents(&at.join("whole")));
}

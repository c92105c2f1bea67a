//! The texts of the scripts.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use crate::error::{InputError, Result};

/// What the scripts are to do; all paths are absolute.
pub(super) struct Job {
    /// Name of the study.
    pub name: String,
    /// This program.
    pub program: PathBuf,
    /// Pipeline file.
    pub pipeline: PathBuf,
    /// Suite instead of the pipeline's.
    pub suite: Option<PathBuf>,
    /// Folder of the results.
    pub out: PathBuf,
    /// Folder of the scripts and logs.
    pub scripts: PathBuf,
    /// Tasks of the array.
    pub tasks: u64,
    /// Most of them at once.
    pub at_once: Option<NonZero<u32>>,
    /// Runs stored at once.
    pub block_runs: u64,
    /// Processors of a task.
    pub cpus: u32,
    /// Time limit, as Slurm writes it.
    pub time: String,
    /// How long before it a task is warned, s.
    pub warning_s: u64,
    /// Other options of sbatch, and the option of ours each came by.
    pub options: Vec<(&'static str, String)>,
}

/// The scripts' texts.
pub(super) struct Scripts {
    array: String,
    merge: String,
    submit: String,
}

/// What a task does when it is told to stop. USR1 reaches this shell alone, TERM every process of the task: passing
/// TERM on would be the second one, at which the program ends at once. A task that is cancelled gets TERM, and must
/// not queue again; one that is preempted Slurm queues again itself. The name of the task has the array's number in
/// it because SLURM_JOB_ID of the last task is that of the whole array.
const STOPPING: &str = r#"run=$!
warned=
trap 'warned=yes; kill -s TERM "$run"' USR1
trap : TERM
# A signal ends a `wait`, not what is waited for.
wait "$run"
code=$?
while kill -s 0 "$run" 2>/dev/null; do
    wait "$run"
    code=$?
done
if [ -n "$warned" ] && [ "$code" -ne 0 ]; then
    task=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID
    echo "the time limit is near: task $task queues again for the rest" >&2
    scontrol requeue "$task" || echo "it could not: submit.sh again does what is missing" >&2
fi
exit "$code"
"#;

impl Scripts {
    /// # Errors
    /// An input error for words that a script cannot hold.
    pub(super) fn of(job: &Job) -> Result<Self> {
        Ok(Self { array: array(job)?, merge: merge(job)?, submit: submit(job)? })
    }

    /// Names and texts.
    pub(super) fn files(&self) -> [(&'static str, &str); 3] {
        [("array.sh", &self.array), ("merge.sh", &self.merge), ("submit.sh", &self.submit)]
    }
}

fn array(job: &Job) -> Result<String> {
    let at_once = job.at_once.map_or(String::new(), |tasks| format!("%{tasks}"));
    let mut text = head(job, &job.name, "%A_%a")?;
    text += &format!("#SBATCH --array=1-{}{at_once}\n#SBATCH --requeue\n", job.tasks);
    text += &format!("#SBATCH --signal=B:USR1@{}\n\n", job.warning_s);
    text += &format!("{} run {}", shell_word(&job.program)?, shell_word(&job.pipeline)?);
    text += &format!(" --out {} --block-runs {}", shell_word(&job.out)?, job.block_runs);
    if let Some(suite) = &job.suite {
        text += &format!(" --suite {}", shell_word(suite)?);
    }
    // The number of shards is written out: a task that is submitted again alone must not count itself.
    text += &format!(" --shard \"$SLURM_ARRAY_TASK_ID/{}\" --threads {} &\n", job.tasks, job.cpus);
    Ok(text + STOPPING)
}

fn merge(job: &Job) -> Result<String> {
    let head = head(job, &format!("{}-merge", job.name), "merge-%j")?;
    Ok(format!("{head}\nexec {} merge {}\n", shell_word(&job.program)?, shell_word(&job.out)?))
}

/// The merge starts whatever became of the tasks: it says what is missing better than Slurm does.
fn submit(job: &Job) -> Result<String> {
    let [array, merge] = ["array.sh", "merge.sh"].map(|name| shell_word(&job.scripts.join(name)));
    Ok(format!(
        "#!/bin/sh\nset -e\njob=$(sbatch --parsable {})\njob=${{job%%;*}}\n\
         merge=$(sbatch --parsable --dependency=afterany:\"$job\" {})\n\
         echo \"array $job, merge ${{merge%%;*}}\"\n",
        array?, merge?
    ))
}

fn head(job: &Job, name: &str, log: &str) -> Result<String> {
    // Slurm puts numbers in for %A and its like, and a % for two.
    let folder = utf8(&job.scripts)?.replace('%', "%%");
    let log = slurm_word("--scripts", &format!("--output={folder}/{log}.log"))?;
    let mut text = format!("#!/bin/sh\n#SBATCH --job-name=mrbd-{name}\n#SBATCH {log}\n");
    // Appending keeps what a task said before it was requeued.
    text += "#SBATCH --open-mode=append\n";
    text += &format!("#SBATCH --cpus-per-task={}\n#SBATCH --time={}\n", job.cpus, job.time);
    for (ours, option) in &job.options {
        text += &format!("#SBATCH {}\n", slurm_word(ours, option)?);
    }
    Ok(text)
}

/// One word of an `#SBATCH` line: Slurm splits these lines at spaces, knows quotes, and a # begins a comment.
/// A backslash in a file name would switch Slurm's own signs off.
fn slurm_word(ours: &str, word: &str) -> Result<String> {
    if let Some(odd) = word.chars().find(|c| c.is_control() || *c == '\\') {
        let found = format!("{odd:?} in {word:?}");
        return Err(InputError::option(ours, found, "no control characters and no \\").into());
    }
    Ok(match word.chars().all(|c| c.is_ascii_alphanumeric() || "-_.,:+@=/%".contains(c)) {
        true => word.to_owned(),
        false => format!("\"{}\"", word.replace('"', "\\\"")),
    })
}

/// A path as one word of a shell.
pub(super) fn shell_word(path: &Path) -> Result<String> {
    Ok(format!("'{}'", utf8(path)?.replace('\'', r"'\''")))
}

/// A path that is no text would be written as another one.
fn utf8(path: &Path) -> Result<&str> {
    let refused =
        || InputError::file(path, "a path that is not UTF-8", "a path of text, for the scripts").into();
    path.to_str().ok_or_else(refused)
}

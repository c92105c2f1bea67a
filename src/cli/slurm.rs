//! `mrbd slurm`: scripts that run a study as a job array and put its parts together.

use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf, absolute};

use clap::Args;

use super::output;
use crate::error::{Error, InputError, Result};
use crate::input::pipeline::Pipeline;
use crate::plan::Plan;
use crate::store::write_durably;

/// Writes array.sh, merge.sh and submit.sh for Slurm, and prints the command that submits them.
///
/// Every task does one shard and, a minute before its time limit or when it is preempted, stores what it has and stops;
/// submitted again it goes on. The merge starts when all tasks have ended and refuses if runs are missing.
#[derive(Debug, Args)]
pub struct SlurmCommand {
    /// Pipeline file (TOML) that says what to run.
    pipeline: PathBuf,
    /// Folder for the results, on a file system that all nodes share; without it outputs/<name of the pipeline>.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder for the scripts; without it <out>-slurm.
    #[arg(long, value_name = "DIR")]
    scripts: Option<PathBuf>,
    /// Suite of records instead of the pipeline's.
    #[arg(long, value_name = "FILE")]
    suite: Option<PathBuf>,
    /// Tasks of the array.
    #[arg(long, value_name = "N", default_value = "16")]
    tasks: NonZero<u32>,
    /// Most tasks the cluster allows; Slurm's own default of MaxArraySize, 1001, allows 1000.
    #[arg(long, value_name = "N", default_value = "1000")]
    array_limit: u32,
    /// Tasks at once; without it as many as the cluster gives.
    #[arg(long, value_name = "N")]
    at_once: Option<NonZero<u32>>,
    /// Processors, and threads, of a task.
    #[arg(long, value_name = "N", default_value = "4")]
    cpus: NonZero<u32>,
    /// Time limit of a task, as Slurm writes it.
    #[arg(long, value_name = "TIME", default_value = "04:00:00")]
    time: String,
    /// Account to charge.
    #[arg(long, value_name = "NAME")]
    account: Option<String>,
    /// Partition to run in.
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
}

impl SlurmCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the pipeline and what it names, and of options a script cannot hold;
    /// [`Error::Io`] if the scripts cannot be written.
    pub fn execute(self) -> Result<()> {
        let pipeline = Pipeline::load(&self.pipeline)?;
        // Better refused here than by every task of the array.
        Plan::load(&pipeline, self.suite.as_deref())?;
        self.check()?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&pipeline.name));
        let beside = out.with_file_name(format!("{}-slurm", name_of(&out)));
        let scripts = full(self.scripts.as_deref().unwrap_or(&beside))?;
        fs::create_dir_all(&scripts).map_err(|e| Error::io("make the folder", &scripts, e))?;
        let texts = [
            ("array.sh", self.array(&pipeline.name, &out, &scripts)?),
            ("merge.sh", self.merge(&pipeline.name, &out, &scripts)?),
            ("submit.sh", submit(&scripts)),
        ];
        for (name, text) in texts {
            write_durably(&scripts.join(name), text.as_bytes())?;
        }
        output::print(&format!("sh {}", quoted(&scripts.join("submit.sh"))))
    }

    fn check(&self) -> Result<()> {
        if self.tasks.get() > self.array_limit {
            let allowed = format!("1 to {}; `--array-limit` says what the cluster allows", self.array_limit);
            return Err(InputError::option("--tasks", self.tasks.to_string(), allowed).into());
        }
        let words = [("--time", Some(&self.time)), ("--account", self.account.as_ref())];
        for (option, word) in words.into_iter().chain([("--partition", self.partition.as_ref())]) {
            // Slurm splits its lines at spaces, and would take the rest for another option.
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_.,:+@".contains(c);
            if let Some(word) = word.filter(|word| word.is_empty() || !word.chars().all(plain)) {
                let found = format!("{word:?}");
                return Err(InputError::option(option, found, "letters, digits and - _ . , : + @").into());
            }
        }
        Ok(())
    }

    /// `exec` puts the program in the place of the shell, so that it is what Slurm's signals reach.
    fn array(&self, name: &str, out: &Path, scripts: &Path) -> Result<String> {
        let at_once = self.at_once.map_or(String::new(), |tasks| format!("%{tasks}"));
        let mut text = self.head(name, scripts, "%A_%a");
        text += &format!("#SBATCH --array=1-{}{at_once}\n", self.tasks);
        text += &format!("#SBATCH --cpus-per-task={}\n#SBATCH --time={}\n", self.cpus, self.time);
        text += "#SBATCH --requeue\n#SBATCH --signal=B:TERM@60\n\n";
        text += &format!("exec {} run {}", quoted(&program()?), quoted(&full(&self.pipeline)?));
        text += &format!(" --out {}", quoted(&full(out)?));
        if let Some(suite) = &self.suite {
            text += &format!(" --suite {}", quoted(&full(suite)?));
        }
        // The number of shards is written out: a task that is submitted again alone must not count itself.
        text += &format!(" --shard \"$SLURM_ARRAY_TASK_ID/{}\" --threads {}\n", self.tasks, self.cpus);
        Ok(text)
    }

    fn merge(&self, name: &str, out: &Path, scripts: &Path) -> Result<String> {
        let head = self.head(&format!("{name}-merge"), scripts, "merge-%j");
        Ok(format!("{head}\nexec {} merge {}\n", quoted(&program()?), quoted(&full(out)?)))
    }

    fn head(&self, name: &str, scripts: &Path, log: &str) -> String {
        // Appending keeps what a task said before it was requeued.
        let log = scripts.join(format!("{log}.log")).display().to_string().replace('"', "\\\"");
        let mut text = format!("#!/bin/sh\n#SBATCH --job-name=mrbd-{name}\n#SBATCH --output=\"{log}\"\n");
        text += "#SBATCH --open-mode=append\n";
        for (option, value) in [("account", &self.account), ("partition", &self.partition)] {
            text += &value.as_ref().map_or(String::new(), |value| format!("#SBATCH --{option}={value}\n"));
        }
        text
    }
}

/// The merge starts whatever became of the tasks: it says what is missing better than Slurm does.
fn submit(scripts: &Path) -> String {
    format!(
        "#!/bin/sh\nset -e\njob=$(sbatch --parsable {})\nsbatch --dependency=afterany:\"${{job%%;*}}\" {}\n",
        quoted(&scripts.join("array.sh")),
        quoted(&scripts.join("merge.sh"))
    )
}

/// A path as one word of a shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', r"'\''"))
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or("study".to_owned(), |name| name.to_string_lossy().into_owned())
}

fn full(path: &Path) -> Result<PathBuf> {
    absolute(path).map_err(|e| Error::io("find", path, e))
}

fn program() -> Result<PathBuf> {
    std::env::current_exe().map_err(|e| Error::io("find", Path::new("mrbd"), e))
}

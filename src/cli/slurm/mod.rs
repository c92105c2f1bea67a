//! `mrbd slurm`: scripts that run a study as a job array and put its parts together.

mod scripts;
mod time_limit;

use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf, absolute};

use clap::Args;

use super::output;
use crate::error::{Error, InputError, Result};
use crate::store::write_durably;
use crate::study::campaign::Layout;
use crate::study::pipeline::Pipeline;
use crate::study::plan::Plan;
use crate::study::runs::Manifest;
use scripts::{Job, Scripts, shell_word};
use time_limit::seconds;

/// How much earlier than asked for Slurm may warn, s: it looks at time limits every half minute (manual of sbatch).
const WARNS_EARLIER_BY_S: u64 = 60;

/// Write array.sh, merge.sh and submit.sh for Slurm, and print the command that submits them.
///
/// Every task does one shard. Warned by Slurm before its time limit it stores what it has, stops and queues again for
/// the rest. Requeued by Slurm, after a preemption or the loss of a node, it goes on where it was. The merge starts
/// when all tasks have ended and refuses if runs are missing; submitting again does these alone.
///
/// The program, the pipeline, what it names and the folders must be on file systems that all nodes share.
#[derive(Debug, Args)]
pub struct SlurmCommand {
    /// Pipeline file (TOML) that says what to run.
    pipeline: PathBuf,
    /// Folder for the results, on a file system that all nodes share; without it outputs/<name of the pipeline>.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Folder for the scripts and the logs of the tasks; without it <out>-slurm.
    #[arg(long, value_name = "DIR")]
    scripts: Option<PathBuf>,
    /// Suite of records instead of the pipeline's.
    #[arg(long, value_name = "FILE")]
    suite: Option<PathBuf>,
    /// Tasks of the array; without it 16, or one for each block of a smaller study.
    #[arg(long, value_name = "N")]
    tasks: Option<NonZero<u64>>,
    /// Runs stored at once; a task has at least one such block to do. Without it 512 to 8192, by the size of the study.
    #[arg(long, value_name = "N")]
    block_runs: Option<NonZero<u64>>,
    /// Most tasks the cluster allows: MaxArraySize of `scontrol show config`, less 1. Slurm's own default is 1001.
    #[arg(long, value_name = "N", default_value = "1000")]
    array_limit: u64,
    /// Tasks at once; without it as many as the cluster gives.
    #[arg(long, value_name = "N")]
    at_once: Option<NonZero<u32>>,
    /// Processors, and threads, of a task.
    #[arg(long, value_name = "N", default_value = "4")]
    cpus: NonZero<u32>,
    /// Time limit of a task, as Slurm writes it: minutes, hours:minutes:seconds, days-hours, ...
    #[arg(long, value_name = "TIME", default_value = "04:00:00")]
    time: String,
    /// How long before its time limit a task is warned; Slurm may do so up to 60 s earlier still.
    #[arg(long, value_name = "SECONDS", default_value = "120")]
    warning_s: NonZero<u64>,
    /// Account to charge.
    #[arg(long, value_name = "NAME")]
    account: Option<String>,
    /// Partition to run in.
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Any other option of sbatch, for the tasks and the merge, such as --sbatch=--qos=long --sbatch=--mem=4G.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    sbatch: Vec<String>,
}

impl SlurmCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors of the pipeline and what it names, and of options that the cluster or a script cannot take;
    /// [`mrbd_files::Error::Io`] if the scripts cannot be written.
    pub fn execute(self) -> Result<()> {
        let pipeline = Pipeline::load(&self.pipeline)?;
        // Better refused here than by every task of the array.
        let plan = Plan::load(&pipeline, self.suite.as_deref())?;
        let suite = self.suite.as_deref().unwrap_or(&pipeline.suite);
        let manifest = Manifest::of(&plan, &pipeline, suite, self.block_runs)?;
        let tasks = self.tasks(Layout::of(&manifest).len())?;
        self.check_time()?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("outputs").join(&pipeline.name));
        let beside = out.with_file_name(format!("{}-slurm", name_of(&out)));
        let folder = full(self.scripts.as_deref().unwrap_or(&beside))?;
        let scripts = Scripts::of(&self.job(&pipeline.name, &out, &folder, [tasks, manifest.block_runs])?)?;
        fs::create_dir_all(&folder).map_err(|e| Error::io("make the folder", &folder, e))?;
        for (name, text) in scripts.files() {
            write_durably(&folder.join(name), text.as_bytes())?;
        }
        eprintln!(
            "mrbd: {} runs in {tasks} tasks; `mrbd status {}` tells how far",
            plan.len(),
            out.display()
        );
        output::print(&format!("sh {}", shell_word(&folder.join("submit.sh"))?))
    }

    fn tasks(&self, blocks: u64) -> Result<u64> {
        let tasks = self.tasks.map_or(blocks.min(16), NonZero::get);
        let refuse = |allowed| Err(InputError::option("--tasks", tasks.to_string(), allowed).into());
        if tasks > self.array_limit {
            return refuse(format!(
                "1 to {}; `--array-limit` says what the cluster allows",
                self.array_limit
            ));
        }
        if tasks > blocks {
            return refuse(format!(
                "1 to {blocks}, the blocks of the study; a smaller `--block-runs` gives more"
            ));
        }
        Ok(tasks)
    }

    /// A task that is warned as soon as it starts would queue again for ever.
    fn check_time(&self) -> Result<()> {
        let limit_s = seconds(&self.time)?;
        let least_s = self.warning_s.get() + WARNS_EARLIER_BY_S;
        match limit_s {
            Some(limit_s) if limit_s <= least_s => {
                let allowed =
                    format!("more than {least_s} s, at which Slurm may warn: `--warning-s` and 60 s");
                Err(InputError::option("--time", format!("{}, which is {limit_s} s", self.time), allowed)
                    .into())
            }
            _ => Ok(()),
        }
    }

    fn job(&self, name: &str, out: &Path, folder: &Path, [tasks, block_runs]: [u64; 2]) -> Result<Job> {
        let program = std::env::current_exe().map_err(|e| Error::io("find", Path::new("mrbd"), e))?;
        Ok(Job {
            name: name.to_owned(),
            program,
            pipeline: full(&self.pipeline)?,
            suite: self.suite.as_deref().map(full).transpose()?,
            out: full(out)?,
            scripts: folder.to_path_buf(),
            tasks,
            at_once: self.at_once,
            block_runs,
            cpus: self.cpus.get(),
            time: self.time.clone(),
            warning_s: self.warning_s.get(),
            options: self.options()?,
        })
    }

    /// Options of sbatch that hold a user's own words, and the option of ours they came by.
    fn options(&self) -> Result<Vec<(&'static str, String)>> {
        let named = [("--account", &self.account), ("--partition", &self.partition)];
        let named = named.into_iter().filter_map(|(option, value)| Some((option, value.as_ref()?)));
        let mut options = Vec::new();
        for (option, value) in named {
            if value.trim().is_empty() {
                return Err(InputError::option(option, format!("{value:?}"), "a name").into());
            }
            options.push((option, format!("{option}={value}")));
        }
        for option in &self.sbatch {
            if !option.starts_with('-') {
                let allowed = "an option of sbatch as one word, such as --sbatch=--qos=long";
                return Err(InputError::option("--sbatch", format!("{option:?}"), allowed).into());
            }
            options.push(("--sbatch", option.clone()));
        }
        Ok(options)
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or("study".to_owned(), |name| name.to_string_lossy().into_owned())
}

fn full(path: &Path) -> Result<PathBuf> {
    absolute(path).map_err(|e| Error::io("find", path, e))
}

//! Running `mrbd diagnose` on one experiment, and remembering how it went.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use serde::{Deserialize, Serialize};

/// The program that is judged.
pub struct Program {
    path: PathBuf,
    /// SHA-256 of its file: diagnoses by another build are made again.
    hash: String,
}

/// How a diagnosis went.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Outcome {
    /// SHA-256 of the program.
    pub program: String,
    /// Exit code; none: ended by a signal.
    pub exit_code: Option<i32>,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// The last of what it said, if it failed.
    pub message: String,
}

impl Outcome {
    /// Reads the outcome of a case; none if it has not been diagnosed.
    pub fn load(case: &Path) -> Option<Self> {
        serde_json::from_str(&std::fs::read_to_string(case.join("outcome.json")).ok()?).ok()
    }
}

impl Program {
    /// # Errors
    /// Text for people if there is no such program.
    pub fn new(path: &Path) -> Result<Self, String> {
        let hash = mrbd_files::file_sha256(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Self { path: path.to_path_buf(), hash })
    }

    /// Diagnoses the experiment in a folder unless this program has done so.
    ///
    /// # Errors
    /// Text for people if the program cannot be started or the outcome not be written; its failure is an outcome.
    pub fn diagnose(&self, case: &Path) -> Result<(), String> {
        if Outcome::load(case).is_some_and(|outcome| outcome.program == self.hash) {
            return Ok(());
        }
        let told = |e: std::io::Error| format!("{}: {e}", case.display());
        let folder = case.join("diagnosis");
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(told)?;
        }
        // The answer lies beside the experiment; a program that looked for it would find a copy without.
        let blind = tempfile::tempdir().map_err(told)?;
        copy_experiment(case, blind.path()).map_err(told)?;
        let start = Instant::now();
        let run = Command::new(&self.path)
            .arg("diagnose")
            .arg(blind.path().join("experiment.toml"))
            .arg("--out")
            .arg(&folder)
            // Cases run side by side, as many as there are processors.
            .args(["--threads", "1"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .output()
            .map_err(|e| format!("{}: {e}", self.path.display()))?;
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        let last: Vec<&str> = said.lines().rev().take(5).collect();
        let outcome = Outcome {
            program: self.hash.clone(),
            exit_code: run.status.code(),
            seconds: start.elapsed().as_secs_f64(),
            message: if run.status.success() {
                String::new()
            } else {
                last.into_iter().rev().collect::<Vec<_>>().join("\n")
            },
        };
        let text = serde_json::to_string_pretty(&outcome).map_err(|e| e.to_string())?;
        mrbd::store::write_durably(&case.join("outcome.json"), text.as_bytes()).map_err(|e| e.to_string())
    }
}

/// Copies what a laboratory would have: everything but the answer.
///
/// # Errors
/// What the disk says.
pub fn copy_experiment(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let name = entry.file_name();
        let told = name.to_string_lossy();
        if told.ends_with(".csv") || told == "wall.toml" || told == "experiment.toml" {
            std::fs::copy(entry.path(), to.join(&name))?;
        }
    }
    Ok(())
}

//! What can go wrong in a study, and the exit code it earns.
//!
//! Bad input names the file, the key or line, what was found and what is allowed, and exits with 2;
//! everything else exits with 1.

use std::fmt;
use std::path::{Path, PathBuf};

pub use mrbd_files::{InputError, Place};

/// Any failure of the program.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Something the user gave is wrong, or a file could not be read or written.
    #[error(transparent)]
    Files(#[from] mrbd_files::Error),
    /// The Parquet or Arrow library refused.
    #[error("{}: {message}", path.display())]
    Table {
        /// The file or folder.
        path: PathBuf,
        /// What the library said.
        message: String,
    },
    /// A figure or page could not be drawn; this is a defect of the program to report.
    #[error("a picture could not be drawn: {message}")]
    Picture {
        /// What the drawing library said.
        message: String,
    },
    /// The user or the system asked to stop; everything that was finished is stored.
    #[error("stopped; {done} of {missing} runs were done, and stored; to go on: {again}")]
    Stopped {
        /// Runs that were done.
        done: u64,
        /// Runs that were to be done.
        missing: u64,
        /// The command that goes on.
        again: String,
    },
    /// Medians are not what was accepted.
    #[error("{figures} figures moved from {}; `--accept --because REASON` makes the new ones the baseline", baseline.display())]
    Moved {
        /// Figures beyond their tolerance.
        figures: usize,
        /// The accepted medians.
        baseline: PathBuf,
    },
    /// A suite does not follow the code spectrum of a site.
    #[error("suite {suite}: {found} of the code spectrum; allowed: {allowed}")]
    Incompatible {
        /// Name of the suite.
        suite: String,
        /// Lowest and highest deviation.
        found: String,
        /// Those that are allowed.
        allowed: String,
    },
    /// A run that was done again gave other bits than are stored.
    #[error(
        "run {position} of the study: {column} is stored as {stored:?} and came out as {now:?}: another version of the program, or other arithmetic"
    )]
    Differs {
        /// Position in the plan, from 0.
        position: u64,
        /// What differs.
        column: &'static str,
        /// As stored; none where it does not exist.
        stored: Option<f64>,
        /// As it came out.
        now: Option<f64>,
    },
    /// A run could not be finished; this is a defect of the program to report.
    #[error("the run failed at {time_s} s: {reason}")]
    Run {
        /// When, s.
        time_s: f64,
        /// Why.
        reason: String,
    },
}

/// Result of any fallible function of the program.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl From<InputError> for Error {
    fn from(error: InputError) -> Self {
        Error::Files(error.into())
    }
}

impl Error {
    /// Exit code of the process: 2 for bad input, 1 for any other failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Files(error) => error.exit_code(),
            _ => 1,
        }
    }

    /// An input or output error on `path`; `action` completes "cannot …".
    pub fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Error::Files(mrbd_files::Error::io(action, path, source))
    }

    /// An error of the table libraries on `path`.
    pub fn table(path: &Path, error: impl fmt::Display) -> Self {
        Error::Table { path: path.to_path_buf(), message: error.to_string() }
    }
}

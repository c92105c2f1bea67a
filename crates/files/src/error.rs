//! What can go wrong, and the exit code it earns.
//!
//! Bad input names the file, the key or line, what was found and what is allowed, and exits with 2;
//! everything else exits with 1.

use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What can go wrong with files: what is in them, or reading and writing them.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Something the user gave is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file or folder could not be read or written.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// What was tried, as a verb phrase ("write the results").
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Result of any fallible function of the library.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// What the system says where the path is at fault, and no disk or right.
const WRONG_PATH: [ErrorKind; 4] =
    [ErrorKind::NotFound, ErrorKind::NotADirectory, ErrorKind::IsADirectory, ErrorKind::AlreadyExists];

impl Error {
    /// Exit code of the process: 2 for bad input, a path where nothing can be among it; 1 for any other failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input(_) => 2,
            Error::Io { source, .. } if WRONG_PATH.contains(&source.kind()) => 2,
            Error::Io { .. } => 1,
        }
    }

    /// An input or output error on `path`; `action` completes "cannot …".
    pub fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Error::Io { action, path: path.to_path_buf(), source }
    }
}

/// Where in an input the fault lies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// The whole input.
    Whole,
    /// A line, counted from 1.
    Line(usize),
    /// A dotted key such as `wall.height_m`, or an option such as `--scale`.
    Key(String),
    /// A dotted key and the line it stands on.
    KeyOnLine(String, usize),
}

/// A fault in something the user gave: where, what was found, what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputError {
    /// The file, or "command line".
    pub origin: String,
    /// Line, key, or the whole input.
    pub place: Place,
    /// What was found there.
    pub found: String,
    /// What is allowed there; for a suggestion of what to do, a sentence.
    pub allowed: String,
}

impl InputError {
    /// A fault concerning the whole of `path`.
    pub fn file(path: &Path, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::new(path, Place::Whole, found, allowed)
    }

    /// A fault on a line of `path`, counted from 1.
    pub fn line(path: &Path, line: usize, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::new(path, Place::Line(line), found, allowed)
    }

    /// A fault in the value of a key of `path`.
    pub fn key(
        path: &Path,
        key: impl Into<String>,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        Self::new(path, Place::Key(key.into()), found, allowed)
    }

    /// A fault in an option of the command line.
    pub fn option(option: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self {
            origin: "command line".into(),
            place: Place::Key(option.into()),
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    fn new(path: &Path, place: Place, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { origin: path.display().to_string(), place, found: found.into(), allowed: allowed.into() }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.origin)?;
        match &self.place {
            Place::Whole => {}
            Place::Line(line) => write!(f, ":{line}")?,
            Place::Key(key) => write!(f, ": {key}")?,
            Place::KeyOnLine(key, line) => write!(f, ":{line}: {key}")?,
        }
        write!(f, ": found {}; allowed: {}", self.found, self.allowed)
    }
}

impl std::error::Error for InputError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_paths_where_nothing_can_be_as_bad_input() {
        let code = |kind: ErrorKind| Error::io("write", Path::new("nodir/x.csv"), kind.into()).exit_code();
        assert_eq!(WRONG_PATH.map(code), [2; 4]);
        let of_the_disk = [ErrorKind::StorageFull, ErrorKind::PermissionDenied, ErrorKind::BrokenPipe];
        assert_eq!(of_the_disk.map(code), [1; 3]);
    }
}

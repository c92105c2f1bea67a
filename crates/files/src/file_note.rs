//! Files that were read, as results remember them.

use std::path::{Component, Path, PathBuf, absolute};

use serde::{Deserialize, Serialize};

use crate::checksum::file_sha256;
use crate::error::{Error, Result};

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileNote {
    /// What it is.
    pub role: String,
    /// Where it was, from the root.
    pub path: String,
    /// Where it was, from the output folder: found again where both were moved together.
    #[serde(default)]
    pub path_from_folder: Option<String>,
    /// SHA-256 of its contents.
    pub sha256: String,
}

impl FileNote {
    /// The note of a file that plays a role.
    ///
    /// # Errors
    /// An input error if the file cannot be read.
    pub fn of(role: &str, path: &Path) -> Result<Self> {
        let from_root = absolute(path).map_err(|e| Error::io("find", path, e))?;
        Ok(Self {
            role: role.to_owned(),
            path: from_root.display().to_string(),
            path_from_folder: None,
            sha256: file_sha256(path)?,
        })
    }

    /// With the way to the file from the folder of the results.
    pub fn seen_from(self, folder: &Path) -> Self {
        Self { path_from_folder: path_from(folder, &self.path), ..self }
    }
}

/// The way from a folder to a file; none where one of them is not there, or they have no root in common.
fn path_from(folder: &Path, file: &str) -> Option<String> {
    // Without links: `..` leads up the real way.
    let (folder, file) = (folder.canonicalize().ok()?, Path::new(file).canonicalize().ok()?);
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = from[common..].iter().map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to[common..].iter().copied()).collect();
    (common > 0).then(|| way.display().to_string())
}

//! Where things go in the output folder of a diagnosis.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde_json::Value;

use super::{KIND, tables::TABLES};
use crate::error::{Error, InputError, Result};

/// Where things go in the output folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputNames {
    /// The folder.
    pub folder: PathBuf,
    /// Kind and provenance.
    pub manifest: PathBuf,
    /// The verdict.
    pub diagnosis: PathBuf,
    /// The wall with the effect added.
    pub wall: PathBuf,
    /// When the diagnosis began, seconds since 1970.
    pub(super) started_unix_s: u64,
}

impl OutputNames {
    /// Makes a folder ready: it must be empty, not exist, or hold an earlier diagnosis only.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written or holds other files.
    pub fn prepare(folder: &Path) -> Result<Self> {
        let refuse = |found: String, allowed: &str| InputError::option("--out", found, allowed);
        std::fs::create_dir_all(folder)
            .map_err(|e| refuse(format!("{}: {e}", folder.display()), "a folder that can be written"))?;
        let names = Self {
            folder: folder.to_path_buf(),
            manifest: folder.join("manifest.json"),
            diagnosis: folder.join("diagnosis.json"),
            wall: folder.join("wall.updated.toml"),
            started_unix_s: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        };
        let entries = std::fs::read_dir(folder).map_err(|e| Error::io("read", folder, e))?;
        let entries =
            entries.filter_map(std::result::Result::ok).map(|entry| entry.path()).collect::<Vec<_>>();
        let earlier = entries.contains(&names.diagnosis) || is_diagnosis(&names.manifest);
        if !entries.is_empty() && !earlier {
            let found = format!("{}, which holds other files", folder.display());
            return Err(refuse(found, "an empty folder, or one of an earlier diagnosis").into());
        }
        Ok(names)
    }

    /// Removes what an earlier diagnosis left, the verdict first, so that nothing of it is taken for this one's.
    pub(super) fn clear(&self) -> Result<()> {
        let tables = TABLES.map(|name| self.folder.join(name));
        let own = [&self.diagnosis, &self.wall, &self.manifest].into_iter().chain(&tables);
        let page = self.folder.join(crate::store::PAGE_NAME);
        own.chain([&page]).try_for_each(|path| match std::fs::remove_file(path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                Err(Error::io("remove earlier results", path, e))
            }
            _ => Ok(()),
        })
    }
}

/// Whether a manifest is there and says that its folder holds a diagnosis.
fn is_diagnosis(manifest: &Path) -> bool {
    let text = std::fs::read(manifest).unwrap_or_default();
    serde_json::from_slice::<Value>(&text).is_ok_and(|value| value["kind"] == KIND)
}

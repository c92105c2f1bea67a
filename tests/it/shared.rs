//! Reference data that lives outside the repository: tests on it run where it is and say so where it is not.

use std::path::PathBuf;

/// A folder of the reference data: under `MRBD_SHARED`, or in `../shared` beside the repository.
///
/// `None` after saying on stderr what is skipped.
pub fn folder(name: &str) -> Option<PathBuf> {
    let root = std::env::var_os("MRBD_SHARED")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared")), PathBuf::from);
    let folder = root.join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no reference data at {}", folder.display());
    None
}

//! The output folder of results that are made at once, not run by run.

use std::fs;
use std::path::Path;

use super::folder::make_writable;
use crate::error::{Error, InputError, Result};

/// Makes a folder ready for `own` files: it must be writable and hold nothing else, and none of them unless they are to be
/// replaced. Those that are replaced go, and the page made of them.
///
/// # Errors
/// Input errors for a folder that is none of these; [`Error::Io`] if the disk refuses.
pub fn prepare_whole(path: &Path, own: &[&str], replace: bool) -> Result<()> {
    make_writable(path)?;
    let derived = [crate::report::PAGE_NAME];
    let mut there = Vec::new();
    for entry in fs::read_dir(path).map_err(|e| Error::io("read", path, e))? {
        let name = entry.map_err(|e| Error::io("read", path, e))?.file_name().to_string_lossy().into_owned();
        if !own.iter().chain(&derived).any(|own| *own == name) {
            let found = format!("{}, which holds other files ({name})", path.display());
            return Err(InputError::option("--out", found, "an empty folder, or one of such results").into());
        }
        there.push(path.join(name));
    }
    if !there.is_empty() && !replace {
        let found = format!("{}, which holds results already", path.display());
        return Err(InputError::option("--out", found, "an empty folder, or --force to replace them").into());
    }
    there
        .iter()
        .try_for_each(|file| fs::remove_file(file).map_err(|e| Error::io("remove earlier results", file, e)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_folders_of_anything_else_and_results_that_are_not_to_be_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let prepare = |replace| prepare_whole(folder.path(), &["rows.csv"], replace);
        prepare(false).expect("an empty folder");
        fs::write(folder.path().join("rows.csv"), "old").expect("written");
        assert!(prepare(false).expect_err("results").to_string().contains("--force"));
        prepare(true).expect("to be replaced");
        assert!(!folder.path().join("rows.csv").exists());
        fs::write(folder.path().join("manifest.json"), "{}").expect("written");
        let told = prepare(true).expect_err("of something else").to_string();
        assert!(told.contains("other files (manifest.json)"), "{told}");
    }
}

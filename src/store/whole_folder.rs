//! The output folder of results that are made at once, not run by run.

use std::fs;
use std::path::Path;

use super::durable::{UNFINISHED, make_writable};
use crate::error::{Error, InputError, Result};

/// The folder of some files, of the page made of them, and of what a killed process left half-written.
#[derive(Debug)]
pub struct WholeFolder<'a> {
    path: &'a Path,
}

impl<'a> WholeFolder<'a> {
    /// Checks, before anything is computed, that a folder can be written and holds nothing but `own` files, and none of them
    /// unless they are to be replaced.
    ///
    /// # Errors
    /// Input errors for a folder that is not so; [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn check(path: &'a Path, own: &[&str], replace: bool) -> Result<Self> {
        make_writable(path)?;
        for name in names(path)? {
            let is_own = own.contains(&name.as_str()) || name == crate::store::PAGE_NAME;
            if !is_own && !name.starts_with(UNFINISHED) {
                let found = format!("{}, which holds other files ({name})", path.display());
                return Err(
                    InputError::option("--out", found, "an empty folder, or one of such results").into()
                );
            }
            if is_own && !replace {
                let found = format!("{}, which holds results already", path.display());
                let allowed = "an empty folder, or --force to replace them";
                return Err(InputError::option("--out", found, allowed).into());
            }
        }
        Ok(Self { path })
    }

    /// Removes what is there, once there is something to replace it; gives where to write.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn cleared(self) -> Result<&'a Path> {
        for name in names(self.path)? {
            let file = self.path.join(name);
            fs::remove_file(&file).map_err(|e| Error::io("remove earlier results", &file, e))?;
        }
        Ok(self.path)
    }
}

fn names(path: &Path) -> Result<Vec<String>> {
    let failed = |e| Error::io("read", path, e);
    let name = |entry: std::io::Result<fs::DirEntry>| {
        entry.map(|entry| entry.file_name().to_string_lossy().into_owned()).map_err(failed)
    };
    fs::read_dir(path).map_err(failed)?.map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_folders_of_anything_else_and_results_that_are_not_to_be_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let check = |replace| WholeFolder::check(folder.path(), &["rows.csv"], replace);
        check(false).expect("an empty folder");
        let rows = folder.path().join("rows.csv");
        fs::write(&rows, "old").expect("written");
        fs::write(folder.path().join(format!("{UNFINISHED}x")), "ro").expect("written");
        assert!(check(false).expect_err("results").to_string().contains("--force"));
        let to_replace = check(true).expect("to be replaced");
        assert!(rows.exists(), "nothing goes before there is something to replace it");
        to_replace.cleared().expect("cleared");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
        fs::write(folder.path().join("manifest.json"), "{}").expect("written");
        let told = check(true).expect_err("of something else").to_string();
        assert!(told.contains("other files (manifest.json)"), "{told}");
    }
}

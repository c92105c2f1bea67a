//! Files that are whole or absent, whatever stops the program, and folders of results that are made at once.

use std::fs;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::error::{Error, InputError, Result};
use tempfile::NamedTempFile;

/// How the names of files begin that are not finished; readers of folders leave names with a dot out.
pub(crate) const UNFINISHED: &str = ".unfinished-";

/// A temporary file in `folder`, to be filled and then [`put_in_place`] there.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the folder cannot be written.
pub(crate) fn unfinished_in(folder: &Path) -> Result<NamedTempFile> {
    tempfile::Builder::new()
        .prefix(UNFINISHED)
        .tempfile_in(folder)
        .map_err(|e| Error::io("write into", folder, e))
}

/// Brings a filled temporary file to the disk and gives it its name.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the disk refuses.
pub(crate) fn put_in_place(mut file: NamedTempFile, path: &Path) -> Result<()> {
    let failed = |e| Error::io("write", path, e);
    bring_to_disk(&mut file).map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    bring_name_to_disk(path).map_err(failed)
}

fn bring_to_disk(file: &mut NamedTempFile) -> std::io::Result<()> {
    file.flush()?;
    readable_by_all(file.as_file())?;
    file.as_file().sync_all()
}

/// The name lives in the folder: without this the file can be on disk and its name not.
fn bring_name_to_disk(path: &Path) -> std::io::Result<()> {
    File::open(folder_of(path)).and_then(|folder| folder.sync_all())
}

/// Writes `contents` to `path`: the file is there whole, or as it was before.
///
/// # Errors
/// [`mrbd_files::Error::Io`] if the folder cannot be written.
pub fn write_durably(path: &Path, contents: &[u8]) -> Result<()> {
    let mut file = unfinished_in(folder_of(path))?;
    file.write_all(contents).map_err(|e| Error::io("write", path, e))?;
    put_in_place(file, path)
}

/// Writes `contents` to `path` unless another process did first; whether this one wrote.
///
/// # Errors
/// As [`write_durably`].
pub(crate) fn write_durably_if_absent(path: &Path, contents: &[u8]) -> Result<bool> {
    let failed = |e| Error::io("write", path, e);
    let mut file = unfinished_in(folder_of(path))?;
    file.write_all(contents).and_then(|()| bring_to_disk(&mut file)).map_err(failed)?;
    match file.persist_noclobber(path) {
        Ok(_) => bring_name_to_disk(path).map_err(failed).map(|()| true),
        Err(e) if e.error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(e) => Err(failed(e.error)),
    }
}

/// Temporary files are private; results are not.
#[cfg(unix)]
fn readable_by_all(file: &File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_file: &File) -> std::io::Result<()> {
    Ok(())
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes the folder and tries a file in it.
pub(crate) fn make_writable(path: &Path) -> Result<()> {
    let refuse = |e: std::io::Error| {
        let found = format!("{}, which cannot be written: {e}", path.display());
        InputError::option("--out", found, "a folder that can be written")
    };
    fs::create_dir_all(path).map_err(refuse)?;
    tempfile::tempfile_in(path).map_err(refuse)?;
    Ok(())
}

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
    fn regress_a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.txt");
        write_durably(&path, b"first").expect("written");
        write_durably(&path, b"second").expect("replaced");
        assert_eq!(std::fs::read(&path).expect("readable"), b"second");
        assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1);
    }

    #[test]
    fn rejects_a_folder_that_is_not_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let error = write_durably(&folder.path().join("none/a.txt"), b"x").expect_err("no folder");
        assert!(error.to_string().contains("cannot write into"), "{error}");
    }

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

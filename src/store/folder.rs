//! The output folder of a study: what it may hold before, and where things go.
//!
//! ```text
//! manifest.json                          provenance, written first
//! plan.toml                              the pipeline as it was read
//! runs/record=<name>/part-<shard>.parquet
//! ```

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::column::Column;
use super::durable::write_durably;
use super::manifest::Manifest;
use super::parquet_file::ParquetFile;
use super::schema::COLUMNS;
use crate::batch::Finished;
use crate::error::{Error, InputError, Result};

/// A folder that was found fit to take the results of one plan, and holds its manifest.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    metadata: Vec<(String, String)>,
}

impl OutputFolder {
    /// Makes the folder ready: it must be writable, and empty or hold an earlier study that `replace` allows to be
    /// thrown away. Nothing is written unless all that holds; then the manifest and the pipeline's text are.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written or holds something else; [`Error::Io`] if the disk refuses.
    pub fn prepare(path: &Path, manifest: &Manifest, pipeline_text: &str, replace: bool) -> Result<Self> {
        make_writable(path)?;
        let manifest_path = path.join("manifest.json");
        match Manifest::read(&manifest_path)? {
            Some(_) if replace => clear(path)?,
            Some(earlier) => check_earlier(path, &earlier, manifest)?,
            None => check_empty(path)?,
        }
        manifest.write(&manifest_path)?;
        write_durably(&path.join("plan.toml"), pipeline_text.as_bytes())?;
        Ok(Self { path: path.to_path_buf(), metadata: manifest.file_metadata() })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Begins the file of a record's runs; `shard` tells the parts of a divided study apart.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::Table`] if it cannot be begun.
    pub fn begin_part(&self, record: &str, shard: u32) -> Result<ParquetFile<Finished>> {
        let folder = self.path.join("runs").join(format!("record={}", as_folder_name(record)));
        fs::create_dir_all(&folder).map_err(|e| Error::io("make the folder", &folder, e))?;
        let columns: &'static [Column<Finished>] = COLUMNS;
        ParquetFile::create(&folder.join(format!("part-{shard}.parquet")), columns, &self.metadata)
    }
}

/// Makes the folder and tries a file in it.
fn make_writable(path: &Path) -> Result<()> {
    let refuse = |e: std::io::Error| {
        let found = format!("{}, which cannot be written: {e}", path.display());
        InputError::option("--out", found, "a folder that can be written")
    };
    fs::create_dir_all(path).map_err(refuse)?;
    tempfile::tempfile_in(path).map_err(refuse)?;
    Ok(())
}

fn check_earlier(path: &Path, earlier: &Manifest, now: &Manifest) -> Result<()> {
    let folder = path.display();
    let found = match earlier.plan_sha256 == now.plan_sha256 {
        true => format!("{folder}, which holds results of this plan already"),
        false => format!("{folder}, which holds another plan ({:?}, {} runs)", earlier.plan, earlier.runs),
    };
    let allowed = "an empty folder, `--force` to replace those results, or `mrbd aggregate` to read them";
    Err(InputError::option("--out", found, allowed).into())
}

/// Removes what an earlier study left, so that nothing of it can be taken for this one's.
fn clear(path: &Path) -> Result<()> {
    let removed = |path: &Path, result: std::io::Result<()>| match result {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io("remove earlier results", path, e)),
        _ => Ok(()),
    };
    let runs = path.join("runs");
    removed(&runs, fs::remove_dir_all(&runs))?;
    let derived = ["medians.parquet", "findings.csv"].map(|name| path.join(name));
    derived.iter().try_for_each(|file| removed(file, fs::remove_file(file)))
}

fn check_empty(path: &Path) -> Result<()> {
    let entries = fs::read_dir(path).map_err(|e| Error::io("read", path, e))?;
    match entries.into_iter().next() {
        None => Ok(()),
        Some(_) => {
            let found = format!("{}, which holds other files", path.display());
            Err(InputError::option("--out", found, "an empty folder, or one of the same plan").into())
        }
    }
}

/// A record's name as part of a folder's name, as Hive and its readers write it: odd bytes as %XX.
fn as_folder_name(name: &str) -> String {
    name.bytes()
        .map(|byte| match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'_' | b'-' => char::from(byte).to_string(),
            _ => format!("%{byte:02X}"),
        })
        .collect()
}

/// The Parquet files of a study's runs, sorted by path.
///
/// # Errors
/// An input error for a folder without any.
pub fn run_files(path: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for folder in entries(&path.join("runs"))?.into_iter().filter(|entry| entry.is_dir()) {
        files.extend(
            entries(&folder)?.into_iter().filter(|file| file.extension().is_some_and(|e| e == "parquet")),
        );
    }
    files.sort();
    if files.is_empty() {
        let allowed = "the output folder of `mrbd run`, with runs/record=*/part-*.parquet";
        return Err(InputError::file(path, "no results", allowed).into());
    }
    Ok(files)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    match fs::read_dir(folder) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        Err(e) => Err(Error::io("read", folder, e)),
        Ok(list) => list
            .map(|entry| entry.map(|entry| entry.path()).map_err(|e| Error::io("read", folder, e)))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_folder_names_escape_what_hive_escapes() {
        assert_eq!(as_folder_name("20030501_0027_AI.049-EW"), "20030501_0027_AI.049-EW");
        assert_eq!(as_folder_name("a b/c=ü"), "a%20b%2Fc%3D%C3%BC");
    }

    #[test]
    fn rejects_a_folder_without_results() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let error = run_files(folder.path()).expect_err("no results");
        assert_eq!(error.exit_code(), 2);
    }
}

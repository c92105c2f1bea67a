//! The output folder of a study: what it may hold before, and who may write into it.
//!
//! ```text
//! manifest.json    provenance, written first
//! plan.toml        the pipeline as it was read
//! lock             held by the processes that write
//! ```
//!
//! and the runs, see `parts.rs`.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};

use super::manifest::Manifest;
use super::manifest::differences;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};

use crate::error::{Error, InputError, Result};
use crate::store::durable::{UNFINISHED, make_writable, write_durably};
use crate::store::parquet_file::Form;
use crate::study::batch::Finished;

/// What to do with results that are in the folder already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// Refuse the folder.
    Refuse,
    /// Throw them away.
    Replace,
    /// Go on with them, if they are of the same plan; another process may be at work on another part of it.
    Share,
    /// Go on with them, if they are of the same plan, alone.
    Resume,
}

/// A folder that was found fit to take the results of one plan, and holds its manifest.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    manifest: Manifest,
    /// Let go when the folder is dropped or the process ends, however it ends.
    _lock: Option<File>,
    /// Held while the file with the checksums of all parts is read and written again.
    pub(super) checksums: Mutex<()>,
    /// The forms of its files, once one was begun: of blocks, and of the files of records.
    pub(super) forms: [OnceLock<Form<Finished>>; 2],
}

impl OutputFolder {
    /// Makes the folder ready: it must be writable, and empty or hold an earlier study that `earlier` allows.
    /// Nothing is written unless all that holds; then the manifest and the pipeline's text are.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written, is being written or holds something else;
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn prepare(path: &Path, manifest: &Manifest, pipeline_text: &str, earlier: Earlier) -> Result<Self> {
        make_writable(path)?;
        fit(path, manifest, earlier)?;
        let lock = lock(path, earlier == Earlier::Share)?;
        // Again, since another process may have begun here meanwhile; the first look kept the lock out of a folder of
        // something else.
        let is_begun = fit(path, manifest, earlier)?;
        if !is_begun {
            begin(path, manifest, earlier)?;
        }
        let copy = path.join("plan.toml");
        // It lacks after a kill between the two as well.
        if !is_begun || !copy.is_file() {
            write_durably(&copy, pipeline_text.as_bytes())?;
        }
        Ok(Self {
            path: path.to_path_buf(),
            manifest: manifest.clone(),
            _lock: lock,
            checksums: Mutex::default(),
            forms: Default::default(),
        })
    }

    /// Opens the folder of a study to look at it; a study at work may change meanwhile.
    ///
    /// # Errors
    /// An input error for a folder without a manifest.
    pub fn look(path: &Path) -> Result<Self> {
        match Manifest::read(&path.join("manifest.json"))? {
            Some(manifest) => Ok(Self {
                path: path.to_path_buf(),
                manifest,
                _lock: None,
                checksums: Mutex::default(),
                forms: Default::default(),
            }),
            None => Err(InputError::file(path, "no manifest.json", "the output folder of `mrbd run`").into()),
        }
    }

    /// Opens the folder of a study to change it, alone.
    ///
    /// # Errors
    /// As [`OutputFolder::look`], and an input error if another process is at work in it.
    pub fn take(path: &Path) -> Result<Self> {
        let folder = Self::look(path)?;
        Ok(Self { _lock: lock(path, false)?, ..folder })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where its results come from.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }
}

/// Whether the study was begun in the folder and is to be gone on with; refused unless that, or its begin, is allowed.
fn fit(path: &Path, manifest: &Manifest, earlier: Earlier) -> Result<bool> {
    let name = path.join("manifest.json");
    // What is to be replaced need not be understood: another version may have written it.
    if earlier == Earlier::Replace && Manifest::is_any_version(&name)? {
        return Ok(false);
    }
    // Listed before the manifest is looked for: another shard writes that one first.
    let other_file = other_file(path)?;
    match (Manifest::read(&name)?, other_file) {
        (Some(there), _) if earlier == Earlier::Refuse => Err(refuse(path, &there, manifest).into()),
        (Some(there), _) => check_same(path, &there, manifest).map(|()| true),
        (None, None) => Ok(false),
        (None, Some(name)) => {
            let found = format!("{}, which holds other files ({name})", path.display());
            Err(InputError::option("--out", found, "an empty folder, or one of the same plan").into())
        }
    }
}

/// Removes what is to be replaced and writes the manifest. Of shards that begin at once the first one writes it.
fn begin(path: &Path, manifest: &Manifest, earlier: Earlier) -> Result<()> {
    let name = path.join("manifest.json");
    match earlier {
        Earlier::Replace => {
            clear(path)?;
            manifest.write(&name)
        }
        Earlier::Refuse | Earlier::Resume => manifest.write(&name),
        Earlier::Share if manifest.write_if_absent(&name)? => Ok(()),
        Earlier::Share => fit(path, manifest, earlier).map(|_| ()),
    }
}

/// Keeps processes that would get in each other's way apart; `shared` ones do not.
fn lock(path: &Path, shared: bool) -> Result<Option<File>> {
    let name = path.join("lock");
    let file = File::options().create(true).append(true).open(&name);
    let file = file.map_err(|e| Error::io("write", &name, e))?;
    match if shared { file.try_lock_shared() } else { file.try_lock() } {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => {
            let found = format!("{}, in which another process is at work", path.display());
            Err(InputError::option("--out", found, "a folder of one's own, or --shard in all of them").into())
        }
        // Some shared file systems know no locks; there it is on the user, as everything else works the same.
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

fn refuse(path: &Path, there: &Manifest, now: &Manifest) -> InputError {
    let folder = path.display();
    let found = match there.plan_sha256 == now.plan_sha256 {
        true => format!("{folder}, which holds results of this plan already"),
        false => format!("{folder}, which holds another plan ({:?}, {} runs)", there.plan, there.runs),
    };
    let allowed = "an empty folder, `--resume` to go on with this plan, `--force` to replace what is there, \
                   or `mrbd aggregate` to read it";
    InputError::option("--out", found, allowed)
}

fn check_same(path: &Path, there: &Manifest, now: &Manifest) -> Result<()> {
    let differences = differences(there, now);
    if differences.is_empty() {
        return Ok(());
    }
    let found = format!("{}, which holds another plan: {}", path.display(), differences.join("; "));
    let allowed = "the folder of the same plan, inputs and version; `--force` replaces what is there";
    Err(InputError::option("--out", found, allowed).into())
}

/// Removes what an earlier study left, so that nothing of it can be taken for this one's.
fn clear(path: &Path) -> Result<()> {
    let removed = |path: &Path, result: std::io::Result<()>| match result {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io("remove earlier results", path, e)),
        _ => Ok(()),
    };
    let folders = ["runs", "blocks"].map(|name| path.join(name));
    folders.iter().try_for_each(|folder| removed(folder, fs::remove_dir_all(folder)))?;
    let derived = [
        "checksums.json",
        "medians.parquet",
        "sequences.parquet",
        "indices.parquet",
        "findings.csv",
        crate::store::PAGE_NAME,
    ];
    let derived = derived.map(|name| path.join(name));
    derived.iter().try_for_each(|file| removed(file, fs::remove_file(file)))
}

/// The name of a file that a study does not begin with, if there is one.
fn other_file(path: &Path) -> Result<Option<String>> {
    for entry in fs::read_dir(path).map_err(|e| Error::io("read", path, e))? {
        let name = entry.map_err(|e| Error::io("read", path, e))?.file_name();
        let name = name.to_string_lossy();
        // Left by a process that was stopped before it wrote the manifest, or being written by another shard.
        let ours = name == "lock" || name.starts_with(UNFINISHED) || name.starts_with(".tmp");
        if !ours {
            return Ok(Some(name.into_owned()));
        }
    }
    Ok(None)
}

/// A record's name as part of a folder's name, as Hive and its readers write it: odd bytes as %XX.
pub(super) fn as_folder_name(name: &str) -> String {
    const ODD: &AsciiSet = &NON_ALPHANUMERIC.remove(b'.').remove(b'_').remove(b'-');
    utf8_percent_encode(name, ODD).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_odd_bytes_of_folders_are_escaped_and_plain_ones_stay() {
        assert_eq!(as_folder_name("a b/c=ü"), "a%20b%2Fc%3D%C3%BC");
    }
    use crate::study::pipeline::Pipeline;
    use crate::study::plan::Plan;

    fn manifest() -> Manifest {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/check.toml");
        let pipeline = Pipeline::load(&path).expect("the repository's pipeline");
        let plan = Plan::load(&pipeline, None).expect("a plan");
        Manifest::of(&plan, &pipeline, &pipeline.suite, None).expect("a manifest")
    }

    #[test]
    fn regress_a_shard_that_begins_a_moment_later_removes_nothing_of_the_first() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (path, name) = (folder.path(), folder.path().join("manifest.json"));
        let (first, share) = (manifest(), Earlier::Share);
        // Both find the folder empty; the first begins and stores a block before the second goes on.
        assert!(!fit(path, &first, share).expect("an empty folder"));
        let _held = OutputFolder::prepare(path, &first, "", share).expect("an empty folder");
        fs::create_dir(path.join("blocks")).expect("made");
        fs::write(path.join("blocks/block"), "runs").expect("written");
        let written = fs::read(&name).expect("a manifest");
        let second = Manifest { started_unix_s: first.started_unix_s + 1, ..first.clone() };
        begin(path, &second, share).expect("the same plan");
        let other = Manifest { plan_sha256: "another".to_owned(), ..first };
        let error = begin(path, &other, share).expect_err("another plan");
        assert!(error.to_string().contains("plan_sha256"), "{error}");
        assert_eq!(fs::read(&name).expect("a manifest"), written);
        assert!(path.join("blocks/block").is_file());
    }

    #[test]
    fn regress_folder_names_escape_what_hive_escapes() {
        assert_eq!(as_folder_name("20030501_0027_AI.049-EW"), "20030501_0027_AI.049-EW");
        assert_eq!(as_folder_name("a b/c=ü"), "a%20b%2Fc%3D%C3%BC");
    }
}

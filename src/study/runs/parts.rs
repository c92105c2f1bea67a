//! The files of runs in an output folder: blocks as they are finished, and one file a record in the end.
//!
//! ```text
//! blocks/record=<name>/block-<index>-<checksum>.parquet    while a record is unfinished
//! runs/record=<name>/part-1.parquet                        afterwards
//! checksums.json                                           SHA-256 of the latter
//! ```
//!
//! Of a study of sequences a folder is one of a sequence, `sequence=<name>`.
//!
//! A record's part counts only once its checksum is on the disk; until then its blocks do. A part without both is not
//! trusted: nobody knows whether it is what was written.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::PoisonError;

use arrow_array::RecordBatch;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use rayon::prelude::*;

use super::folder::{OutputFolder, as_folder_name};
use super::schema::COLUMNS;
use crate::error::{Error, InputError, Result};
use crate::store::durable::{UNFINISHED, write_durably};
use crate::store::parquet_file::{Form, Pages, ParquetFile};
use crate::study::batch::Finished;
use mrbd_files::checksum::sha256;

/// Digits of a checksum in a file's name: a damaged file passes once in 10¹⁹.
const DIGITS: usize = 16;

/// In the place of a checksum that is not known; no SHA-256 begins so.
const UNKNOWN: &str = "unknown";

/// Rows added at once when blocks are put together: more than any block of a sensible size has.
const ROWS_AT_ONCE: usize = 1 << 16;

/// A file of runs and what its SHA-256 must begin with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunFile {
    /// The file.
    pub path: PathBuf,
    checksum: String,
}

impl RunFile {
    /// Why its runs cannot be taken as they are; `None` where they can.
    ///
    /// # Errors
    /// As [`RunFile::is_whole`].
    fn fault(&self) -> Result<Option<&'static str>> {
        Ok(match self.is_whole()? {
            true => None,
            false if self.checksum == UNKNOWN => Some("a file of runs without a checksum in checksums.json"),
            false => Some("damaged, or gone"),
        })
    }

    /// Whether the file is there and holds what was written.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if it is there and cannot be read.
    pub fn is_whole(&self) -> Result<bool> {
        match File::open(&self.path).and_then(sha256) {
            Ok(found) => Ok(found.starts_with(&self.checksum)),
            Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
            Err(e) => Err(Error::io("read", &self.path, e)),
        }
    }
}

/// The file of a record while blocks are added to it, in their order. The same rows give the same bytes whichever way they come.
pub struct Part(ParquetFile);

impl Part {
    /// Adds the rows of a block.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
    pub fn add(&mut self, rows: &RecordBatch) -> Result<()> {
        let all = rows.num_rows();
        (0..all)
            .step_by(ROWS_AT_ONCE)
            .try_for_each(|first| self.0.write_batch(&rows.slice(first, ROWS_AT_ONCE.min(all - first))))
    }

    /// Adds the rows of a block, read off its file.
    ///
    /// # Errors
    /// As [`Part::add`].
    pub fn add_file(&mut self, block: &Path) -> Result<()> {
        let failed = |e: &dyn std::fmt::Display| Error::table(block, e);
        let file = File::open(block).map_err(|e| Error::io("read", block, e))?;
        let reader = ParquetRecordBatchReaderBuilder::try_new(file)
            .and_then(|builder| builder.with_batch_size(ROWS_AT_ONCE).build())
            .map_err(|e| failed(&e))?;
        for batch in reader {
            self.0.write_batch(&batch.map_err(|e| failed(&e))?)?;
        }
        Ok(())
    }
}

/// Checksums of parts, by the folder name of the record.
type Checksums = BTreeMap<String, String>;

impl OutputFolder {
    /// Stores the runs of a block; it is there whole when this returns its file, and its rows.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
    pub fn write_block(&self, record: &str, index: u64, runs: &[Finished]) -> Result<(PathBuf, RecordBatch)> {
        let folder = make(&self.blocks_folder(record))?;
        let form = self.form(Pages::Plain)?;
        let rows = form.batch(runs).map_err(|e| Error::table(&folder, e))?;
        let mut file = ParquetFile::create_in(&folder, form)?;
        file.write_batch(&rows)?;
        let name = |sha256: &str| folder.join(format!("block-{index:06}-{}.parquet", &sha256[..DIGITS]));
        file.finish_as(name).map(|sha256| (name(&sha256), rows))
    }

    /// The blocks of a record that are on the disk, by their positions; the last file of a position counts.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the folder cannot be read.
    pub fn blocks(&self, record: &str) -> Result<Vec<(u64, RunFile)>> {
        block_files(&self.blocks_folder(record))
    }

    /// The file of a record, if it was finished; without a checksum it is never whole.
    ///
    /// # Errors
    /// As [`OutputFolder::blocks`]; an input error for a `checksums.json` that is none.
    pub fn part(&self, record: &str) -> Result<Option<RunFile>> {
        let path = self.part_path(record);
        Ok(match read_checksums(self.path())?.remove(&self.hive(record)) {
            Some(checksum) => Some(RunFile { path, checksum }),
            None if self.blocks_folder(record).is_dir() => None,
            None => path.is_file().then(|| RunFile { path, checksum: UNKNOWN.to_owned() }),
        })
    }

    /// Puts blocks together into the file of a record, in their order; it counts once it is kept. Returns its checksum.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses; the blocks stay.
    pub fn write_part<'a>(
        &self,
        record: &str,
        mut blocks: impl Iterator<Item = &'a PathBuf>,
    ) -> Result<String> {
        let mut part = self.begin_part(record)?;
        blocks.try_for_each(|block| part.add_file(block))?;
        self.finish_part(record, part)
    }

    /// Begins the file of a record, to which its blocks are added.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
    pub fn begin_part(&self, record: &str) -> Result<Part> {
        let folder = make(&self.path().join("runs").join(self.hive(record)))?;
        Ok(Part(ParquetFile::create_in(&folder, self.form(Pages::Small)?)?))
    }

    /// Ends the file of a record; it counts once it is kept. Returns its checksum.
    ///
    /// # Errors
    /// As [`OutputFolder::begin_part`].
    pub fn finish_part(&self, record: &str, part: Part) -> Result<String> {
        part.0.finish_as(|_| self.part_path(record))
    }

    /// Notes the checksum of the file of a record; threads may do so at once.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses; an input error for a `checksums.json` that is none.
    pub fn keep_part(&self, record: &str, sha256: String) -> Result<()> {
        let _one_at_a_time = self.checksums.lock().unwrap_or_else(PoisonError::into_inner);
        let mut checksums = read_checksums(self.path())?;
        checksums.insert(self.hive(record), sha256);
        write_checksums(self.path(), &checksums)
    }

    /// Forgets a part that is damaged, so that its runs count as missing.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn discard_part(&self, record: &str) -> Result<()> {
        let mut checksums = read_checksums(self.path())?;
        checksums.remove(&self.hive(record));
        write_checksums(self.path(), &checksums)?;
        match fs::remove_file(self.part_path(record)) {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io("remove", &self.part_path(record), e)),
            _ => Ok(()),
        }
    }

    /// Removes the blocks of a record whose part is finished.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn remove_blocks(&self, record: &str) -> Result<()> {
        remove_folder(&self.blocks_folder(record))
    }

    /// Removes what killed processes left half-written, and the folder of blocks if it is empty.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if the disk refuses.
    pub fn remove_leftovers(&self) -> Result<()> {
        remove_folder(&self.path().join("blocks"))?;
        let mut folders = vec![self.path().to_path_buf()];
        folders.extend(entries(&self.path().join("runs"))?.into_iter().filter(|entry| entry.is_dir()));
        for folder in folders {
            for file in entries(&folder)?.into_iter().filter(|file| name_of(file).starts_with(UNFINISHED)) {
                fs::remove_file(&file).map_err(|e| Error::io("remove", &file, e))?;
            }
        }
        Ok(())
    }

    /// Name of the folder of a record, or of a sequence of them.
    fn hive(&self, record: &str) -> String {
        format!("{}={}", self.manifest().motion_key(), as_folder_name(record))
    }

    /// The form of a block, or of the file of a record.
    fn form(&self, pages: Pages) -> Result<&Form<Finished>> {
        let of_pages = match pages {
            Pages::Plain => &self.forms[0],
            Pages::Small => &self.forms[1],
        };
        if let Some(form) = of_pages.get() {
            return Ok(form);
        }
        let manifest = self.manifest();
        let form = Form::new(COLUMNS, &manifest.file_metadata(), manifest.seed.is_some(), pages);
        let form = form.map_err(|e| Error::table(self.path(), e))?;
        Ok(of_pages.get_or_init(|| form))
    }

    fn blocks_folder(&self, record: &str) -> PathBuf {
        self.path().join("blocks").join(self.hive(record))
    }

    fn part_path(&self, record: &str) -> PathBuf {
        self.path().join("runs").join(self.hive(record)).join("part-1.parquet")
    }
}

/// The Parquet files of a study's runs, sorted by path; of an unfinished study, those there are. Each holds what was written:
/// figures are not made of anything else.
///
/// # Errors
/// An input error for a folder without any, and for a file that is damaged or gone; [`mrbd_files::Error::Io`] if one cannot be read.
pub fn run_files(path: &Path) -> Result<Vec<PathBuf>> {
    let files = listed(path)?;
    if files.is_empty() {
        let allowed = "the output folder of `mrbd run`, with runs/record=*/part-1.parquet";
        return Err(InputError::file(path, "no results", allowed).into());
    }
    let faults: Vec<_> = files.par_iter().map(RunFile::fault).collect::<Result<_>>()?;
    for (file, fault) in files.iter().zip(faults) {
        if let Some(fault) = fault {
            let allowed =
                "the file, and its checksum, as they were written; `mrbd run … --resume` does its runs again";
            return Err(InputError::file(&file.path, fault, allowed).into());
        }
    }
    Ok(files.into_iter().map(|file| file.path).collect())
}

/// The same files, not checked; none for a folder without any.
///
/// # Errors
/// As [`OutputFolder::part`].
pub fn listed_run_files(path: &Path) -> Result<Vec<PathBuf>> {
    Ok(listed(path)?.into_iter().map(|file| file.path).collect())
}

/// The files of a study's runs, sorted by path, not checked.
fn listed(path: &Path) -> Result<Vec<RunFile>> {
    let finished = read_checksums(path)?;
    let part = |(record, checksum): (&String, &String)| RunFile {
        path: path.join("runs").join(record).join("part-1.parquet"),
        checksum: checksum.clone(),
    };
    let mut files = finished.iter().map(part).collect::<Vec<_>>();
    let unfinished = |folder: &PathBuf| folder.is_dir() && !finished.contains_key(&name_of(folder));
    for folder in entries(&path.join("blocks"))?.into_iter().filter(unfinished) {
        files.extend(block_files(&folder)?.into_iter().map(|(_, file)| file));
    }
    let has_blocks = |folder: &Path| path.join("blocks").join(name_of(folder)).is_dir();
    let unknown = entries(&path.join("runs"))?.into_iter().filter(|f| unfinished(f) && !has_blocks(f));
    let parts = unknown.map(|folder| folder.join("part-1.parquet")).filter(|part| part.is_file());
    files.extend(parts.map(|path| RunFile { path, checksum: UNKNOWN.to_owned() }));
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

fn block_files(folder: &Path) -> Result<Vec<(u64, RunFile)>> {
    let mut files: Vec<_> = entries(folder)?.into_iter().filter_map(block_file).collect();
    files.sort_by(|a, b| (a.0, &a.1.path).cmp(&(b.0, &b.1.path)));
    Ok(files)
}

/// `block-000012-0123456789abcdef.parquet`; other files are none of ours.
fn block_file(path: PathBuf) -> Option<(u64, RunFile)> {
    let name = name_of(&path);
    let (index, checksum) = name.strip_prefix("block-")?.strip_suffix(".parquet")?.split_once('-')?;
    let checksum = (checksum.len() == DIGITS).then(|| checksum.to_owned())?;
    Some((index.parse().ok()?, RunFile { path, checksum }))
}

fn checksums_path(path: &Path) -> PathBuf {
    path.join("checksums.json")
}

fn read_checksums(path: &Path) -> Result<Checksums> {
    let path = checksums_path(path);
    match fs::read(&path) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(Checksums::new()),
        Err(e) => Err(Error::io("read", &path, e)),
        Ok(bytes) => serde_json::from_slice(&bytes)
            .map_err(|e| InputError::file(&path, e.to_string(), "SHA-256 by record").into()),
    }
}

fn write_checksums(path: &Path, checksums: &Checksums) -> Result<()> {
    let text = format!("{:#}\n", serde_json::json!(checksums));
    write_durably(&checksums_path(path), text.as_bytes())
}

fn name_of(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn make(folder: &Path) -> Result<PathBuf> {
    fs::create_dir_all(folder).map_err(|e| Error::io("make the folder", folder, e))?;
    Ok(folder.to_path_buf())
}

fn remove_folder(folder: &Path) -> Result<()> {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io("remove", folder, e)),
        _ => Ok(()),
    }
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
    fn rejects_a_folder_without_results() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let error = run_files(folder.path()).expect_err("no results");
        assert_eq!(error.exit_code(), 2);
    }

    #[test]
    fn regress_other_files_are_no_blocks() {
        let of = |name: &str| block_file(PathBuf::from(name)).map(|(index, _)| index);
        assert_eq!(of("x/block-000012-0123456789abcdef.parquet"), Some(12));
        for other in [
            "block-12.parquet",
            ".unfinished-x",
            "block-000012-0123.parquet",
            "block-a-0123456789abcdef.parquet",
        ] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}

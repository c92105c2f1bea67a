//! Candidates for a suite, and writing those that were chosen.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use super::suite_file::{RecordEntry, SuiteFile};
use super::{ReadOptions, Record, RecordTable, Selection, Suite, read, write_two_columns};
use mrbd_files::error::{Error, InputError, Result};
use mrbd_files::toml_file;

/// Files that lie beside records and are none.
const NO_RECORDS: [&str; 5] = ["toml", "md", "json", "py", "license"];

/// Records that a suite can be made of: those of a suite file, or the files of a folder.
#[derive(Debug, Clone)]
pub struct SuiteSource {
    path: PathBuf,
    file: SuiteFile,
}

impl SuiteSource {
    /// Opens a suite file, or lists a folder.
    ///
    /// In a folder, `options` hold for every file, and files whose names begin with the same `event_prefix` characters
    /// are of one event; with 0, every file is of its own.
    ///
    /// # Errors
    /// Input errors for a suite file that is none, or a folder without files.
    pub fn open(path: &Path, options: &ReadOptions, event_prefix: usize) -> Result<Self> {
        if !path.is_dir() {
            return Ok(Self { path: path.to_owned(), file: toml_file::load(path)? });
        }
        let files = record_files(path)?;
        let entry = |(index, name): (usize, String)| RecordEntry {
            id: index as u32 + 1,
            channel: options.channel.clone(),
            scale: 1.0,
            event: name.chars().take(event_prefix).collect(),
            file: Some(name),
            ..RecordEntry::default()
        };
        let records = files.into_iter().enumerate().map(entry).collect();
        let (name, note, source) = (path.display().to_string(), String::new(), String::new());
        let file = SuiteFile {
            name,
            generated: false,
            note,
            source,
            unit: options.unit,
            step_s: options.step_s,
            records,
        };
        Ok(Self { path: path.join("suite.toml"), file })
    }

    /// Reads the records.
    ///
    /// # Errors
    /// As [`Suite::load`].
    pub fn load(&self) -> Result<Suite> {
        Suite::from_file(&self.path, &self.file)
    }

    /// Writes a selection as the suite file `out`, its files named relative to the folder of `out`.
    ///
    /// # Errors
    /// Where the suite cannot be written.
    pub fn write_selection(&self, selection: &Selection, name: &str, note: &str, out: &Path) -> Result<()> {
        let folder = out.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).map_err(|e| Error::io("make the folder", folder, e))?;
        let mut records = Vec::with_capacity(selection.members.len());
        for (&member, scale) in selection.members.iter().zip(&selection.scales) {
            let mut entry = self.file.records[member].clone();
            entry.vertical_scale = entry.vertical_scale.map(|vertical| vertical * scale);
            entry.scale *= scale;
            entry.file = entry.file.map(|file| self.relative(&file, folder)).transpose()?;
            entry.vertical = entry.vertical.map(|file| self.relative(&file, folder)).transpose()?;
            records.push(entry);
        }
        let suite = SuiteFile { name: name.to_owned(), note: note.to_owned(), records, ..self.file.clone() };
        suite.write(out)
    }

    /// A file of this source as seen from `folder`.
    fn relative(&self, file: &str, folder: &Path) -> Result<String> {
        let here = self.path.parent().unwrap_or(Path::new("")).join(file);
        let absolute = |path: &Path| std::fs::canonicalize(path).map_err(|e| Error::io("find", path, e));
        let (target, base) = (absolute(&here)?, absolute(folder)?);
        let shared = target.components().zip(base.components()).take_while(|(a, b)| a == b).count();
        let up = base.components().skip(shared).map(|_| Component::ParentDir);
        let relative: PathBuf = up.chain(target.components().skip(shared)).collect();
        Ok(relative.to_string_lossy().into_owned())
    }
}

fn record_files(folder: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder).map_err(|e| Error::io("list", folder, e))?;
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|e| Error::io("list", folder, e))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let extension =
            Path::new(&name).extension().map_or_else(String::new, |e| e.to_string_lossy().to_lowercase());
        let is_hidden = name.starts_with('.');
        if entry.path().is_file() && !is_hidden && !NO_RECORDS.contains(&extension.as_str()) {
            names.push(name);
        }
    }
    // The system lists in any order.
    names.sort();
    if names.is_empty() {
        return Err(InputError::file(folder, "no files", "a folder of records, or a suite file").into());
    }
    Ok(names)
}

/// A record that a user brings for a row of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Import {
    /// Number of the row.
    pub id: u32,
    /// The record as it was read.
    pub record: Record,
    /// Its vertical component.
    pub vertical: Option<Record>,
}

/// Reads the files that a user brings for rows of `table`, horizontal and vertical by the number of the row.
///
/// # Errors
/// Input errors for files that cannot be read and numbers that the table does not have.
pub fn read_imports(
    table: &RecordTable,
    horizontal: &BTreeMap<u32, PathBuf>,
    vertical: &BTreeMap<u32, PathBuf>,
    options: &ReadOptions,
) -> Result<Vec<Import>> {
    if let Some(id) = vertical.keys().find(|id| !horizontal.contains_key(id)) {
        return Err(
            InputError::option("--vertical", id.to_string(), "a number with a horizontal record").into()
        );
    }
    let import = |(&id, path): (&u32, &PathBuf)| {
        if !table.records.iter().any(|row| row.id == id) {
            return Err(
                InputError::option("--record", id.to_string(), "the number of a row of the table").into()
            );
        }
        let vertical = vertical.get(&id).map(|path| read(path, options)).transpose()?;
        Ok(Import { id, record: read(path, options)?, vertical })
    };
    horizontal.iter().map(import).collect()
}

/// Writes imported records as two columns into `folder`, and the suite that lists them with what the table says.
///
/// # Errors
/// Where a file cannot be written, and input errors where a peak contradicts the table.
pub fn write_imports(folder: &Path, name: &str, table: &RecordTable, imports: &[Import]) -> Result<Suite> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io("make the folder", folder, e))?;
    let mut records = Vec::with_capacity(imports.len());
    for row in &table.records {
        let Some(import) = imports.iter().find(|import| import.id == row.id) else { continue };
        let file = format!("{}_{}.csv", row.id, row.archive_id);
        write_two_columns(&folder.join(&file), &import.record.accelerogram)?;
        let mut entry = RecordEntry::of_row(row, file);
        if let Some(vertical) = &import.vertical {
            let file = format!("{}_{}_vertical.csv", row.id, row.archive_id);
            write_two_columns(&folder.join(&file), &vertical.accelerogram)?;
            entry.vertical = Some(file);
        }
        records.push(entry);
    }
    let (note, source) = (String::new(), table.source.clone());
    let file = SuiteFile {
        name: name.to_owned(),
        generated: false,
        note,
        source,
        unit: None,
        step_s: None,
        records,
    };
    let path = folder.join("suite.toml");
    // Read back before it is written: peaks that contradict the table leave no suite behind.
    let suite = Suite::from_file(&path, &file)?;
    file.write(&path)?;
    Ok(suite)
}

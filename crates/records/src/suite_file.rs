//! A suite file as it is written, before its records are read; and suites made of a folder or of a selection.

use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::record_table::TableRow;
use super::{ColumnChoice, Pulse, ReadOptions, Selection, Suite, Unit};
use mrbd_files::error::{Error, InputError, Result};
use mrbd_files::toml_file;

/// Extensions of files that lie beside records.
const NO_RECORDS: [&str; 5] = ["toml", "md", "json", "py", "license"];

/// The whole file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SuiteFile {
    pub name: String,
    #[serde(default, skip_serializing_if = "is_false")]
    pub generated: bool,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    pub unit: Option<Unit>,
    pub step_s: Option<f64>,
    pub columns: Option<ColumnChoice>,
    #[serde(default, skip_serializing_if = "is_false")]
    pub decimal_comma: bool,
    pub records: Vec<RecordEntry>,
}

/// One `[[records]]`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordEntry {
    pub id: u32,
    pub name: Option<String>,
    pub file: Option<String>,
    pub channel: Option<String>,
    pub unit: Option<Unit>,
    pub step_s: Option<f64>,
    pub columns: Option<ColumnChoice>,
    #[serde(default, skip_serializing_if = "is_false")]
    pub decimal_comma: bool,
    #[serde(default = "one")]
    pub scale: f64,
    pub vertical: Option<String>,
    pub vertical_channel: Option<String>,
    pub vertical_scale: Option<f64>,
    pub pga_g: Option<f64>,
    pub pgv_m_s: Option<f64>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub event: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    pub magnitude: Option<f64>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub station: String,
    pub distance_km: Option<f64>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub soil: String,
    #[serde(default, skip_serializing_if = "is_false")]
    pub generated: bool,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    // A table: last, because in TOML plain keys come before tables.
    pub pulse: Option<Pulse>,
}

fn one() -> f64 {
    1.0
}

// The argument's form is set by serde.
fn is_false(value: &bool) -> bool {
    !value
}

impl SuiteFile {
    /// Writes the suite file `path`.
    pub fn write(&self, path: &Path) -> Result<()> {
        let text = toml::to_string(self)
            .map_err(|e| InputError::file(path, e.to_string(), "a suite that TOML can hold"))?;
        std::fs::write(path, text).map_err(|e| Error::io("write the suite", path, e))
    }
}

impl RecordEntry {
    /// The entry of a row of a table whose samples are in `file`.
    pub fn of_row(row: &TableRow, file: String) -> Self {
        Self {
            id: row.id,
            file: Some(file),
            scale: row.scale,
            pga_g: Some(row.pga_g),
            pgv_m_s: Some(row.pgv_m_s),
            event: row.event.clone(),
            date: row.date.clone(),
            magnitude: Some(row.magnitude),
            station: row.station.clone(),
            distance_km: Some(row.distance_km),
            soil: row.soil.clone(),
            ..Self::default()
        }
    }
}

/// Records that a suite can be made of: those of a suite file, or the files of a folder.
#[derive(Debug, Clone)]
pub struct SuiteSource {
    path: PathBuf,
    file: SuiteFile,
}

impl SuiteSource {
    /// Opens a suite file, or lists a folder.
    ///
    /// In a folder, `options` hold for every file. Files whose names begin with the same `event_prefix` characters
    /// are of one event; with 0, every file is of its own.
    ///
    /// # Errors
    /// Input errors for a file that is no suite, or a folder without files.
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
            columns: options.columns.clone(),
            decimal_comma: options.decimal_comma,
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

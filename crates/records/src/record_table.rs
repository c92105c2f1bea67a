//! A published table of records without their samples, and the files that a user brings for its rows.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::suite_file::{RecordEntry, SuiteFile};
use super::{ReadOptions, Record, Suite, read, write_two_columns};
use mrbd_files::error::{Error, InputError, Result};
use mrbd_files::toml_file;

/// A table of records, as `inputs/table4.toml`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordTable {
    /// Where the table was published.
    pub source: String,
    /// Its rows.
    pub records: Vec<TableRow>,
}

/// One record of a table.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableRow {
    /// Number in the table.
    pub id: u32,
    /// Earthquake.
    pub event: String,
    /// Date of the earthquake.
    pub date: String,
    /// Moment magnitude.
    pub magnitude: f64,
    /// Station that recorded it.
    pub station: String,
    /// Distance from the epicentre, km.
    pub distance_km: f64,
    /// Class of the soil.
    pub soil: String,
    /// Peak acceleration before scaling, g.
    pub pga_g: f64,
    /// Peak velocity before scaling, m/s.
    pub pgv_m_s: f64,
    /// Name in REXEL or in the archive it came from.
    pub archive_id: String,
    /// Factor it was used with.
    pub scale: f64,
    /// Period of a near-fault pulse in it, s.
    pub pulse_period_s: Option<f64>,
}

impl RecordTable {
    /// Loads a table.
    ///
    /// # Errors
    /// Input errors that name the file and the key.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, &toml_file::read(path)?)
    }

    /// Checks the text of a table that came from `path`.
    ///
    /// # Errors
    /// As [`RecordTable::load`].
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let table: Self = toml_file::parse(path, text)?;
        if table.records.is_empty() {
            return Err(InputError::key(path, "records", "no records", "at least one `[[records]]`").into());
        }
        for (index, row) in table.records.iter().enumerate() {
            row.check(path, index)?;
        }
        Ok(table)
    }
}

impl TableRow {
    fn check(&self, path: &Path, index: usize) -> Result<(), InputError> {
        for (key, value, range) in [
            ("magnitude", self.magnitude, 3.0..=9.5),
            ("distance_km", self.distance_km, 0.0..=1000.0),
            ("pga_g", self.pga_g, 1e-3..=5.0),
            ("pgv_m_s", self.pgv_m_s, 1e-4..=5.0),
            ("scale", self.scale, 0.01..=100.0),
            ("pulse_period_s", self.pulse_period_s.unwrap_or(1.0), 0.1..=10.0),
        ] {
            if !range.contains(&value) {
                let allowed = format!("{} to {}", range.start(), range.end());
                let key = format!("records[{index}].{key}");
                return Err(InputError::key(path, key, value.to_string(), allowed));
            }
        }
        self.check_archive_id(path, index)
    }

    /// The id becomes part of the name of a file.
    fn check_archive_id(&self, path: &Path, index: usize) -> Result<(), InputError> {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        if !self.archive_id.is_empty() && self.archive_id.chars().all(is_plain) {
            return Ok(());
        }
        let found = format!("`{}`", self.archive_id.escape_debug());
        let key = format!("records[{index}].archive_id");
        Err(InputError::key(path, key, found, "letters, digits, dots, dashes and underlines"))
    }
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
        columns: None,
        decimal_comma: false,
        records,
    };
    let path = folder.join("suite.toml");
    // Read back before it is written: peaks that contradict the table leave no suite behind.
    let suite = Suite::from_file(&path, &file)?;
    file.write(&path)?;
    Ok(suite)
}

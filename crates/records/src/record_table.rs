//! A published table of records: what is known of records whose samples are not at hand.

use std::path::Path;

use serde::Deserialize;

use mrbd_files::error::{InputError, Result};
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

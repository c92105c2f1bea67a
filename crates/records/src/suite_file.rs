//! A suite file as it is written, before its records are read.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::record_table::TableRow;
use super::{Pulse, Unit};
use mrbd_files::error::{Error, Result};

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
        // Strings, numbers and lists of them, the tables last, always make TOML.
        let text = toml::to_string(self).expect("a suite is valid TOML");
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

//! A suite file as it is written, before its records are read.

use serde::Deserialize;

use super::Unit;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SuiteFile {
    pub name: String,
    pub unit: Option<Unit>,
    pub step_s: Option<f64>,
    #[serde(default)]
    pub generated: bool,
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub source: String,
    pub records: Vec<RecordEntry>,
}

/// One `[[records]]`.
#[derive(Debug, Deserialize)]
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
    #[serde(default)]
    pub event: String,
    #[serde(default)]
    pub generated: bool,
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub source: String,
    #[serde(default)]
    pub date: String,
    #[serde(default)]
    pub station: String,
    #[serde(default)]
    pub soil: String,
    pub magnitude: Option<f64>,
    pub distance_km: Option<f64>,
}

fn one() -> f64 {
    1.0
}

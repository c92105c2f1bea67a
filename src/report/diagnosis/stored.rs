//! `diagnosis.json` and the tables beside it, as far as the page tells of them.

use std::collections::BTreeMap;
use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};
use serde::Deserialize;

use super::super::provenance::read_json;
use crate::error::{Error, InputError, Result};
use crate::fragility::Table;

/// What a diagnosis found.
#[derive(Debug, Deserialize)]
pub struct Stored {
    pub verdict: String,
    pub place: Option<String>,
    pub effects: Vec<StoredEffect>,
    pub equivalent: Vec<String>,
    pub wall: Vec<StoredNumber>,
    pub tests: Vec<StoredTest>,
    #[serde(default)]
    pub other_law: Option<StoredOtherLaw>,
    #[serde(default)]
    pub windows: StoredWindows,
    pub windowed_error: Steps,
    pub against: Option<Steps>,
    pub could_hide: Vec<StoredPower>,
    #[serde(default)]
    pub confused: Vec<StoredConfused>,
    pub rivals: Vec<StoredRival>,
    pub missing_force: StoredForce,
    #[serde(default)]
    pub next_tests: Option<StoredNext>,
}

#[derive(Debug, Default, Deserialize)]
pub struct StoredWindows {
    #[serde(default)]
    pub opened: usize,
}

#[derive(Debug, Deserialize)]
pub struct StoredEffect {
    pub name: Option<String>,
    pub place: Option<String>,
    pub parameters: BTreeMap<String, f64>,
    pub interval: BTreeMap<String, [f64; 2]>,
    /// The effect in the wall file that it is, where that goes by another name.
    #[serde(default)]
    pub written_as: Option<String>,
    /// Displacement over which friction sets in, m, where it does not jump.
    #[serde(default)]
    pub sets_in_over_m: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredOtherLaw {
    pub looks_like: Vec<String>,
}

#[derive(Debug, Deserialize)]
pub struct StoredNumber {
    pub key: String,
    pub unit: String,
    pub before: f64,
    pub prior_sd: Option<f64>,
    pub after: f64,
    pub sd: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredTest {
    pub name: String,
    #[serde(rename = "use")]
    pub purpose: String,
    pub windowed_error: BeforeAfter,
    pub wme: BeforeAfter,
    pub noise_rad: [f64; 2],
    #[serde(default = "no_gain")]
    pub read_gain: [f64; 2],
}

fn no_gain() -> [f64; 2] {
    [1.0; 2]
}

#[derive(Debug, Deserialize)]
pub struct BeforeAfter {
    pub before: Option<f64>,
    pub after: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct Steps {
    pub before: Option<f64>,
    pub recalibrated: Option<f64>,
    pub after: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredPower {
    pub name: String,
    pub parameter: String,
    pub unit: String,
    pub estimate: f64,
    pub sd: f64,
    pub smallest_detectable: f64,
    pub named_from: f64,
    pub matters: f64,
}

#[derive(Debug, Deserialize)]
pub struct StoredConfused {
    pub effect: String,
    pub imitated_by: String,
    pub share: f64,
    pub parameter: String,
    pub unit: String,
    pub told_from_nothing: f64,
    pub told_apart: f64,
    pub matters: f64,
    pub told_by: String,
}

#[derive(Debug, Deserialize)]
pub struct StoredRival {
    pub name: String,
    pub place: Option<String>,
    pub parameters: Vec<StoredParameter>,
    pub windowed_error: FitHeld,
    pub against: Against,
    pub wme: FitHeld,
    #[serde(default)]
    pub wme_range: RangeFitHeld,
}

/// Least and largest over an ensemble of the fitted numbers.
#[derive(Debug, Default, Deserialize)]
pub struct RangeFitHeld {
    pub fit: Option<[f64; 2]>,
    pub held_out: Option<[f64; 2]>,
}

#[derive(Debug, Deserialize)]
pub struct StoredParameter {
    pub key: String,
    pub unit: String,
    pub value: f64,
    pub sd: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct FitHeld {
    pub fit: Option<f64>,
    pub held_out: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct Against {
    pub all: f64,
}

#[derive(Debug, Deserialize)]
pub struct StoredForce {
    pub points: u64,
    pub before: StoredSize,
    pub after: StoredSize,
    pub median_share_off_top: Option<f64>,
    pub explained_by: BTreeMap<String, Option<f64>>,
    pub points_with_direction: u64,
    pub arms_of_top_m: [f64; 2],
}

#[derive(Debug, Deserialize)]
pub struct StoredSize {
    pub rms_n: f64,
    pub noise_rms_n: f64,
}

/// What would separate hypotheses that these tests do not.
#[derive(Debug, Deserialize)]
pub struct StoredNext {
    pub rivals: [String; 2],
    pub shaking: Vec<StoredShaking>,
    pub pull: Vec<StoredPull>,
}

#[derive(Debug, Deserialize)]
pub struct StoredShaking {
    pub test: String,
    pub scale: f64,
    pub outcome: String,
    pub error: Option<f64>,
    pub nats: Option<f64>,
    pub fitted: bool,
}

#[derive(Debug, Deserialize)]
pub struct StoredPull {
    pub displacement_m: f64,
    pub force_n: [f64; 2],
}

impl Stored {
    /// Reads `diagnosis.json`.
    ///
    /// # Errors
    /// An input error for a file that is not there or none of a diagnosis.
    pub fn read(path: &Path) -> Result<Self> {
        read_json(path, "results as `mrbd diagnose` writes them, finished")
    }

    /// Whether an effect was found.
    pub fn is_answered(&self) -> bool {
        matches!(self.verdict.as_str(), "named" | "class")
    }
}

/// Some columns of a table of the folder; one without rows has columns without values.
pub struct Columns(Option<Table>);

impl Columns {
    /// Reads columns.
    ///
    /// # Errors
    /// Input errors for a file that is no such table.
    pub fn read(path: &Path, names: &[&str]) -> Result<Self> {
        let file = std::fs::File::open(path)
            .map_err(|e| InputError::file(path, e.to_string(), "a table as `mrbd diagnose` writes it"))?;
        let reader = SerializedFileReader::new(file).map_err(|e| Error::table(path, e))?;
        let empty = reader.metadata().file_metadata().num_rows() == 0;
        Ok(Self(if empty { None } else { Some(Table::read(path, names)?) }))
    }

    /// Numbers of a column; NaN where there is none.
    ///
    /// # Errors
    /// As [`Table::numbers`].
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let Some(table) = &self.0 else { return Ok(Vec::new()) };
        Ok(table.numbers(name)?.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }

    /// Texts of a column.
    ///
    /// # Errors
    /// As [`Table::labels`].
    pub fn labels(&self, name: &str) -> Result<Vec<String>> {
        self.0.as_ref().map_or(Ok(Vec::new()), |table| table.labels(name))
    }
}

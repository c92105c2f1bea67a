//! A calibrated twin: what was true, and what was said of every number.

use std::fmt::Write as _;
use std::path::Path;

use mrbd_lab::calibrate::{Calibration, Identifiability};
use serde::{Deserialize, Serialize};

use super::super::score::reading::json;
use super::draw::Twin;

/// A calibrated twin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub set: String,
    pub number: u64,
    /// `own`, `compliant` or `init`.
    pub simulator: String,
    pub law: String,
    pub noise_rad: f64,
    pub tests: usize,
    /// Shaking of each test, s.
    pub length_s: f64,
    /// Whether the budgets were the program's own.
    pub by_default: bool,
    pub seconds: f64,
    pub numbers: Vec<Number>,
}

/// A number of a twin that acts in its tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Number {
    pub name: String,
    pub truth: f64,
    pub value: f64,
    /// The 95 % interval, where one is given.
    pub interval_95: Option<[f64; 2]>,
    pub identified: bool,
    /// What is said of it.
    pub told: String,
}

impl Number {
    /// Whether its interval holds the truth; `None` where there is none.
    pub fn holds(&self) -> Option<bool> {
        self.interval_95.map(|[low, high]| (low..=high).contains(&self.truth))
    }

    /// Distance of the value from the truth, as a share of it.
    pub fn error(&self) -> f64 {
        (self.value / self.truth - 1.0).abs()
    }
}

impl Row {
    /// The row of a twin; `None` if it has not been calibrated.
    ///
    /// # Errors
    /// Text for people if a file cannot be read.
    pub fn of(twin: &Twin, folder: &Path) -> Result<Option<Self>, String> {
        let Ok(seconds) = std::fs::read_to_string(folder.join("seconds")) else { return Ok(None) };
        let truth: serde_json::Map<String, serde_json::Value> = json(&folder.join("truth.json"))?;
        let calibration: Calibration = json(&folder.join("calibration.json"))?;
        let acts = |told: Identifiability| {
            !matches!(told, Identifiability::NeverActs | Identifiability::NothingToScale)
        };
        let parameters = calibration.parameters.iter().filter(|p| acts(p.identifiability));
        let number = |p: &mrbd_lab::calibrate::Estimate| {
            Some(Number {
                name: p.name.clone(),
                truth: truth.get(&p.name)?.as_f64()?,
                value: p.value,
                interval_95: p.interval_95,
                identified: p.identifiability == Identifiability::Identified,
                told: p.identifiability.words().to_owned(),
            })
        };
        let [simulator, law] = match &twin.case {
            None => ["init", "contact"],
            Some(case) => [case.formulation(), case.actual.law],
        }
        .map(str::to_owned);
        Ok(Some(Self {
            set: twin.set.clone(),
            number: twin.number,
            simulator,
            law,
            // That of the example stands in its source.
            noise_rad: twin.case.as_ref().map_or(1e-4, |case| case.noise_rad),
            tests: calibration.tests.iter().filter(|test| test.purpose == "fit").count(),
            length_s: twin.case.as_ref().map_or(14.0, |_| twin.length_s),
            by_default: twin.by_default,
            seconds: seconds.trim().parse().map_err(|e| format!("{}: {e}", folder.display()))?,
            numbers: parameters.filter_map(number).collect(),
        }))
    }
}

/// Reads the twins of a set that were calibrated before.
///
/// # Errors
/// Text for people: file and line of what is no twin of this set.
pub fn load(path: &Path, set: &str) -> Result<Vec<Row>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let row = |(index, line): (usize, &str)| {
        let told = |what: String| format!("{}: line {}: {what}", path.display(), index + 1);
        let row: Row = serde_json::from_str(line).map_err(|e| told(e.to_string()))?;
        if row.set == set { Ok(row) } else { Err(told(format!("a twin of the set {}, not {set}", row.set))) }
    };
    text.lines().enumerate().map(row).collect()
}

/// Writes calibrated twins, a line each.
///
/// # Errors
/// Text for people if the file cannot be written.
pub fn save(path: &Path, rows: &[Row]) -> Result<(), String> {
    let mut text = String::new();
    for row in rows {
        let line = serde_json::to_string(row).map_err(|e| e.to_string())?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{line}");
    }
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

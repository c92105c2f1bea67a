//! Reading `diagnosis.json`, which has a type, and `answer.json`, which cases write for this scorer alone.

use std::path::Path;

use mrbd_lab::diagnose::answer::Summary;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::super::diagnose::Outcome;

/// A diagnosed case: what was hidden, what was said, and how that went.
pub struct Diagnosed {
    pub answer: Value,
    /// None where the diagnosis failed.
    pub diagnosis: Option<Summary>,
    pub outcome: Outcome,
}

impl Diagnosed {
    /// Reads a case; none if it has not been diagnosed.
    ///
    /// # Errors
    /// Text for people if a file cannot be read.
    pub fn load(case: &Path) -> Result<Option<Self>, String> {
        let Some(outcome) = Outcome::load(case) else { return Ok(None) };
        let answer = json(&case.join("answer.json"))?;
        let diagnosis = match outcome.exit_code {
            Some(0) => Some(json(&case.join("diagnosis").join("diagnosis.json"))?),
            _ => None,
        };
        Ok(Some(Self { answer, diagnosis, outcome }))
    }
}

/// A JSON file.
///
/// # Errors
/// Text for people if it cannot be read, or is none of its type.
pub fn json<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
}

/// The text at a pointer, empty where there is none.
pub fn text(value: &Value, pointer: &str) -> String {
    value.pointer(pointer).and_then(Value::as_str).unwrap_or_default().to_owned()
}

/// The number at a pointer.
pub fn number(value: &Value, pointer: &str) -> Option<f64> {
    value.pointer(pointer).and_then(Value::as_f64)
}

/// The elements of the list at a pointer.
pub fn list<'a>(value: &'a Value, pointer: &str) -> &'a [Value] {
    value.pointer(pointer).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// The texts at one key of every element of a list, or the elements themselves where they are texts.
pub fn texts(value: &Value, pointer: &str, key: &str) -> Vec<String> {
    let one =
        |element: &Value| element.as_str().map_or_else(|| text(element, &format!("/{key}")), str::to_owned);
    list(value, pointer).iter().map(one).collect()
}

/// The median of the values that exist.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (n > 0).then(|| 0.5 * (values[(n - 1) / 2] + values[n / 2]))
}

//! Scored cases as a file, a line a case: a frozen program is judged on more cases than one sitting makes.

use std::fmt::Write as _;
use std::path::Path;

use super::row::Row;

/// Reads the cases of a set that were scored before, in the order of their numbers.
///
/// # Errors
/// Text for people: file and line of what is no case of this set, or comes twice.
pub fn load(path: &Path, set: &str) -> Result<Vec<Row>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut rows: Vec<Row> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let told = |what: String| format!("{}: line {}: {what}", path.display(), index + 1);
        let row: Row = serde_json::from_str(line).map_err(|e| told(e.to_string()))?;
        if row.set != set {
            return Err(told(format!("a case of the set {}, not {set}", row.set)));
        }
        if rows.last().is_some_and(|last| last.number >= row.number) {
            return Err(told(format!("case {} is not after the one before", row.number)));
        }
        rows.push(Row { recorded_as: Some(line.to_owned()), ..row });
    }
    Ok(rows)
}

/// Writes scored cases, to be read again; those that were read as they were.
///
/// # Errors
/// Text for people if the file cannot be written.
pub fn save(path: &Path, rows: &[Row]) -> Result<(), String> {
    let mut text = String::new();
    for row in rows {
        let written = || serde_json::to_string(row).map_err(|e| e.to_string());
        let line = row.recorded_as.clone().map_or_else(written, Ok)?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{line}");
    }
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

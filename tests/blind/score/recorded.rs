//! Scored cases as a file, a line a case: a frozen program is judged on more cases than one sitting makes.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A scored case that can be written and read again.
pub trait Recorded: Serialize + DeserializeOwned {
    /// Its set and its number there.
    fn case(&self) -> (&str, u64);
    /// The line that it was read from, if it was recorded before: numbers that are read and written again differ in the
    /// last bit.
    fn line(&self) -> Option<&str>;
    /// The same, read from this line.
    #[must_use]
    fn read_from(self, line: &str) -> Self;
}

/// Reads the cases of a set that were scored before, in the order of their numbers.
///
/// # Errors
/// Text for people: file and line of what is no case of this set, or comes twice.
pub fn load<R: Recorded>(path: &Path, set: &str) -> Result<Vec<R>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut rows: Vec<R> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let told = |what: String| format!("{}: line {}: {what}", path.display(), index + 1);
        let row: R = serde_json::from_str(line).map_err(|e| told(e.to_string()))?;
        let (own, number) = row.case();
        if own != set {
            return Err(told(format!("a case of the set {own}, not {set}")));
        }
        if rows.last().is_some_and(|last| last.case().1 >= number) {
            return Err(told(format!("case {number} is not after the one before")));
        }
        rows.push(row.read_from(line));
    }
    Ok(rows)
}

/// Writes scored cases, to be read again; those that were read as they were.
///
/// # Errors
/// Text for people if the file cannot be written.
pub fn save<R: Recorded>(path: &Path, rows: &[R]) -> Result<(), String> {
    let mut text = String::new();
    for row in rows {
        let written = || serde_json::to_string(row).map_err(|e| e.to_string());
        let line = row.line().map(str::to_owned).map_or_else(written, Ok)?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{line}");
    }
    std::fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}

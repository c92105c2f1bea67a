//! What a diagnosis that was stopped had fitted: a table, and no verdict.

use std::path::Path;

use crate::error::{Error, Result};
use crate::store::write_durably;
use mrbd_lab::Tried;

/// Name of the table.
pub const UNFINISHED: &str = "unfinished.csv";

const HEAD: [&str; 5] =
    ["hypothesis", "parameters", "windowed_error_fit", "windowed_error_held_out", "against"];

/// Writes the hypotheses in order, one a line; the first line without a name is the wall with its own numbers fitted.
///
/// # Errors
/// [`Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_unfinished(folder: &Path, known: &[Tried]) -> Result<()> {
    let file = folder.join(UNFINISHED);
    let mut table = csv::Writer::from_writer(Vec::new());
    let rows = known.iter().map(row);
    let all = std::iter::once(HEAD.map(str::to_owned)).chain(rows);
    all.into_iter().try_for_each(|row| table.write_record(row)).map_err(|e| Error::table(&file, e))?;
    let bytes = table.into_inner().map_err(|e| Error::table(&file, e.error().to_string()))?;
    write_durably(&file, &bytes)
}

fn row(tried: &Tried) -> [String; 5] {
    let number =
        |(key, value, unit): &(String, f64, String)| format!("{key} = {value} {unit}").trim_end().to_owned();
    let numbers = tried.numbers.iter().map(number).collect::<Vec<_>>().join("; ");
    let [fit, held_out] =
        tried.windowed_error.map(|error| error.map_or(String::new(), |error| error.to_string()));
    [tried.name.clone(), numbers, fit, held_out, tried.against.to_string()]
}

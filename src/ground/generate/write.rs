//! Writing a generated suite: two-column files and the suite file that lists them.

use std::path::Path;

use crate::error::{Error, InputError, Result};
use crate::ground::record_table::{RecordTable, TableRow};
use crate::ground::{Accelerogram, write_two_columns};

/// Writes `records`, generated for the rows of `table` with `seed`, into `folder`, with a `suite.toml` that lists them.
///
/// # Errors
/// Where the folder or a file cannot be written.
pub fn write_suite(
    folder: &Path,
    name: &str,
    table: &RecordTable,
    records: &[Accelerogram],
    seed: u64,
) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io("make the folder", folder, e))?;
    let mut suite = header(name, table, seed);
    for (row, record) in table.records.iter().zip(records) {
        let file = file_name(row)?;
        write_two_columns(&folder.join(&file), record)?;
        suite += &entry(row, &file);
    }
    write(&folder.join("suite.toml"), &suite)
}

fn write(path: &Path, text: &str) -> Result<()> {
    std::fs::write(path, text).map_err(|e| Error::io("write", path, e))
}

fn file_name(row: &TableRow) -> Result<String, InputError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    if row.archive_id.chars().all(is_plain) && !row.archive_id.starts_with('.') {
        return Ok(format!("generated_{}_{}.csv", row.id, row.archive_id));
    }
    let allowed = "letters, digits, dots, dashes and underlines, for it becomes the name of a file";
    Err(InputError::option("archive_id", format!("`{}`", row.archive_id.escape_debug()), allowed))
}

fn header(name: &str, table: &RecordTable, seed: u64) -> String {
    let note = "Generated, not measured: each record has the peak acceleration and velocity of its row and a length that \
        fits its magnitude and distance, but is noise brought to a smooth spectrum.";
    let source = format!("mrbd records generate --seed {seed}, after: {}", table.source);
    format!("name = {}\ngenerated = true\nnote = {}\nsource = {}\n", text(name), text(note), text(&source))
}

fn entry(row: &TableRow, file: &str) -> String {
    let TableRow { id, magnitude, distance_km, scale, pga_g, pgv_m_s, .. } = row;
    let (file, event, date) = (text(file), text(&row.event), text(&row.date));
    let (station, soil) = (text(&row.station), text(&row.soil));
    format!(
        "\n[[records]]\nid = {id}\nfile = {file}\nevent = {event}\ndate = {date}\nmagnitude = {magnitude:?}\n\
        station = {station}\ndistance_km = {distance_km:?}\nsoil = {soil}\nscale = {scale:?}\npga_g = {pga_g:?}\n\
        pgv_m_s = {pgv_m_s:?}\n"
    )
}

/// A TOML string.
fn text(value: &str) -> String {
    toml::Value::String(value.to_owned()).to_string()
}

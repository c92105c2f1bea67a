//! Writing a generated suite: two-column files and the suite file that lists them.

use std::path::Path;

use crate::record_table::RecordTable;
use crate::suite_file::{RecordEntry, SuiteFile};
use crate::{Accelerogram, write_two_columns};
use mrbd_files::error::{Error, Result};

const NOTE: &str = "Generated, not measured: each record has the peak acceleration and velocity of its row and a length \
    that fits its magnitude and distance, but is noise brought to a smooth spectrum.";

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
    let mut entries = Vec::with_capacity(records.len());
    for (row, record) in table.records.iter().zip(records) {
        let file = format!("generated_{}_{}.csv", row.id, row.archive_id);
        write_two_columns(&folder.join(&file), record)?;
        entries.push(RecordEntry::of_row(row, file));
    }
    let suite = SuiteFile {
        name: name.to_owned(),
        generated: true,
        note: NOTE.to_owned(),
        source: format!("mrbd records generate --seed {seed}, after: {}", table.source),
        unit: None,
        step_s: None,
        records: entries,
    };
    suite.write(&folder.join("suite.toml"))
}

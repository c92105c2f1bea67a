//! `windows.parquet`: how well every window is followed, and what happens in it.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::WindowRow;

macro_rules! impacts {
    ($name:literal, $meaning:literal, $l:literal) => {
        Column::result($name, "", $meaning, Read::Count(|r| Some(r.impacts.table2[$l])))
    };
}

static COLUMNS: [Column<WindowRow>; 17] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|r| Some(r.purpose.name().into()))),
    Column::input("from_s", "s", "first sample", Read::Number(|r: &WindowRow| Some(r.from_s))).distinct(),
    Column::input("to_s", "s", "last sample", Read::Number(|r: &WindowRow| Some(r.to_s))).distinct(),
    Column::input("pattern", "", "pattern at its start", Read::Text(|r| Some(r.contact.name().into()))),
    Column::result(
        "error_before",
        "",
        "root mean square error over the noise, wall as given",
        Read::Number(|r| r.error[0]),
    ),
    Column::result(
        "error_recalibrated",
        "",
        "the same, its uncertain numbers fitted",
        Read::Number(|r| r.error[1]),
    ),
    Column::result("error_after", "", "the same, updated wall", Read::Number(|r| r.error[2])),
    impacts!("impacts_c1", "impacts 1a to 2a of the updated wall in it", 0),
    impacts!("impacts_c2", "2a to 1a", 1),
    impacts!("impacts_c3", "1a to 2b", 2),
    impacts!("impacts_c4", "2a to 1b", 3),
    impacts!("impacts_c5", "3a to 1b", 4),
    impacts!("impacts_c6", "3a to 3b", 5),
    impacts!("impacts_c7", "1a to 3a", 6),
    impacts!("impacts_c8", "2a to 3a", 7),
    Column::result("impacts_other", "", "impacts not in Table 2", Read::Count(|r| Some(r.impacts.other))),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[WindowRow]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}

//! `jumps.parquet`: velocities after impacts.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::JumpRow;

static COLUMNS: [Column<JumpRow>; 9] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("wall", "", "given or updated", Read::Text(|r| Some(r.wall.into()))),
    Column::input(
        "time_s",
        "s",
        "when the pattern was clear again",
        Read::Number(|r: &JumpRow| Some(r.jump.time_s)),
    )
    .distinct(),
    Column::input(
        "pattern_before",
        "",
        "measured pattern before",
        Read::Text(|r| Some(r.jump.contacts[0].name().into())),
    ),
    Column::input(
        "pattern_after",
        "",
        "measured pattern after",
        Read::Text(|r| Some(r.jump.contacts[1].name().into())),
    ),
    Column::result(
        "impacts",
        "",
        "impacts of the model on the way",
        Read::Count(|r| Some(r.jump.impacts.total())),
    ),
    Column::result(
        "coefficient",
        "",
        "1 to 8 where its only impact is that change of Table 2",
        Read::Count(|r| r.jump.coefficient().map(|l| l as u64 + 1)),
    ),
    Column::result(
        "ratio",
        "",
        "velocities measured after it over those of the model; null where the model is in another pattern",
        Read::Number(|r| r.jump.ratio),
    ),
    Column::result(
        "ratio_sd",
        "",
        "standard deviation of the ratio by noise",
        Read::Number(|r| r.jump.ratio_sd),
    ),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[JumpRow]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}

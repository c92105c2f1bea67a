//! `laws.parquet`: what the best hypotheses add to the force at the top.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::LawPoint;

static COLUMNS: [Column<LawPoint>; 4] = [
    Column::input("name", "", "hypothesis", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input(
        "against",
        "",
        "column of force.parquet that x is of",
        Read::Text(|r| Some(r.against.name().into())),
    ),
    Column::input(
        "x",
        "",
        "displacement, velocity or absolute acceleration of the top, SI",
        Read::Number(|r: &LawPoint| Some(r.x)),
    )
    .distinct(),
    Column::result(
        "force_n",
        "N",
        "force that the hypothesis adds at the top",
        Read::Number(|r| Some(r.force_n)),
    ),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[LawPoint]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}

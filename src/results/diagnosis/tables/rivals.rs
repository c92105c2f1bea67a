//! `rivals.parquet`: every hypothesis that was tried.

use std::path::Path;

use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::answer::rows::RivalRow;

static COLUMNS: [Column<RivalRow>; 11] = [
    Column::input("rank", "", "1: what least speaks against", Read::Count(|r| Some(r.rank))),
    Column::input("name", "", "what is added to the wall", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input("place", "", "where it acts", Read::Text(|r| Some(r.place.into()))),
    Column::input(
        "is_answer",
        "",
        "an effect, no number of the wall and no placebo",
        Read::Flag(|r| Some(r.is_answer)),
    ),
    Column::input("parameter", "", "its number", Read::Text(|r| Some(r.parameter.as_str().into()))),
    Column::input("unit", "", "unit of the value", Read::Text(|r| Some(r.unit.into()))),
    Column::result("value", "", "fitted value", Read::Number(|r| Some(r.value))),
    Column::result("sd", "", "standard deviation by the curvature of the fit", Read::Number(|r| r.sd)),
    Column::result(
        "error_fit",
        "",
        "windowed error over the noise, tests to fit",
        Read::Number(|r| r.error[0]),
    ),
    Column::result("error_held_out", "", "the same, tests held out", Read::Number(|r| r.error[1])),
    Column::result(
        "against",
        "",
        "what speaks against it, natural logarithms of likelihood",
        Read::Number(|r| Some(r.against)),
    ),
];

/// Writes the table.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub(super) fn write(path: &Path, rows: &[RivalRow]) -> Result<()> {
    write_table(path, &COLUMNS, &[], rows)
}

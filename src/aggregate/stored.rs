//! What is stored of one run.

use std::path::Path;

use polars::prelude::*;

use super::scan::scan;
use crate::error::{Error, Result};
use crate::store::run_files;

/// Numbers of the run at a position of the plan, by column; none for a run that is not stored, and for values that
/// do not exist.
///
/// # Errors
/// [`Error::Table`] for files that cannot be read.
pub fn stored_numbers<const N: usize>(
    folder: &Path,
    position: u64,
    columns: [&str; N],
) -> Result<Option<[Option<f64>; N]>> {
    let Ok(files) = run_files(folder) else { return Ok(None) };
    let read = || -> PolarsResult<Option<[Option<f64>; N]>> {
        let rows = scan(&files)?.filter(col("run").eq(lit(position))).select(columns.map(col)).collect()?;
        if rows.height() == 0 {
            return Ok(None);
        }
        let mut values = [None; N];
        for (value, name) in values.iter_mut().zip(columns) {
            *value = rows.column(name)?.f64()?.get(0);
        }
        Ok(Some(values))
    };
    read().map_err(|e| Error::table(folder, e))
}

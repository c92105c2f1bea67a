//! What is stored of single runs.

use std::collections::BTreeMap;
use std::path::Path;

use polars::prelude::*;

use super::answer::{Answer, Compared};
use super::scan::{count, scan};
use crate::error::{Error, Result};
use crate::study::runs::{listed_run_files, run_files};

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
    if listed_run_files(folder)?.is_empty() {
        return Ok(None);
    }
    let files = run_files(folder)?;
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

/// What came of the runs at some positions of the plan, of those that are stored.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn stored_answers(
    folder: &Path,
    positions: &[u64],
    compared: &Compared,
) -> Result<BTreeMap<u64, Answer>> {
    let files = run_files(folder)?;
    let read = || -> PolarsResult<BTreeMap<u64, Answer>> {
        let wanted = DataFrame::new_infer_height(vec![Column::new("run".into(), positions)])?.lazy();
        let mut columns = vec![col("run"), col(compared.outcome).cast(DataType::String).alias("ended")];
        columns.extend(compared.numbers.iter().map(|&name| col(name)));
        let runs = scan(&files)?.select(columns);
        let frame =
            wanted.join(runs, [col("run")], [col("run")], JoinArgs::new(JoinType::Inner)).collect()?;
        let answer = |i: usize| {
            let number = |&name: &&'static str| Ok(frame.column(name)?.f64()?.get(i));
            let outcome = frame.column("ended")?.str()?.get(i).unwrap_or_default().to_owned();
            let numbers = compared.numbers.iter().map(number).collect::<PolarsResult<_>>()?;
            Ok((count(&frame, "run", i)?, Answer { outcome, numbers }))
        };
        (0..frame.height()).map(answer).collect()
    };
    read().map_err(|e| Error::table(folder, e))
}

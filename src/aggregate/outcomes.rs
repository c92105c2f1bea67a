//! How the runs of a study ended, an unfinished one too.

use std::path::Path;

use polars::prelude::*;

use super::scan::{count, scan, text};
use crate::error::{Error, Result};
use crate::study::runs::run_files;

/// Runs that ended alike.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ending {
    /// `stood`, `collapsed` or `failed`.
    pub outcome: String,
    /// Why they failed; none where they did not.
    pub reason: Option<String>,
    /// How many.
    pub runs: u64,
    /// Position in the plan of the first of them.
    pub first_run: u64,
}

/// Every outcome and reason with its runs, by the first run of each in the plan.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn endings(folder: &Path) -> Result<Vec<Ending>> {
    let files = run_files(folder)?;
    let read = || -> PolarsResult<Vec<Ending>> {
        let keys = ["outcome", "reason"].map(|name| col(name).cast(DataType::String));
        let columns = [len().cast(DataType::UInt64).alias("runs"), col("run").min().alias("first_run")];
        let ends = scan(&files)?.group_by(keys).agg(columns);
        let frame = ends.sort(["first_run"], SortMultipleOptions::default()).collect()?;
        (0..frame.height())
            .map(|i| {
                Ok(Ending {
                    outcome: text(&frame, "outcome", i)?,
                    reason: frame.column("reason")?.str()?.get(i).map(str::to_owned),
                    runs: count(&frame, "runs", i)?,
                    first_run: count(&frame, "first_run", i)?,
                })
            })
            .collect()
    };
    read().map_err(|e| Error::table(folder, e))
}

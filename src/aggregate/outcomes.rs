//! How the runs of a study ended, an unfinished one too.

use std::path::Path;

use polars::prelude::PolarsResult;

use super::group::{Group, in_plan_order};
use crate::error::{Error, Result};
use crate::store::frame::read;
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
        let frame = read(&files, &["run", "outcome", "reason"])?;
        let ending = |group: &Group| {
            let first = group.first(&frame);
            Ok(Ending {
                outcome: first.text("outcome")?,
                reason: first.optional_text("reason")?,
                runs: group.len(),
                first_run: group.first_run,
            })
        };
        in_plan_order(&frame, &["outcome", "reason"])?.iter().map(ending).collect()
    };
    read().map_err(|e| Error::table(folder, e))
}

//! What is stored of single runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use polars::prelude::PolarsResult;

use super::answer::{Answer, Compared};
use super::row::Row;
use crate::error::{Error, Result};
use crate::store::frame::read;
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
        let frame = read(&files, &[&["run"], &columns[..]].concat())?;
        let runs = frame.counts("run")?;
        let Some(row) = (0..frame.height()).find(|&row| runs.get(row) == Some(position)) else {
            return Ok(None);
        };
        let mut values = [None; N];
        for (value, name) in values.iter_mut().zip(columns) {
            *value = Row { frame: &frame, row }.optional_number(name)?;
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
        let frame = read(&files, &[&["run", compared.outcome], compared.numbers].concat())?;
        let wanted: BTreeSet<u64> = positions.iter().copied().collect();
        let mut answers = BTreeMap::new();
        for (row, run) in frame.counts("run")?.iter().enumerate() {
            if let Some(run) = run.filter(|run| wanted.contains(run)) {
                answers.insert(run, answer(Row { frame: &frame, row }, compared)?);
            }
        }
        Ok(answers)
    };
    read().map_err(|e| Error::table(folder, e))
}

fn answer(run: Row<'_>, compared: &Compared) -> PolarsResult<Answer> {
    let numbers =
        compared.numbers.iter().map(|&name| run.optional_number(name)).collect::<PolarsResult<_>>()?;
    Ok(Answer { outcome: run.optional_text(compared.outcome)?.unwrap_or_default(), numbers })
}

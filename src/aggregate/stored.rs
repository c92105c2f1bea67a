//! Single runs as they are stored: their values, how they ended, and what is compared of them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use polars::prelude::{PolarsError, PolarsResult, polars_err};

use super::group::{Group, in_plan_order};
use crate::error::{Error, Result};
use crate::store::Read;
use crate::store::frame::{Frame, read};
use crate::study::batch::Finished;
use crate::study::pipeline::Kind;
use crate::study::runs::{COLUMNS, listed_run_files, run_files};

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

/// A run in a frame.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    /// The frame.
    pub frame: &'a Frame,
    /// Its row in it.
    pub row: usize,
}

impl Row<'_> {
    /// A text.
    ///
    /// # Errors
    /// An error for a null, and for a column that was not read.
    pub fn text(self, name: &str) -> PolarsResult<String> {
        self.optional_text(name)?.ok_or_else(|| absent(name))
    }

    /// A text that not every run has.
    ///
    /// # Errors
    /// An error for a column that was not read.
    pub fn optional_text(self, name: &str) -> PolarsResult<Option<String>> {
        Ok(self.frame.texts(name)?.get(self.row).map(str::to_owned))
    }

    /// What `find` knows by the text.
    ///
    /// # Errors
    /// As [`Row::text`], and for a text that is not known.
    pub fn named<T>(self, name: &str, find: impl Fn(&str) -> Option<T>) -> PolarsResult<T> {
        let value = self.text(name)?;
        find(&value).ok_or_else(
            || polars_err!(ComputeError: "column {name} holds {value:?}, which this version does not know"),
        )
    }

    /// A number.
    ///
    /// # Errors
    /// As [`Row::text`].
    pub fn number(self, name: &str) -> PolarsResult<f64> {
        self.optional_number(name)?.ok_or_else(|| absent(name))
    }

    /// A number that not every run has.
    ///
    /// # Errors
    /// As [`Row::optional_text`].
    pub fn optional_number(self, name: &str) -> PolarsResult<Option<f64>> {
        Ok(self.frame.numbers(name)?.get(self.row))
    }

    /// A count.
    ///
    /// # Errors
    /// As [`Row::text`].
    pub fn count(self, name: &str) -> PolarsResult<u64> {
        self.frame.counts(name)?.get(self.row).ok_or_else(|| absent(name))
    }
}

pub(super) fn absent(name: &str) -> PolarsError {
    polars_err!(ComputeError: "column {name} lacks a value that every run has")
}

/// What of a run is compared: numbers, and the column that says whether they exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// How the run ended.
    pub outcome: &'static str,
    /// Its value where the numbers exist.
    pub usable: &'static str,
    /// Its value where they lie above all numbers.
    pub beyond: &'static str,
    /// The numbers.
    pub numbers: &'static [&'static str],
}

impl Compared {
    /// What is compared in a study of this kind.
    pub fn of(kind: Kind) -> Self {
        match kind {
            Kind::Incremental => {
                Self { outcome: "limit_exceeded", usable: "true", beyond: "false", numbers: &["intensity"] }
            }
            _ => Self {
                outcome: "outcome",
                usable: "stood",
                beyond: "collapsed",
                numbers: &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
            },
        }
    }

    /// The same of a run that was done again.
    pub fn answer(&self, finished: &Finished) -> Answer {
        let column = |name: &str| COLUMNS.iter().find(|column| column.name == name);
        let number = |name: &&'static str| match column(name).map(|column| &column.read) {
            Some(Read::Number(read)) => read(finished),
            _ => None,
        };
        Answer {
            outcome: column(self.outcome).map(|column| column.text(finished)).unwrap_or_default(),
            numbers: self.numbers.iter().map(number).collect(),
        }
    }
}

/// What came of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// How it ended; empty where it has none.
    pub outcome: String,
    /// The numbers; none where they do not exist.
    pub numbers: Vec<Option<f64>>,
}

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

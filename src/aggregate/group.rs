//! Groups of runs, in the order of the plan, and what they are asked.

use polars::prelude::{Float64Chunked, PolarsResult};

use super::row::{Row, absent};
use crate::store::frame::{Frame, Texts};

/// Runs that are alike in some columns.
pub(super) struct Group {
    /// Position in the plan of the first of them.
    pub first_run: u64,
    /// Their rows in the frame, increasing.
    pub rows: Vec<usize>,
}

/// The groups of runs that are alike in all `keys`, nulls too, by the first run of each in the plan.
///
/// # Errors
/// What polars says of columns that were not read; an error for a run without a position.
pub(super) fn in_plan_order(frame: &Frame, keys: &[&str]) -> PolarsResult<Vec<Group>> {
    let runs = frame.counts("run")?;
    let group = |rows: Vec<usize>| {
        let first_run = rows.iter().filter_map(|&row| runs.get(row)).min().ok_or_else(|| absent("run"))?;
        Ok(Group { first_run, rows })
    };
    let groups: PolarsResult<Vec<Group>> = frame.groups(keys)?.iter().map(group).collect();
    let mut groups = groups?;
    groups.sort_unstable_by_key(|group| group.first_run);
    Ok(groups)
}

impl Group {
    /// How many runs.
    pub fn len(&self) -> u64 {
        self.rows.len() as u64
    }

    /// How many of them have this text.
    pub fn how_many(&self, texts: Texts<'_>, text: &str) -> u64 {
        self.rows.iter().filter(|&&row| texts.get(row) == Some(text)).count() as u64
    }

    /// What runs of a group share is read off the first of them in the files.
    pub fn first<'a>(&self, frame: &'a Frame) -> Row<'a> {
        Row { frame, row: self.rows.first().copied().unwrap_or_default() }
    }

    /// The numbers of the runs that have this text, increasing.
    pub fn sorted(&self, numbers: &Float64Chunked, texts: Texts<'_>, text: &str) -> Vec<f64> {
        let rows = self.rows.iter().filter(|&&row| texts.get(row) == Some(text));
        let mut values: Vec<f64> = rows.filter_map(|&row| numbers.get(row)).collect();
        values.sort_unstable_by(f64::total_cmp);
        values
    }
}

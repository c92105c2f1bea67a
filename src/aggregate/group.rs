//! Groups of runs, in the order of the plan, and what they are asked.

use polars::prelude::{Float64Chunked, PolarsResult};

use super::stored::{Row, absent};
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use arrow_array::types::Int32Type;
    use arrow_array::{ArrayRef, DictionaryArray, Float64Array, UInt64Array};

    use super::*;
    use crate::store::frame::read;
    use crate::store::frame::testing::write;

    fn labels(texts: [&str; 5]) -> ArrayRef {
        Arc::new(texts.into_iter().collect::<DictionaryArray<Int32Type>>())
    }

    #[test]
    fn analytic_groups_in_the_order_of_the_plan_with_their_sorted_numbers() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let theta = [Some(0.3), Some(0.1), Some(0.2), None, Some(9.0)];
        let columns: Vec<(&str, ArrayRef)> = vec![
            ("run", Arc::new(UInt64Array::from(vec![4, 3, 2, 1, 0]))),
            ("variant", labels(["b", "a", "b", "b", "a"])),
            ("outcome", labels(["stood", "stood", "stood", "stood", "collapsed"])),
            ("theta", Arc::new(Float64Array::from(theta.to_vec()))),
        ];
        let file = write(folder.path(), "runs.parquet", columns);
        let frame = read(&[file], &["run", "variant", "outcome", "theta"]).expect("readable");
        let groups = in_plan_order(&frame, &["variant"]).expect("groups");
        let [a, b] = &groups[..] else { panic!("{} groups", groups.len()) };
        assert_eq!((a.first_run, &a.rows[..]), (0, &[1, 4][..]));
        assert_eq!((b.first_run, &b.rows[..]), (1, &[0, 2, 3][..]));
        assert_eq!(b.first(&frame).text("variant").expect("a text"), "b");
        let outcomes = frame.texts("outcome").expect("texts");
        let theta = frame.numbers("theta").expect("numbers");
        assert_eq!(a.how_many(outcomes, "collapsed"), 1);
        assert_eq!(a.sorted(theta, outcomes, "stood"), [0.1], "that of a collapsed wall is its bound");
        assert_eq!((b.len(), b.sorted(theta, outcomes, "stood")), (3, vec![0.2, 0.3]));
        let refused = b.first(&frame).named("variant", |_| None::<()>).expect_err("not known").to_string();
        assert_eq!(refused, "column variant holds \"b\", which this version does not know");
    }
}

//! Run by run: how many runs of a variant come out differently from those of the first.
//!
//! Where two variants differ in the tolerance alone, these are the ill-conditioned runs: two impacts nearly coincide
//! in them, and a tiny change of step decides the later motion.

use std::collections::BTreeMap;
use std::path::PathBuf;

use polars::prelude::{Float64Chunked, PolarsResult, UInt64Chunked};

use super::medians::{Moved, VariantNote};
use crate::store::frame::{Frame, Texts, read};

/// A largest rotation has moved if it differs by more than this share: what an engineer would call another result.
pub const MOVED_SHARE: f64 = 0.01;

/// What tells the runs of a variant apart, and what of them is compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Comparison {
    /// Labels that tell runs apart beside configuration and record.
    pub labels: &'static [&'static str],
    /// Numbers that do.
    pub numbers: &'static [&'static str],
    /// The column that says how a run ended.
    pub outcome: &'static str,
    /// Its value where the numbers compared exist.
    pub usable: &'static str,
    /// Numbers that are compared.
    pub compared: &'static [&'static str],
}

/// Runs of each variant but the first, and those that moved: a number by more than [`MOVED_SHARE`], or the outcome; in
/// the order of the plan.
///
/// # Errors
/// Files that cannot be read.
pub(super) fn moved(
    files: &[PathBuf],
    variants: &[VariantNote],
    comparison: &Comparison,
) -> PolarsResult<Vec<Moved>> {
    let [base, _, ..] = variants else {
        return Ok(Vec::new());
    };
    let keys = comparison.keys();
    // A run that lacks what tells it apart is the same as no other.
    let frame = read(files, &comparison.columns())?.without_nulls(&keys)?;
    let runs = Runs::of(&frame, comparison)?;
    let mut tallies = Tallies::new();
    for same in frame.groups(&keys)?.iter() {
        let is_base = |&row: &usize| runs.variants.get(row) == Some(base.name.as_str());
        let (before, after): (Vec<usize>, Vec<usize>) = same.into_iter().partition(is_base);
        for (&after, &before) in
            after.iter().flat_map(|after| before.iter().map(move |before| (after, before)))
        {
            runs.tell(after, before, comparison.usable, &mut tallies);
        }
    }
    let mut moved: Vec<_> = tallies.into_values().collect();
    moved.sort_by_key(|&(first_run, _)| first_run);
    Ok(moved.into_iter().map(|(_, moved)| moved).collect())
}

/// By variant and configuration: the position in the plan of the first run compared, and how many moved.
type Tallies<'a> = BTreeMap<(&'a str, &'a str), (u64, Moved)>;

impl Comparison {
    /// Columns that tell the runs of a variant apart.
    fn keys(&self) -> Vec<&'static str> {
        ["configuration", "record"].iter().chain(self.labels).chain(self.numbers).copied().collect()
    }

    fn columns(&self) -> Vec<&'static str> {
        let mut columns = self.keys();
        columns.extend(["run", "variant", self.outcome]);
        columns.extend(self.compared);
        columns
    }
}

/// The columns that are compared.
struct Runs<'a> {
    runs: &'a UInt64Chunked,
    variants: Texts<'a>,
    configurations: Texts<'a>,
    outcomes: Texts<'a>,
    compared: Vec<&'a Float64Chunked>,
}

impl<'a> Runs<'a> {
    fn of(frame: &'a Frame, comparison: &Comparison) -> PolarsResult<Self> {
        Ok(Self {
            runs: frame.counts("run")?,
            variants: frame.texts("variant")?,
            configurations: frame.texts("configuration")?,
            outcomes: frame.texts(comparison.outcome)?,
            compared: comparison
                .compared
                .iter()
                .map(|name| frame.numbers(name))
                .collect::<PolarsResult<_>>()?,
        })
    }

    /// Counts a run in a row as compared with the same run in another row.
    fn tell(&self, after: usize, before: usize, usable: &str, tallies: &mut Tallies<'a>) {
        let key = (self.variants.get(after), self.configurations.get(after), self.runs.get(after));
        let (Some(variant), Some(configuration), Some(run)) = key else {
            return;
        };
        let none = || Moved {
            variant: variant.to_owned(),
            configuration: configuration.to_owned(),
            runs: 0,
            moved: 0,
        };
        let (first_run, moved) = tallies.entry((variant, configuration)).or_insert_with(|| (run, none()));
        *first_run = run.min(*first_run);
        moved.runs += 1;
        moved.moved += u64::from(self.differ(after, before, usable));
    }

    /// Another outcome, or two usable ones with another number; the rotation of a collapsed wall is its bound.
    fn differ(&self, after: usize, before: usize, usable: &str) -> bool {
        let [now, then] = [after, before].map(|row| self.outcomes.get(row));
        let further = |numbers: &&Float64Chunked| match (numbers.get(after), numbers.get(before)) {
            (Some(now), Some(then)) => (now - then).abs() > MOVED_SHARE * then,
            _ => false,
        };
        now != then || (now == Some(usable) && self.compared.iter().any(further))
    }
}

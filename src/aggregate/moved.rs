//! Run by run: how many runs of a variant come out differently from those of the first.
//!
//! Where two variants differ in the tolerance alone, these are the ill-conditioned runs: two impacts nearly coincide
//! in them, and a tiny change of step decides the later motion.

use std::collections::BTreeMap;
use std::path::PathBuf;

use polars::prelude::{Float64Chunked, PolarsResult, UInt64Chunked};

use super::medians::{Moved, VariantNote};
use super::variants::MEMBER_OF;
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
    let frame = read(files, &comparison.columns())?.with_null(MEMBER_OF)?.without_nulls(&keys)?;
    let runs = Runs::of(&frame, comparison)?;
    let mut tallies = Tallies::new();
    for same in frame.groups(&keys)?.iter() {
        let is_base = |&row: &usize| runs.variants.get(row) == Some(base.name.as_str());
        let (before, after): (Vec<usize>, Vec<usize>) = same.into_iter().partition(is_base);
        for &after in &after {
            before.iter().for_each(|&before| runs.tell(after, before, comparison.usable, &mut tallies));
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
        columns.extend(["run", "variant", MEMBER_OF, self.outcome]);
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use arrow_array::types::Int32Type;
    use arrow_array::{ArrayRef, BooleanArray, DictionaryArray, Float64Array, UInt64Array};

    use super::*;
    use crate::store::frame::testing::write;

    const COMPARISON: Comparison =
        Comparison { labels: &[], numbers: &["draw"], outcome: "exceeded", usable: "true", compared: &["x"] };

    /// Runs of `a`, then the same of `b`: no draw, alike, a little more, much more, another end, no answer twice.
    fn file(folder: &std::path::Path) -> PathBuf {
        let text = |text: &str| -> ArrayRef {
            Arc::new([text; 12].into_iter().collect::<DictionaryArray<Int32Type>>())
        };
        let variants: DictionaryArray<Int32Type> =
            (0..12).map(|run| if run < 6 { "a" } else { "b" }).collect();
        let draws = [None, Some(0), Some(1), Some(2), Some(3), Some(4)];
        let yes = Some(true);
        let ends = [yes, yes, yes, yes, yes, None, yes, yes, yes, yes, Some(false), None];
        let x = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 9.0, 1.0, 1.009, 1.011, 1.0, 9.0];
        let columns: Vec<(&str, ArrayRef)> = vec![
            ("run", Arc::new(UInt64Array::from_iter_values(0..12))),
            ("variant", Arc::new(variants)),
            (MEMBER_OF, Arc::new([None::<&str>; 12].into_iter().collect::<DictionaryArray<Int32Type>>())),
            ("configuration", text("parallel")),
            ("record", text("r")),
            ("draw", Arc::new(draws.iter().chain(&draws).copied().collect::<UInt64Array>())),
            ("exceeded", Arc::new(BooleanArray::from(ends.to_vec()))),
            ("x", Arc::new(Float64Array::from(x.to_vec()))),
        ];
        write(folder, "runs.parquet", columns)
    }

    fn note(name: &str) -> VariantNote {
        VariantNote {
            name: name.to_owned(),
            length_m: 1.0,
            density_kg_m3: 1800.0,
            law: String::new(),
            capture_velocity_rad_s: 0.0,
            tolerance: 1e-6,
            suite: String::new(),
            suite_generated: false,
            runs: 6,
            collapsed: 0,
            failed: 1,
            tail_s: 5.0,
            collapse_rotation_ratio: 2.0,
            vertical: false,
            further: String::new(),
            energy_residual: None,
        }
    }

    #[test]
    fn analytic_runs_move_by_another_end_or_by_more_than_the_share() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = [file(folder.path())];
        let told = moved(&files, &[note("a"), note("b")], &COMPARISON).expect("readable");
        let expected =
            Moved { variant: "b".to_owned(), configuration: "parallel".to_owned(), runs: 5, moved: 2 };
        assert_eq!(told, [expected]);
        assert_eq!(moved(&files, &[note("a")], &COMPARISON).expect("nothing to read"), []);
    }
}

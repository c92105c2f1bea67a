//! Run by run: how many runs of a variant come out differently from those of the first.
//!
//! Where two variants differ in the tolerance alone, these are the ill-conditioned runs: two impacts nearly coincide
//! in them, and a tiny change of step decides the later motion.

use std::path::PathBuf;

use polars::prelude::*;

use super::medians::Moved;
use super::scan::{count, scan, text};

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

/// Runs of each variant but `base`, and those that moved: a number by more than [`MOVED_SHARE`], or the outcome.
pub(super) fn moved(files: &[PathBuf], base: &str, comparison: &Comparison) -> PolarsResult<Vec<Moved>> {
    let is_base = || col("variant").eq(lit(base.to_owned()));
    let before = runs(files, comparison)?.filter(is_base());
    let after = runs(files, comparison)?.filter(is_base().not());
    let keys = ["configuration", "record"].iter().chain(comparison.labels).chain(comparison.numbers);
    let keys: Vec<Expr> = keys.map(|&name| col(name)).collect();
    let frame = after
        .join(before, keys.clone(), keys, JoinArgs::new(JoinType::Inner))
        .group_by(["variant", "configuration"].map(col))
        .agg([
            len().cast(DataType::UInt64).alias("runs"),
            differs(comparison).sum().cast(DataType::UInt64).alias("moved"),
            col("run").min(),
        ])
        .sort(["run"], SortMultipleOptions::default())
        .collect()?;
    (0..frame.height())
        .map(|i| {
            Ok(Moved {
                variant: text(&frame, "variant", i)?,
                configuration: text(&frame, "configuration", i)?,
                runs: count(&frame, "runs", i)?,
                moved: count(&frame, "moved", i)?,
            })
        })
        .collect()
}

fn runs(files: &[PathBuf], comparison: &Comparison) -> PolarsResult<LazyFrame> {
    let mut columns = vec![col("run")];
    let labels = ["variant", "configuration", "record", comparison.outcome];
    let labels = labels.iter().chain(comparison.labels);
    columns.extend(labels.map(|&label| col(label).cast(DataType::String)));
    columns.extend(comparison.numbers.iter().chain(comparison.compared).map(|&name| col(name)));
    Ok(scan(files)?.select(columns))
}

/// Another outcome, or two usable ones with another number; the rotation of a collapsed wall is its bound.
fn differs(comparison: &Comparison) -> Expr {
    let there = |name: &str| col(format!("{name}_right"));
    let Comparison { outcome, usable, compared, .. } = *comparison;
    let other_outcome = col(outcome).neq_missing(there(outcome));
    let both = col(outcome).eq(lit(usable)).and(there(outcome).eq(lit(usable)));
    let further = compared.iter().map(|&name| {
        let distance = col(name) - there(name);
        let allowed = lit(MOVED_SHARE) * there(name);
        distance.clone().gt(allowed.clone()).or((lit(0.0) - distance).gt(allowed))
    });
    let any = further.reduce(Expr::or).unwrap_or(lit(false));
    other_outcome.or(both.and(any))
}

//! Run by run: how many runs of a variant come out differently from those of the first.
//!
//! Where two variants differ in the tolerance alone, these are the ill-conditioned runs: two impacts nearly coincide
//! in them, and a tiny change of step decides the later motion.

use std::path::PathBuf;

use polars::prelude::*;

use super::medians::{Measure, Moved};
use super::scan::{count, scan, text};

/// A largest rotation has moved if it differs by more than this share: what an engineer would call another result.
pub const MOVED_SHARE: f64 = 0.01;

/// Columns that tell the runs of a variant apart.
const RUN: [&str; 5] = ["configuration", "parameter", "level", "slenderness", "record"];

/// Runs of each variant but `base`, and those that moved: a rotation by more than [`MOVED_SHARE`], or the outcome.
pub(super) fn moved(files: &[PathBuf], base: &str) -> PolarsResult<Vec<Moved>> {
    let is_base = || col("variant").eq(lit(base.to_owned()));
    let before = runs(files)?.filter(is_base());
    let after = runs(files)?.filter(is_base().not());
    let keys = RUN.map(col);
    let frame = after
        .join(before, keys.clone(), keys, JoinArgs::new(JoinType::Inner))
        .group_by(["variant", "configuration"].map(col))
        .agg([
            len().cast(DataType::UInt64).alias("runs"),
            differs().sum().cast(DataType::UInt64).alias("moved"),
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

fn runs(files: &[PathBuf]) -> PolarsResult<LazyFrame> {
    let mut columns = vec![col("run"), col("slenderness")];
    let labels = ["variant", "configuration", "parameter", "level", "record", "outcome"];
    columns.extend(labels.map(|label| col(label).cast(DataType::String)));
    columns.extend(Measure::BODIES.map(|body| col(body.column())));
    Ok(scan(files)?.select(columns))
}

/// Another outcome, or two that stood with another rotation; the rotation of a collapsed wall is its bound.
fn differs() -> Expr {
    let there = |name: &str| col(format!("{name}_right"));
    let other_outcome = col("outcome").neq(there("outcome"));
    let stood = col("outcome").eq(lit("stood")).and(there("outcome").eq(lit("stood")));
    let rotations = Measure::BODIES.map(|body| {
        let name = body.column();
        let distance = col(name) - there(name);
        let allowed = lit(MOVED_SHARE) * there(name);
        distance.clone().gt(allowed.clone()).or((lit(0.0) - distance).gt(allowed))
    });
    let [lower, upper] = rotations;
    other_outcome.or(stood.and(lower.or(upper)))
}

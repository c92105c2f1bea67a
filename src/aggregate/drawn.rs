//! Quantiles over drawn façades and over records.

use std::path::{Path, PathBuf};

use polars::prelude::*;

use super::distributions::{Distribution, Distributions};
use super::moved::{Comparison, moved};
use super::quantile::quantiles;
use super::scan::{count, list, outcome_is, scan, text, variant_notes};
use crate::error::{Error, Result};
use crate::study::pipeline::Kind;
use crate::study::runs::run_files;

/// What is told of runs at given intensities.
const ROTATIONS: &[&str] = &[
    "theta1_max_over_alpha1",
    "theta2_max_over_alpha2",
    "theta_max_over_own_alpha",
    "theta1_max_over_alpha",
    "theta2_max_over_alpha",
];

/// What is told of incremental analyses.
const CAPACITIES: &[&str] = &["intensity"];

/// How runs at given intensities are compared between variants. Intensities are those asked for, to the bit.
const BY_ROTATION: Comparison = Comparison {
    labels: &[],
    numbers: &["draw", "factor"],
    outcome: "outcome",
    usable: "stood",
    compared: &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
};

/// The same of incremental analyses.
const BY_CAPACITY: Comparison = Comparison {
    labels: &["limit"],
    numbers: &["draw"],
    outcome: "limit_exceeded",
    usable: "true",
    compared: &["intensity"],
};

/// Quantiles of the study of drawn façades in `folder`: over all records, and by record.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn distributions(folder: &Path, kind: Kind) -> Result<Distributions> {
    let files = run_files(folder)?;
    read(&files, kind).map_err(|e| Error::table(folder, e))
}

fn read(files: &[PathBuf], kind: Kind) -> PolarsResult<Distributions> {
    let variants = variant_notes(files)?;
    let comparison = if kind == Kind::Incremental { &BY_CAPACITY } else { &BY_ROTATION };
    let moved = match &variants[..] {
        [base, _, ..] => moved(files, &base.name, comparison)?,
        _ => Vec::new(),
    };
    let mut rows = Vec::new();
    for record in [false, true] {
        let frame = grouped(scan(files)?, kind, record)?;
        for i in 0..frame.height() {
            rows.extend(distributions_of(&frame, i, kind)?);
        }
    }
    Ok(Distributions { kind, variants, moved, measure: measure(files)?, rows })
}

fn quantities(kind: Kind) -> &'static [&'static str] {
    if kind == Kind::Incremental { CAPACITIES } else { ROTATIONS }
}

/// One row a group: counts, and the sorted numbers of the runs that have them as lists.
fn grouped(runs: LazyFrame, kind: Kind, by_record: bool) -> PolarsResult<DataFrame> {
    let label = |name: &str| col(name).cast(DataType::String).alias(name);
    let mut keys = vec![label("variant"), label("configuration")];
    keys.extend(by_record.then(|| label("record")));
    match kind {
        Kind::Stripes => keys.push(col("intensity").alias("stripe")),
        Kind::Incremental => keys.push(label("limit")),
        _ => {}
    }
    let exceeded = || col("limit_exceeded").fill_null(lit(false));
    let (numbered, beyond) = match kind {
        // A failed run has no answer.
        Kind::Incremental => (exceeded(), col("limit_exceeded").eq(lit(false)).fill_null(lit(false))),
        _ => (outcome_is("stood"), outcome_is("collapsed")),
    };
    let mut columns = vec![
        col("run").min().alias("first_run"),
        len().cast(DataType::UInt64).alias("runs"),
        outcome_is("failed").sum().cast(DataType::UInt64).alias("failed"),
        beyond.sum().cast(DataType::UInt64).alias("beyond"),
    ];
    let sorted =
        |&name: &&'static str| col(name).filter(numbered.clone()).sort(SortOptions::default()).alias(name);
    columns.extend(quantities(kind).iter().map(sorted));
    runs.group_by(keys).agg(columns).sort(["first_run"], SortMultipleOptions::default()).collect()
}

fn distributions_of(frame: &DataFrame, i: usize, kind: Kind) -> PolarsResult<Vec<Distribution>> {
    let optional = |name: &str| match frame.get_column_index(name) {
        Some(_) => text(frame, name, i).map(Some),
        None => Ok(None),
    };
    let intensity = match frame.column("stripe") {
        Ok(stripe) => stripe.f64()?.get(i),
        Err(_) => None,
    };
    let beyond = count(frame, "beyond", i)?;
    let one = |&quantity: &&'static str| {
        Ok(Distribution {
            variant: text(frame, "variant", i)?,
            configuration: text(frame, "configuration", i)?,
            record: optional("record")?,
            intensity,
            limit: optional("limit")?,
            quantity,
            runs: count(frame, "runs", i)?,
            failed: count(frame, "failed", i)?,
            beyond,
            quantiles: quantiles(&list(frame, quantity, i)?, beyond as usize),
        })
    };
    quantities(kind).iter().map(one).collect()
}

/// The measure that records are scaled by, the same in all runs.
fn measure(files: &[PathBuf]) -> PolarsResult<Option<String>> {
    let first = scan(files)?.select([col("intensity_measure").cast(DataType::String)]).first().collect()?;
    Ok(first.column("intensity_measure")?.str()?.get(0).map(str::to_owned))
}

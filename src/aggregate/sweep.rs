//! Reading the runs of a study, lazily and only the columns that are needed.

use std::path::{Path, PathBuf};

use polars::prelude::*;

use super::medians::{Case, Measure, Median, Medians, VariantNote};
use super::moved::{Comparison, moved};
use super::quantile::quantiles;
use crate::error::{Error, Result};
use crate::input::pipeline::Parameter;
use crate::input::survey::Configuration;
use crate::plan::Level;
use crate::store::run_files;

/// Columns that tell the cases apart; records are what the quantiles run over.
const CASE: [&str; 5] = ["variant", "configuration", "parameter", "level", "slenderness"];

/// How the runs of a sweep are compared between variants.
const COMPARISON: Comparison = Comparison {
    labels: &["parameter", "level"],
    numbers: &["slenderness"],
    outcome: "outcome",
    usable: "stood",
    compared: &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
};

/// Medians and quantiles over the records of every case of the study in `folder`.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn aggregate(folder: &Path) -> Result<Medians> {
    let files = run_files(folder)?;
    let read = || -> PolarsResult<Medians> {
        let variants = variant_notes(&files)?;
        let moved = match variants.first() {
            Some(base) => moved(&files, &base.name, &COMPARISON)?,
            None => Vec::new(),
        };
        Ok(Medians::new(variants, medians(&by_case(scan(&files)?)?)?).with_moved(moved))
    };
    read().map_err(|e| Error::table(folder, e))
}

pub(super) fn scan(files: &[PathBuf]) -> PolarsResult<LazyFrame> {
    let paths: PolarsResult<Vec<_>> = files.iter().map(|path| PlRefPath::try_from_path(path)).collect();
    let hive_options = HiveOptions { enabled: Some(false), ..Default::default() };
    // The record stands in the files too, and their names may hold what a pattern would read as a wildcard.
    let arguments = ScanArgsParquet { hive_options, glob: false, ..Default::default() };
    LazyFrame::scan_parquet_files(paths?.into(), arguments)
}

pub(super) fn outcome_is(name: &'static str) -> Expr {
    col("outcome").cast(DataType::String).eq(lit(name))
}

pub(super) fn counts() -> [Expr; 4] {
    [
        col("run").min().alias("first_run"),
        len().cast(DataType::UInt64).alias("runs"),
        outcome_is("collapsed").sum().cast(DataType::UInt64).alias("collapsed"),
        outcome_is("failed").sum().cast(DataType::UInt64).alias("failed"),
    ]
}

/// One row a case: counts, and the sorted rotations of the runs that stood as lists.
fn by_case(runs: LazyFrame) -> PolarsResult<DataFrame> {
    let keys = CASE.map(|name| match name {
        "slenderness" => col(name),
        label => col(label).cast(DataType::String),
    });
    let standing = |measure: Measure| {
        let name = measure.column();
        col(name).filter(outcome_is("stood")).sort(SortOptions::default()).alias(name)
    };
    let mut columns = counts().to_vec();
    columns.push(col("parameter_value").first());
    columns.extend(Measure::ALL.map(standing));
    // The order of the plan: the first record's runs come first in it.
    runs.group_by(keys).agg(columns).sort(["first_run"], SortMultipleOptions::default()).collect()
}

fn by_variant(runs: LazyFrame) -> PolarsResult<DataFrame> {
    let mut columns = counts().to_vec();
    let numbers = ["length_m", "density_kg_m3", "capture_velocity_rad_s", "tolerance"];
    columns.extend(numbers.map(|name| col(name).first()));
    columns.extend(["law", "suite"].map(|name| col(name).first().cast(DataType::String)));
    columns.push(col("suite_generated").first());
    columns.push(col("energy_residual").max());
    runs.group_by([col("variant").cast(DataType::String)])
        .agg(columns)
        .sort(["first_run"], SortMultipleOptions::default())
        .collect()
}

/// The variants in the order of the plan, as their runs tell them.
pub(super) fn variant_notes(files: &[PathBuf]) -> PolarsResult<Vec<VariantNote>> {
    let frame = &by_variant(scan(files)?)?;
    (0..frame.height())
        .map(|i| {
            Ok(VariantNote {
                name: text(frame, "variant", i)?,
                length_m: number(frame, "length_m", i)?,
                density_kg_m3: number(frame, "density_kg_m3", i)?,
                law: text(frame, "law", i)?,
                capture_velocity_rad_s: number(frame, "capture_velocity_rad_s", i)?,
                tolerance: number(frame, "tolerance", i)?,
                suite: text(frame, "suite", i)?,
                suite_generated: frame.column("suite_generated")?.bool()?.get(i).unwrap_or(false),
                runs: count(frame, "runs", i)?,
                collapsed: count(frame, "collapsed", i)?,
                failed: count(frame, "failed", i)?,
                energy_residual: frame.column("energy_residual")?.f64()?.get(i),
            })
        })
        .collect()
}

fn medians(frame: &DataFrame) -> PolarsResult<Vec<Median>> {
    let mut rows = Vec::with_capacity(frame.height() * Measure::ALL.len());
    for i in 0..frame.height() {
        let case = case(frame, i)?;
        let [runs, collapsed, failed] = ["runs", "collapsed", "failed"].map(|name| count(frame, name, i));
        let (runs, collapsed, failed) = (runs?, collapsed?, failed?);
        for measure in Measure::ALL {
            let standing = list(frame, measure.column(), i)?;
            rows.push(Median {
                case: case.clone(),
                parameter_value: frame.column("parameter_value")?.f64()?.get(i),
                measure,
                runs,
                collapsed,
                failed,
                quantiles: quantiles(&standing, collapsed as usize),
            });
        }
    }
    Ok(rows)
}

fn case(frame: &DataFrame, i: usize) -> PolarsResult<Case> {
    Ok(Case {
        variant: text(frame, "variant", i)?,
        configuration: named(frame, "configuration", i, |name| {
            Configuration::ALL.into_iter().find(|configuration| configuration.name() == name)
        })?,
        parameter: named(frame, "parameter", i, Parameter::named)?,
        level: named(frame, "level", i, Level::named)?,
        slenderness: number(frame, "slenderness", i)?,
    })
}

pub(super) fn named<T>(
    frame: &DataFrame,
    name: &str,
    i: usize,
    find: impl Fn(&str) -> Option<T>,
) -> PolarsResult<T> {
    let value = text(frame, name, i)?;
    find(&value).ok_or_else(
        || polars_err!(ComputeError: "column {name} holds {value:?}, which this version does not know"),
    )
}

fn absent(name: &str) -> PolarsError {
    polars_err!(ComputeError: "column {name} lacks a value that every run has")
}

pub(super) fn text(frame: &DataFrame, name: &str, i: usize) -> PolarsResult<String> {
    frame.column(name)?.str()?.get(i).map(str::to_owned).ok_or_else(|| absent(name))
}

pub(super) fn number(frame: &DataFrame, name: &str, i: usize) -> PolarsResult<f64> {
    frame.column(name)?.f64()?.get(i).ok_or_else(|| absent(name))
}

pub(super) fn count(frame: &DataFrame, name: &str, i: usize) -> PolarsResult<u64> {
    frame.column(name)?.u64()?.get(i).ok_or_else(|| absent(name))
}

pub(super) fn list(frame: &DataFrame, name: &str, i: usize) -> PolarsResult<Vec<f64>> {
    let values = frame.column(name)?.list()?.get_as_series(i).ok_or_else(|| absent(name))?;
    Ok(values.f64()?.iter().flatten().collect())
}

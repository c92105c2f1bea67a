//! Runs of the reference façades, record by record.

use std::path::Path;

use polars::prelude::*;

use super::medians::{Measure, Middle};
use super::scan::{count, named, number, scan, text};
use crate::error::{Error, Result};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::study::runs::run_files;
use crate::survey::Configuration;

/// A run of a façade whose parameters are all at their means.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceRun {
    /// Name of the record.
    pub record: String,
    /// Its number in the suite.
    pub record_id: u64,
    /// Its earthquake.
    pub event: String,
    /// How the floor runs.
    pub configuration: Configuration,
    /// h_tot / b.
    pub slenderness: f64,
    /// Largest θ_1/α_1 and θ_2/α_2, or collapse; none of a failed run.
    pub rotation: [Option<Middle>; 2],
}

/// The runs of the reference façades of one variant, by record and slenderness.
///
/// Every parameter's curve holds the reference façade at its middle level; `among` says whose to take for each floor.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn reference_runs(
    folder: &Path,
    variant: &str,
    among: &[(Configuration, Parameter)],
) -> Result<Vec<ReferenceRun>> {
    let files = run_files(folder)?;
    let read = || -> PolarsResult<Vec<ReferenceRun>> {
        let mut runs = Vec::new();
        for &(configuration, parameter) in among {
            let frame = select(scan(&files)?, variant, configuration, parameter)?;
            for i in 0..frame.height() {
                runs.push(run(&frame, configuration, i)?);
            }
        }
        Ok(runs)
    };
    read().map_err(|e| Error::table(folder, e))
}

fn select(
    runs: LazyFrame,
    variant: &str,
    configuration: Configuration,
    parameter: Parameter,
) -> PolarsResult<DataFrame> {
    let is = |name: &str, value: &str| col(name).cast(DataType::String).eq(lit(value));
    let label = |name: &str| col(name).cast(DataType::String);
    runs.filter(
        is("variant", variant)
            .and(is("configuration", configuration.name()))
            .and(is("parameter", parameter.name()))
            .and(is("level", Level::Mean.name(parameter))),
    )
    .select([
        col("record_id"),
        col("slenderness"),
        label("record"),
        label("record_event"),
        label("outcome"),
        col(Measure::LowerOwn.column()),
        col(Measure::UpperOwn.column()),
    ])
    .sort(["record_id", "slenderness"], SortMultipleOptions::default())
    .collect()
}

fn run(frame: &DataFrame, configuration: Configuration, i: usize) -> PolarsResult<ReferenceRun> {
    let outcome = named(frame, "outcome", i, |name| match name {
        "stood" => Some(Some(false)),
        "collapsed" => Some(Some(true)),
        "failed" => Some(None),
        _ => None,
    })?;
    let rotation = |measure: Measure| -> PolarsResult<Option<Middle>> {
        match outcome {
            None => Ok(None),
            Some(true) => Ok(Some(Middle::Collapsed)),
            Some(false) => Ok(Some(Middle::Rotation(number(frame, measure.column(), i)?))),
        }
    };
    Ok(ReferenceRun {
        record: text(frame, "record", i)?,
        record_id: count(frame, "record_id", i)?,
        event: text(frame, "record_event", i)?,
        configuration,
        slenderness: number(frame, "slenderness", i)?,
        rotation: [rotation(Measure::LowerOwn)?, rotation(Measure::UpperOwn)?],
    })
}

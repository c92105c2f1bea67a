//! Runs of the reference façades, record by record.

use std::path::Path;

use polars::prelude::PolarsResult;

use super::medians::{Measure, Middle};
use super::stored::Row;
use crate::error::{Error, Result};
use crate::store::frame::read;
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::study::runs::run_files;
use crate::survey::Configuration;

const COLUMNS: [&str; 11] = [
    "variant",
    "configuration",
    "parameter",
    "level",
    "record",
    "record_id",
    "record_event",
    "slenderness",
    "outcome",
    "theta1_max_over_alpha1",
    "theta2_max_over_alpha2",
];

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
        let frame = read(&files, &COLUMNS)?;
        let mut runs = Vec::new();
        for &(configuration, parameter) in among {
            let wanted = [
                ("variant", variant),
                ("configuration", configuration.name()),
                ("parameter", parameter.name()),
                ("level", Level::Mean.name(parameter)),
            ];
            let frame = &frame.with_texts(&wanted)?.sorted_by(&["record_id", "slenderness"])?;
            for row in 0..frame.height() {
                runs.push(reference_run(Row { frame, row }, configuration)?);
            }
        }
        Ok(runs)
    };
    read().map_err(|e| Error::table(folder, e))
}

fn reference_run(run: Row<'_>, configuration: Configuration) -> PolarsResult<ReferenceRun> {
    let outcome = run.named("outcome", |name| match name {
        "stood" => Some(Some(false)),
        "collapsed" => Some(Some(true)),
        "failed" => Some(None),
        _ => None,
    })?;
    let rotation = |measure: Measure| -> PolarsResult<Option<Middle>> {
        match outcome {
            None => Ok(None),
            Some(true) => Ok(Some(Middle::Collapsed)),
            Some(false) => Ok(Some(Middle::Rotation(run.number(measure.column())?))),
        }
    };
    Ok(ReferenceRun {
        record: run.text("record")?,
        record_id: run.count("record_id")?,
        event: run.text("record_event")?,
        configuration,
        slenderness: run.number("slenderness")?,
        rotation: [rotation(Measure::LowerOwn)?, rotation(Measure::UpperOwn)?],
    })
}

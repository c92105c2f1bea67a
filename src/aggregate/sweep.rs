//! Medians of the cases of a sweep: only the columns that are needed are read.

use std::path::{Path, PathBuf};

use polars::prelude::PolarsResult;

use super::draws::draws;
use super::group::{Group, in_plan_order};
use super::medians::{Case, Measure, Median, Medians};
use super::moved::{Comparison, moved};
use super::quantile::quantiles;
use super::stored::Row;
use super::variants::{MEMBER_OF, variant_notes, with_further};
use crate::error::{Error, Result};
use crate::store::frame::{Frame, read};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::study::runs::{Completeness, run_files};
use crate::survey::Configuration;

/// Columns that tell the cases apart; records are what the quantiles run over.
pub(super) const CASE: [&str; 5] = ["variant", "configuration", "parameter", "level", "slenderness"];

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
    let completeness = Completeness::of_files(folder, &files)?;
    let notes = variant_notes(&files).map_err(|e| Error::table(folder, e))?;
    let variants = with_further(notes, folder)?;
    let read = || -> PolarsResult<Medians> {
        let moved = moved(&files, &variants, &COMPARISON)?;
        let draws = draws(&files, &variants)?;
        let medians = Medians::new(variants, medians(&files)?).with_moved(moved);
        Ok(medians.with_draws(draws).of_study(completeness))
    };
    read().map_err(|e| Error::table(folder, e))
}

fn medians(files: &[PathBuf]) -> PolarsResult<Vec<Median>> {
    let mut columns = vec!["run", "outcome", "parameter_value", MEMBER_OF];
    columns.extend(CASE);
    columns.extend(Measure::ALL.map(Measure::column));
    let frame = read(files, &columns)?.with_null(MEMBER_OF)?;
    let mut rows = Vec::new();
    for group in in_plan_order(&frame, &CASE)? {
        rows.extend(medians_of(&frame, &group)?);
    }
    Ok(rows)
}

/// One row a measure.
fn medians_of(frame: &Frame, group: &Group) -> PolarsResult<Vec<Median>> {
    let first = group.first(frame);
    let outcomes = frame.texts("outcome")?;
    let (case, parameter_value) = (case(first)?, first.optional_number("parameter_value")?);
    let [collapsed, failed] = ["collapsed", "failed"].map(|outcome| group.how_many(outcomes, outcome));
    let median = |measure: Measure| {
        let standing = group.sorted(frame.numbers(measure.column())?, outcomes, "stood");
        Ok(Median {
            case: case.clone(),
            parameter_value,
            measure,
            runs: group.len(),
            collapsed,
            failed,
            quantiles: quantiles(&standing, collapsed as usize),
            interval: None,
        })
    };
    Measure::ALL.into_iter().map(median).collect()
}

pub(super) fn case(run: Row<'_>) -> PolarsResult<Case> {
    Ok(Case {
        variant: run.text("variant")?,
        configuration: run.named("configuration", |name| {
            Configuration::ALL.into_iter().find(|configuration| configuration.name() == name)
        })?,
        parameter: run.named("parameter", Parameter::named)?,
        level: run.named("level", Level::named)?,
        slenderness: run.number("slenderness")?,
    })
}

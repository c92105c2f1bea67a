//! The variants of a study, as their runs tell them.

use std::path::PathBuf;

use polars::prelude::PolarsResult;

use super::group::{Group, in_plan_order};
use super::medians::VariantNote;
use crate::store::frame::{Frame, read};

const COLUMNS: [&str; 15] = [
    "run",
    MEMBER_OF,
    "variant",
    "outcome",
    "length_m",
    "density_kg_m3",
    "law",
    "capture_velocity_rad_s",
    "tolerance",
    "suite",
    "suite_generated",
    "energy_residual",
    "tail_s",
    "collapse_rotation_ratio",
    "vertical",
];

/// The column that is null for runs as they are planned, and names the variant of whose ensemble others are members.
pub(super) const MEMBER_OF: &str = "member_of";

/// The variants in the order of the plan.
///
/// # Errors
/// Files that cannot be read, and runs without a value that every run has.
pub(super) fn variant_notes(files: &[PathBuf]) -> PolarsResult<Vec<VariantNote>> {
    let frame = read(files, &COLUMNS)?.with_null(MEMBER_OF)?;
    in_plan_order(&frame, &["variant"])?.iter().map(|group| note(&frame, group)).collect()
}

fn note(frame: &Frame, group: &Group) -> PolarsResult<VariantNote> {
    let first = group.first(frame);
    let outcomes = frame.texts("outcome")?;
    let residuals = frame.numbers("energy_residual")?;
    Ok(VariantNote {
        name: first.text("variant")?,
        length_m: first.number("length_m")?,
        density_kg_m3: first.number("density_kg_m3")?,
        law: first.text("law")?,
        capture_velocity_rad_s: first.number("capture_velocity_rad_s")?,
        tolerance: first.number("tolerance")?,
        suite: first.text("suite")?,
        suite_generated: frame.flags("suite_generated")?.get(first.row).unwrap_or(false),
        runs: group.len(),
        collapsed: group.how_many(outcomes, "collapsed"),
        failed: group.how_many(outcomes, "failed"),
        energy_residual: group.rows.iter().filter_map(|&row| residuals.get(row)).reduce(f64::max),
        tail_s: first.number("tail_s")?,
        collapse_rotation_ratio: first.number("collapse_rotation_ratio")?,
        vertical: frame.flags("vertical")?.get(first.row).unwrap_or(false),
    })
}

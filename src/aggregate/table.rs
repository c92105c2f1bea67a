//! The medians as a Parquet file and as CSV: one row a case and measure.

use std::borrow::Cow;
use std::io::Write;
use std::ops::Deref;
use std::path::Path;

use super::medians::{Median, Medians};
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use crate::study::runs::Completeness;

/// A row that tells how much of its plan its study has run: tables are read apart from their study.
pub(super) struct OfStudy<R> {
    row: R,
    pub study: Option<Completeness>,
}

impl<R: Clone> OfStudy<R> {
    pub fn rows(rows: &[R], study: Option<Completeness>) -> Vec<Self> {
        rows.iter().map(|row| Self { row: row.clone(), study }).collect()
    }
}

impl<R> Deref for OfStudy<R> {
    type Target = R;

    fn deref(&self) -> &R {
        &self.row
    }
}

macro_rules! text {
    (|$m:ident| $value:expr) => {
        Read::Text(|$m| Some(Cow::Borrowed($value)))
    };
}

/// Every column of the table of medians, in order.
#[rustfmt::skip] // One column a line, so that the table reads as a table.
const COLUMNS: &[Column<OfStudy<Median>>] = &[
    Column::input("variant", "", "set of assumptions", text!(|m| &m.case.variant)),
    Column::input("configuration", "", "how the floor runs", text!(|m| m.case.configuration.name())),
    Column::input("parameter", "", "parameter taken through its levels", text!(|m| m.case.parameter.name())),
    Column::input("level", "", "level of that parameter", text!(|m| m.case.level.name(m.case.parameter))),
    Column::input("parameter_value", "SI unit of the parameter", "value of that parameter; null for the eight coefficients", Read::Number(|m| m.parameter_value)),
    Column::input("slenderness", "", "h_tot / b", Read::Number(|m| Some(m.case.slenderness))),
    Column::input("measure", "", "normalised largest rotation, a column of the run files", text!(|m| m.measure.column())),
    Column::result("runs", "", "runs, one a record, failed ones too", Read::Count(|m| Some(m.runs))),
    Column::result("collapsed", "", "runs that collapsed", Read::Count(|m| Some(m.collapsed))),
    Column::result("failed", "", "runs that failed; they take no part in the quantiles", Read::Count(|m| Some(m.failed))),
    Column::result("share_collapsed", "", "collapsed over finished runs", Read::Number(|m| m.share_collapsed())),
    Column::result("q05", "", "5 % quantile over the records; null where it lands among collapsed runs", Read::Number(|m| m.quantiles[0])),
    Column::result("q16", "", "16 % quantile", Read::Number(|m| m.quantiles[1])),
    Column::result("q25", "", "25 % quantile", Read::Number(|m| m.quantiles[2])),
    Column::result("median", "", "50 % quantile", Read::Number(|m| m.quantiles[3])),
    Column::result("median_low", "", "5 % quantile of the median over draws of the records and of ensembles; null where it is a collapse, or of fewer than five records", Read::Number(|m| m.interval.and_then(|interval| interval[0].rotation()))),
    Column::result("median_high", "", "95 % quantile of the median over these draws", Read::Number(|m| m.interval.and_then(|interval| interval[1].rotation()))),
    Column::result("q75", "", "75 % quantile", Read::Number(|m| m.quantiles[4])),
    Column::result("q84", "", "84 % quantile", Read::Number(|m| m.quantiles[5])),
    Column::result("q95", "", "95 % quantile", Read::Number(|m| m.quantiles[6])),
    Column::result("study_runs", "", "runs of the study that are stored; fewer than planned_runs: it is unfinished", Read::Count(|m| Some(m.study?.runs))),
    Column::result("planned_runs", "", "runs of its plan", Read::Count(|m| Some(m.study?.planned_runs))),
];

/// Writes the medians to a Parquet file.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses.
pub fn write_medians(path: &Path, medians: &Medians) -> Result<()> {
    write_table(path, COLUMNS, &[], &OfStudy::rows(medians.rows(), medians.completeness))
}

/// Writes the medians as CSV.
///
/// # Errors
/// What the stream says.
pub fn print_medians(mut out: impl Write, medians: &Medians) -> std::io::Result<()> {
    crate::store::print_csv(&mut out, COLUMNS.iter(), OfStudy::rows(medians.rows(), medians.completeness))
}

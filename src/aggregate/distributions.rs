//! What a study of drawn façades tells: quantiles over façades and records, one row a group and quantity.

use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

use super::medians::{Moved, VariantNote};
use super::quantile::MEDIAN;
use super::resampled::Interval;
use super::table::OfStudy;
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use crate::study::pipeline::Kind;
use crate::study::runs::Completeness;

/// Quantiles of one quantity over the runs of a group.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// Name of the set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// Record; none over all of them.
    pub record: Option<String>,
    /// Intensity of a stripe; none in other studies.
    pub intensity: Option<f64>,
    /// Limit of an incremental analysis; none in other studies.
    pub limit: Option<String>,
    /// What is told: a column of the run files, or [`super::CAPACITY`].
    pub quantity: &'static str,
    /// Runs, failed ones too.
    pub runs: u64,
    /// Runs that failed and take no part in the quantiles.
    pub failed: u64,
    /// Runs above all numbers: walls that collapsed; in an incremental analysis, walls that never exceeded the limit.
    pub beyond: u64,
    /// Quantiles at [`super::LEVELS`]; none where they land among those above all numbers.
    pub quantiles: [Option<f64>; 7],
    /// Their 90 % intervals over draws of façades and records; of one record over draws of façades.
    pub intervals: [Option<Interval>; 7],
}

impl Distribution {
    /// The median; none where it lies beyond all numbers, and where nothing was finished.
    pub fn median(&self) -> Option<f64> {
        self.quantiles[MEDIAN]
    }

    /// The interval of the median; `None` of too few façades or records.
    pub fn median_interval(&self) -> Option<Interval> {
        self.intervals[MEDIAN]
    }

    /// Share of the finished runs that lie beyond all numbers; none if none was finished.
    pub fn share_beyond(&self) -> Option<f64> {
        let finished = self.runs - self.failed;
        (finished > 0).then(|| self.beyond as f64 / finished as f64)
    }

    /// The stripe or limit in words; empty in other studies.
    pub fn stratum(&self, measure: Option<&str>) -> String {
        match (self.intensity, &self.limit) {
            (Some(intensity), _) => format!("{} {intensity}", measure.unwrap_or("intensity")),
            (None, Some(limit)) if limit == "collapse" => limit.clone(),
            (None, Some(limit)) => format!("theta/alpha {limit}"),
            (None, None) => String::new(),
        }
    }
}

/// All distributions of a study of drawn façades.
#[derive(Debug, Clone, PartialEq)]
pub struct Distributions {
    /// Kind of the study.
    pub kind: Kind,
    /// Variants in the order of the plan, the one to compare with first.
    pub variants: Vec<VariantNote>,
    /// Runs that come out differently from those of the first variant.
    pub moved: Vec<Moved>,
    /// Measure that records are scaled by; none where they are not scaled to an intensity.
    pub measure: Option<String>,
    /// How much of its plan the study has run; `None` where nobody knows.
    pub completeness: Option<Completeness>,
    /// In the order of the plan: over all records first, then by record.
    pub rows: Vec<Distribution>,
}

/// An end of the interval of a quantile.
macro_rules! end {
    ($quantile:expr, $end:expr) => {
        Read::Number(|d| d.intervals[$quantile].and_then(|interval| interval[$end]))
    };
}

macro_rules! text {
    (|$d:ident| $value:expr) => {
        Read::Text(|$d| Some(Cow::Borrowed($value)))
    };
}

/// Every column of the table of distributions, in order.
#[rustfmt::skip] // One column a line, so that the table reads as a table.
const COLUMNS: &[Column<OfStudy<Distribution>>] = &[
    Column::input("variant", "", "set of assumptions", text!(|d| &d.variant)),
    Column::input("configuration", "", "how the floor runs", text!(|d| &d.configuration)),
    Column::input("record", "", "record; null over all of them", Read::Text(|d| d.record.as_deref().map(Cow::Borrowed))),
    Column::input("intensity", "unit of the measure", "intensity of a stripe; null in other studies", Read::Number(|d| d.intensity)),
    Column::input("limit", "", "limit of an incremental analysis; null in other studies", Read::Text(|d| d.limit.as_deref().map(Cow::Borrowed))),
    Column::input("quantity", "", "what the quantiles are of, a column of the run files; capacity: the geometric middle of stood_intensity and intensity", text!(|d| d.quantity)),
    Column::result("runs", "", "runs, failed ones too", Read::Count(|d| Some(d.runs))),
    Column::result("failed", "", "runs that failed; they take no part in the quantiles", Read::Count(|d| Some(d.failed))),
    Column::result("beyond", "", "runs above all numbers: collapsed walls; in an incremental analysis, walls that never exceeded the limit", Read::Count(|d| Some(d.beyond))),
    Column::result("share_beyond", "", "the same over finished runs", Read::Number(|d| d.share_beyond())),
    Column::result("q05", "", "5 % quantile; null where it lies above all numbers", Read::Number(|d| d.quantiles[0])),
    Column::result("q16", "", "16 % quantile", Read::Number(|d| d.quantiles[1])),
    Column::result("q25", "", "25 % quantile", Read::Number(|d| d.quantiles[2])),
    Column::result("median", "", "50 % quantile", Read::Number(|d| d.quantiles[3])),
    Column::result("q75", "", "75 % quantile", Read::Number(|d| d.quantiles[4])),
    Column::result("q84", "", "84 % quantile", Read::Number(|d| d.quantiles[5])),
    Column::result("q95", "", "95 % quantile", Read::Number(|d| d.quantiles[6])),
    Column::result("q05_low", "", "5 % quantile of q05 over draws of façades and records; null where it lies above all numbers, and of fewer than five of them", end!(0, 0)),
    Column::result("q05_high", "", "95 % quantile of q05 over these draws", end!(0, 1)),
    Column::result("q16_low", "", "the same of q16", end!(1, 0)),
    Column::result("q16_high", "", "95 % quantile of q16 over these draws", end!(1, 1)),
    Column::result("q25_low", "", "the same of q25", end!(2, 0)),
    Column::result("q25_high", "", "95 % quantile of q25 over these draws", end!(2, 1)),
    Column::result("median_low", "", "the same of median", end!(3, 0)),
    Column::result("median_high", "", "95 % quantile of median over these draws", end!(3, 1)),
    Column::result("q75_low", "", "the same of q75", end!(4, 0)),
    Column::result("q75_high", "", "95 % quantile of q75 over these draws", end!(4, 1)),
    Column::result("q84_low", "", "the same of q84", end!(5, 0)),
    Column::result("q84_high", "", "95 % quantile of q84 over these draws", end!(5, 1)),
    Column::result("q95_low", "", "the same of q95", end!(6, 0)),
    Column::result("q95_high", "", "95 % quantile of q95 over these draws", end!(6, 1)),
    Column::result("study_runs", "", "runs of the study that are stored; fewer than planned_runs: it is unfinished", Read::Count(|d| Some(d.study?.runs))),
    Column::result("planned_runs", "", "runs of its plan", Read::Count(|d| Some(d.study?.planned_runs))),
];

impl Distributions {
    /// Writes the table to a Parquet file.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`crate::Error::Table`] if the disk refuses.
    pub fn write(&self, path: &Path) -> Result<()> {
        write_table(path, COLUMNS, &[], &OfStudy::rows(&self.rows, self.completeness))
    }

    /// Writes it as CSV.
    ///
    /// # Errors
    /// What the stream says.
    pub fn print_csv(&self, mut out: impl Write) -> std::io::Result<()> {
        crate::store::print_csv(&mut out, COLUMNS.iter(), OfStudy::rows(&self.rows, self.completeness))
    }
}

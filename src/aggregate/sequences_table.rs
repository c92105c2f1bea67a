//! What records do after others as a Parquet file and as CSV: one row a floor, part and sequence, and over all of them.

use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

use super::sequences::{After, Sequences};
use super::table::OfStudy;
use crate::error::Result;
use crate::store::{Column, Read, write_table};

/// Name of the file beside the runs.
pub const SEQUENCES_TABLE: &str = "sequences.parquet";

macro_rules! text {
    (|$a:ident| $value:expr) => {
        Read::Text(|$a| Some(Cow::Borrowed($value)))
    };
}

macro_rules! count {
    (|$a:ident| $value:expr) => {
        Read::Count(|$a| Some($value))
    };
}

/// Every column of the table, in order.
#[rustfmt::skip] // One column a line, so that the table reads as a table.
const COLUMNS: &[Column<OfStudy<After>>] = &[
    Column::input("variant", "", "set of assumptions", text!(|a| &a.variant)),
    Column::input("configuration", "", "how the floor runs", text!(|a| &a.configuration)),
    Column::input("sequence", "", "sequence; null over all of them", Read::Text(|a| a.sequence.as_deref().map(Cow::Borrowed))),
    Column::input("part", "", "which record of it, from 2", count!(|a| a.part)),
    Column::result("walls", "", "walls, each once a sequence", count!(|a| a.walls)),
    Column::result("failed", "", "walls of which a run failed", count!(|a| a.failed)),
    Column::result("fell_before", "", "walls that had fallen in a part before", count!(|a| a.fell_before)),
    Column::result("compared", "", "the others, which are compared", count!(|a| a.compared())),
    Column::result("fell_after", "", "of these, those that fall in this part after the others", count!(|a| a.fell_after)),
    Column::result("fell_alone", "", "those that fall under its record alone", count!(|a| a.fell_alone)),
    Column::result("fell_only_after", "", "those that fall after the others and stand it alone", count!(|a| a.fell_only_after)),
    Column::result("fell_only_alone", "", "those that fall alone and stand it after the others", count!(|a| a.fell_only_alone)),
    Column::result("share_only_after", "", "fell_only_after over the compared walls that stand it alone", Read::Number(|a| a.share_only_after())),
    Column::result("share_only_after_low", "", "5 % quantile of it over draws of records and walls; null of fewer than five of both", Read::Number(|a| a.share_interval?[0])),
    Column::result("share_only_after_high", "", "95 % quantile of it over these draws", Read::Number(|a| a.share_interval?[1])),
    Column::result("ratios", "", "compared walls that stand it alone and rotate: those of the ratio", count!(|a| a.ratios)),
    Column::result("ratio_q16", "", "16 % quantile of the largest rotation after the others over that alone; walls that fall after them rank above all numbers, and a quantile among them is null", Read::Number(|a| a.ratio[0])),
    Column::result("ratio_median", "", "its median", Read::Number(|a| a.ratio[1])),
    Column::result("ratio_q84", "", "its 84 % quantile", Read::Number(|a| a.ratio[2])),
    Column::result("ratio_median_low", "", "5 % quantile of the median over draws of records and walls", Read::Number(|a| a.ratio_interval?[0])),
    Column::result("ratio_median_high", "", "95 % quantile of the median over these draws", Read::Number(|a| a.ratio_interval?[1])),
    Column::result("study_runs", "", "runs of the study that are stored; fewer than planned_runs: it is unfinished", Read::Count(|a| Some(a.study?.runs))),
    Column::result("planned_runs", "", "runs of its plan", Read::Count(|a| Some(a.study?.planned_runs))),
];

impl Sequences {
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

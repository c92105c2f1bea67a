//! Columns of Parquet files as a frame of polars, which groups, filters and sorts their rows.
//!
//! A text stands in the frame as the number of its label: 4 bytes a row instead of a string, and polars groups and
//! compares numbers. Only this module knows that.

mod labels;
mod read;
#[cfg(test)]
pub(crate) mod testing;

use std::collections::BTreeMap;
use std::sync::Arc;

use polars::prelude::*;

use read::Values;
pub(crate) use read::{column_names, read};

/// Rows of Parquet files: numbers, counts, truth values and texts, each of which may be null.
pub(crate) struct Frame {
    rows: DataFrame,
    /// Labels by column of texts: what the numbers in it stand for.
    labels: BTreeMap<String, Arc<[Arc<str>]>>,
}

impl Frame {
    /// A frame of columns that are read to their ends.
    ///
    /// # Errors
    /// What polars says of columns of different lengths, or of one name.
    fn new(columns: Vec<Values>) -> PolarsResult<Self> {
        let mut labels = BTreeMap::new();
        let mut series = Vec::with_capacity(columns.len());
        for values in columns {
            let (column, texts) = values.finish();
            labels.extend(texts.map(|texts| (column.name().to_string(), texts)));
            series.push(column);
        }
        Ok(Self { rows: DataFrame::new_infer_height(series)?, labels })
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.rows.height()
    }

    /// A column of real numbers.
    ///
    /// # Errors
    /// What polars says of a column that was not read, or is of another kind.
    pub fn numbers(&self, name: &str) -> PolarsResult<&Float64Chunked> {
        self.rows.column(name)?.f64()
    }

    /// A column of counts.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn counts(&self, name: &str) -> PolarsResult<&UInt64Chunked> {
        self.rows.column(name)?.u64()
    }

    /// A column of truth values.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn flags(&self, name: &str) -> PolarsResult<&BooleanChunked> {
        self.rows.column(name)?.bool()
    }

    /// A column of texts; truth values are `true` and `false`.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn texts(&self, name: &str) -> PolarsResult<Texts<'_>> {
        Ok(match self.labels.get(name) {
            Some(labels) => Texts::Labels { numbers: self.rows.column(name)?.u32()?, labels },
            None => Texts::Flags(self.flags(name)?),
        })
    }

    /// A column of numbers, counts or truth values as numbers, where true is 1; none for a column of texts.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn as_numbers(&self, name: &str) -> PolarsResult<Option<Float64Chunked>> {
        if self.labels.contains_key(name) {
            return Ok(None);
        }
        Ok(Some(self.rows.column(name)?.cast(&DataType::Float64)?.f64()?.clone()))
    }

    /// The rows that hold these texts, given by column; a null is no text.
    ///
    /// # Errors
    /// As [`Frame::numbers`], and for a column without texts.
    pub fn with_texts(&self, wanted: &[(&str, &str)]) -> PolarsResult<Self> {
        let mut kept = BooleanChunked::full(PlSmallStr::EMPTY, true, self.height());
        for &(name, text) in wanted {
            let known =
                self.labels.get(name).and_then(|labels| labels.iter().position(|label| **label == *text));
            let numbers = self.rows.column(name)?.u32()?;
            // A label that no row has: no number stands for it.
            kept = kept & numbers.equal(known.map_or(labels::NO_LABEL, |number| number as u32));
        }
        Ok(self.of(self.rows.filter(&kept)?))
    }

    /// The rows without a null in any of these columns.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn without_nulls(&self, names: &[&str]) -> PolarsResult<Self> {
        Ok(self.of(self.rows.drop_nulls(Some(names))?))
    }

    /// The rows with a null in this column.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn with_null(&self, name: &str) -> PolarsResult<Self> {
        let column = self.rows.column(name)?;
        // Often all rows: these need no copy.
        let rows = match column.null_count() == self.height() {
            true => self.rows.clone(),
            false => self.rows.filter(&column.is_null())?,
        };
        Ok(self.of(rows))
    }

    /// The rows in increasing order of these columns, none of which is one of texts.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn sorted_by(&self, names: &[&str]) -> PolarsResult<Self> {
        Ok(self.of(self.rows.sort(names, SortMultipleOptions::default())?))
    }

    /// Groups of rows that are alike in all `keys`, where nulls are alike too; in the order of their first rows.
    ///
    /// # Errors
    /// As [`Frame::numbers`].
    pub fn groups(&self, keys: &[&str]) -> PolarsResult<Groups> {
        Ok(Groups(self.rows.group_by_stable(keys)?.into_groups()))
    }

    fn of(&self, rows: DataFrame) -> Self {
        Self { rows, labels: self.labels.clone() }
    }
}

/// A column of texts.
#[derive(Clone, Copy)]
pub(crate) enum Texts<'a> {
    /// Numbers of labels.
    Labels {
        /// The numbers.
        numbers: &'a UInt32Chunked,
        /// What they stand for.
        labels: &'a [Arc<str>],
    },
    /// Truth values.
    Flags(&'a BooleanChunked),
}

impl<'a> Texts<'a> {
    /// The text in a row; none for a null.
    pub fn get(self, row: usize) -> Option<&'a str> {
        match self {
            Texts::Labels { numbers, labels } => Some(&**labels.get(numbers.get(row)? as usize)?),
            Texts::Flags(flags) => Some(if flags.get(row)? { "true" } else { "false" }),
        }
    }
}

/// Groups of rows.
pub(crate) struct Groups(GroupPositions);

impl Groups {
    /// The rows of each group, increasing.
    pub fn iter(&self) -> impl Iterator<Item = Vec<usize>> + '_ {
        self.0.iter().map(|group| match group {
            GroupsIndicator::Idx((_, rows)) => rows.iter().map(|&row| row as usize).collect(),
            GroupsIndicator::Slice([first, length]) => {
                (first..first + length).map(|row| row as usize).collect()
            }
        })
    }
}

//! Single runs as they stand in a frame: values that every run has.

use polars::prelude::{PolarsError, PolarsResult, polars_err};

use crate::store::frame::Frame;

/// A run in a frame.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    /// The frame.
    pub frame: &'a Frame,
    /// Its row in it.
    pub row: usize,
}

impl Row<'_> {
    /// A text.
    ///
    /// # Errors
    /// An error for a null, and for a column that was not read.
    pub fn text(self, name: &str) -> PolarsResult<String> {
        self.optional_text(name)?.ok_or_else(|| absent(name))
    }

    /// A text that not every run has.
    ///
    /// # Errors
    /// An error for a column that was not read.
    pub fn optional_text(self, name: &str) -> PolarsResult<Option<String>> {
        Ok(self.frame.texts(name)?.get(self.row).map(str::to_owned))
    }

    /// What `find` knows by the text.
    ///
    /// # Errors
    /// As [`Row::text`], and for a text that is not known.
    pub fn named<T>(self, name: &str, find: impl Fn(&str) -> Option<T>) -> PolarsResult<T> {
        let value = self.text(name)?;
        find(&value).ok_or_else(
            || polars_err!(ComputeError: "column {name} holds {value:?}, which this version does not know"),
        )
    }

    /// A number.
    ///
    /// # Errors
    /// As [`Row::text`].
    pub fn number(self, name: &str) -> PolarsResult<f64> {
        self.optional_number(name)?.ok_or_else(|| absent(name))
    }

    /// A number that not every run has.
    ///
    /// # Errors
    /// As [`Row::optional_text`].
    pub fn optional_number(self, name: &str) -> PolarsResult<Option<f64>> {
        Ok(self.frame.numbers(name)?.get(self.row))
    }

    /// A count.
    ///
    /// # Errors
    /// As [`Row::text`].
    pub fn count(self, name: &str) -> PolarsResult<u64> {
        self.frame.counts(name)?.get(self.row).ok_or_else(|| absent(name))
    }
}

pub(super) fn absent(name: &str) -> PolarsError {
    polars_err!(ComputeError: "column {name} lacks a value that every run has")
}

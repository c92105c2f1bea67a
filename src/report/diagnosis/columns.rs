//! Columns of the tables beside `diagnosis.json`.

use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};

use crate::error::{Error, InputError, Result};
use crate::fragility::Table;

/// Some columns of a table of the folder; a table without rows has columns without values.
pub struct Columns(Option<Table>);

impl Columns {
    /// Reads columns.
    ///
    /// # Errors
    /// Input errors for a file that is no such table.
    pub fn read(path: &Path, names: &[&str]) -> Result<Self> {
        let file = std::fs::File::open(path)
            .map_err(|e| InputError::file(path, e.to_string(), "a table as `mrbd diagnose` writes it"))?;
        let reader = SerializedFileReader::new(file).map_err(|e| Error::table(path, e))?;
        let empty = reader.metadata().file_metadata().num_rows() == 0;
        Ok(Self(if empty { None } else { Some(Table::read(path, names)?) }))
    }

    /// Numbers of a column; NaN where there is none.
    ///
    /// # Errors
    /// As [`Table::numbers`].
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let Some(table) = &self.0 else { return Ok(Vec::new()) };
        Ok(table.numbers(name)?.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }

    /// Texts of a column.
    ///
    /// # Errors
    /// As [`Table::labels`].
    pub fn labels(&self, name: &str) -> Result<Vec<String>> {
        self.0.as_ref().map_or(Ok(Vec::new()), |table| table.labels(name))
    }
}

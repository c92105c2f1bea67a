//! Histories of single runs, as CSV or Parquet by the file's extension.
//!
//! `theta1_rad` and `theta2_rad` are what the sensors read. Where that is not the rotation itself, the rotation stands
//! beside it in `theta1_true_rad` and `theta2_true_rad`.

use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_schema::{ArrowError, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::errors::ParquetError;
use tempfile::NamedTempFile;

use super::durable::put_in_place;
use crate::error::{Error, InputError, Result};
use mrbd_kernel::model::Reading;
use mrbd_kernel::simulate::History;

/// A place for a history, opened before the run so that a path that cannot be written is found first.
#[derive(Debug)]
pub struct HistoryWriter {
    path: PathBuf,
    file: NamedTempFile,
    format: Format,
}

#[derive(Debug, Clone, Copy)]
enum Format {
    Csv,
    Parquet,
}

/// Opens a history file to be.
///
/// # Errors
/// An extension other than .csv and .parquet; a folder that cannot be written.
pub fn write_history(path: &Path) -> Result<HistoryWriter> {
    let format = match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("csv") => Format::Csv,
        Some("parquet") => Format::Parquet,
        other => {
            let found = format!("extension {:?}", other.unwrap_or(""));
            return Err(InputError::key(path, "--history", found, ".csv or .parquet").into());
        }
    };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let file = NamedTempFile::new_in(folder).map_err(|e| {
        InputError::key(path, "--history", e.to_string(), "a file in a folder that can be written")
    })?;
    Ok(HistoryWriter { path: path.to_path_buf(), file, format })
}

impl HistoryWriter {
    /// Writes the rows, with the rotations as they are read; the file appears whole.
    ///
    /// # Errors
    /// What the file system says.
    pub fn finish(self, history: &History, reading: &Reading) -> Result<()> {
        let Self { path, file, format } = self;
        match format {
            Format::Csv => write_csv(file.as_file(), history, reading).map_err(|e| Error::table(&path, e))?,
            Format::Parquet => {
                write_parquet(file.as_file(), history, reading).map_err(|e| Error::table(&path, e))?
            }
        }
        put_in_place(file, &path)
    }
}

/// Times without the roundings of a product: to the nanosecond.
fn tidy_s(time_s: f64) -> f64 {
    (time_s * 1e9).round() / 1e9
}

/// The first columns of every history, and those of the true rotations where they are read otherwise.
const COLUMNS: [&str; 6] =
    ["time_s", "theta1_rad", "theta2_rad", "pattern", "theta1_true_rad", "theta2_true_rad"];

/// Unit and meaning of each column.
const MEANINGS: [(&str, &str); 6] = [
    ("s", "time from the beginning of the record"),
    ("rad", "rotation of the lower body as its sensor reads it, clockwise positive"),
    ("rad", "rotation of the upper body as its sensor reads it, clockwise positive"),
    ("", "pattern of contact: rest, 1a to 4b"),
    ("rad", "rotation of the lower body itself"),
    ("rad", "rotation of the upper body itself"),
];

fn columns(reading: &Reading) -> &'static [&'static str] {
    &COLUMNS[..if reading.is_true() { 4 } else { 6 }]
}

fn write_csv(file: &File, history: &History, reading: &Reading) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(columns(reading))?;
    for row in &history.rows {
        let [theta1, theta2] = reading.of(row.theta_rad);
        let read = (tidy_s(row.time_s), theta1, theta2, row.contact.name());
        if reading.is_true() {
            writer.serialize(read)?;
        } else {
            writer.serialize((read, row.theta_rad))?;
        }
    }
    writer.flush()?;
    Ok(())
}

/// A history as a table, its rotations as they are read.
///
/// # Errors
/// What Arrow says of columns that do not fit together: a defect of the program to report.
pub fn history_table(history: &History, reading: &Reading) -> Result<RecordBatch, ArrowError> {
    let rows = &history.rows;
    let column = |of: &dyn Fn(usize) -> f64| -> ArrayRef {
        Arc::new(Float64Array::from_iter_values((0..rows.len()).map(of)))
    };
    let pattern = StringArray::from_iter_values(rows.iter().map(|row| row.contact.name()));
    let arrays = [
        column(&|i| tidy_s(rows[i].time_s)),
        column(&|i| reading.of(rows[i].theta_rad)[0]),
        column(&|i| reading.of(rows[i].theta_rad)[1]),
        Arc::new(pattern) as ArrayRef,
        column(&|i| rows[i].theta_rad[0]),
        column(&|i| rows[i].theta_rad[1]),
    ];
    let fields =
        columns(reading).iter().zip(MEANINGS).zip(&arrays).map(|((name, (unit, meaning)), array)| {
            let metadata = [("unit", unit), ("description", meaning)]
                .map(|(key, value)| (key.to_owned(), value.to_owned()));
            Field::new(*name, array.data_type().clone(), false).with_metadata(HashMap::from(metadata))
        });
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    RecordBatch::try_new(schema, arrays[..columns(reading).len()].to_vec())
}

fn write_parquet(file: &File, history: &History, reading: &Reading) -> Result<(), ParquetError> {
    let batch = history_table(history, reading)?;
    let mut writer = ArrowWriter::try_new(file, batch.schema(), None)?;
    writer.write(&batch)?;
    writer.close()?;
    Ok(())
}

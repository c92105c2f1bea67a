//! One Parquet file, written block by block under a temporary name.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow::array::RecordBatch;
use arrow::datatypes::{Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, Encoding as Bytes, ZstdLevel};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::schema::types::ColumnPath;
use tempfile::NamedTempFile;

use super::column::{Column, Encoding, Read};
use super::durable;
use crate::error::{Error, Result};

/// Rows a row group: what readers such as DuckDB take as one unit of work.
const ROWS_PER_GROUP: usize = 122_880;

/// zstd's own default: beyond it files shrink by percents and writing slows severalfold.
const ZSTD_LEVEL: i32 = 3;

/// A Parquet file being written; it takes its name only when it is finished.
pub struct ParquetFile<R: 'static> {
    path: PathBuf,
    columns: &'static [Column<R>],
    schema: SchemaRef,
    writer: ArrowWriter<NamedTempFile>,
}

impl<R> ParquetFile<R> {
    /// Begins a file of these columns; `metadata` are keys and values about the whole file.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::Table`] if the file cannot be begun.
    pub fn create(path: &Path, columns: &'static [Column<R>], metadata: &[(String, String)]) -> Result<Self> {
        let schema = Arc::new(Schema::new(columns.iter().map(Column::field).collect::<Vec<_>>()));
        let properties = properties(columns, metadata).map_err(|e| Error::table(path, e))?;
        let file = durable::beside(path)?;
        let writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties))
            .map_err(|e| Error::table(path, e))?;
        Ok(Self { path: path.to_path_buf(), columns, schema, writer })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// [`Error::Table`] if they cannot be written.
    pub fn write(&mut self, rows: &[R]) -> Result<()> {
        let arrays = self.columns.iter().map(|column| column.array(rows)).collect();
        let batch = RecordBatch::try_new(Arc::clone(&self.schema), arrays);
        batch
            .map_err(|e| Error::table(&self.path, e))
            .and_then(|batch| self.writer.write(&batch).map_err(|e| Error::table(&self.path, e)))
    }

    /// Ends the file, brings it to the disk and gives it its name.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::Table`] if the disk refuses.
    pub fn finish(self) -> Result<()> {
        // This writes the last row group and the footer too.
        let file = self.writer.into_inner().map_err(|e| Error::table(&self.path, e))?;
        durable::put_in_place(file, &self.path)
    }
}

fn properties<R>(
    columns: &[Column<R>],
    metadata: &[(String, String)],
) -> parquet::errors::Result<WriterProperties> {
    let pairs = metadata.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let mut builder = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(ZSTD_LEVEL)?))
        .set_max_row_group_row_count(Some(ROWS_PER_GROUP))
        .set_key_value_metadata(Some(pairs.collect()));
    for column in columns.iter().filter(|column| column.encoding == Encoding::Distinct) {
        let path = ColumnPath::from(column.name);
        builder = builder.set_column_dictionary_enabled(path.clone(), false);
        if matches!(column.read, Read::Number(_)) {
            builder = builder.set_column_encoding(path, Bytes::BYTE_STREAM_SPLIT);
        }
    }
    Ok(builder.build())
}

//! One Parquet file, written block by block under a temporary name.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::RecordBatch;
use arrow_schema::{Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, Encoding as Bytes, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;
use tempfile::NamedTempFile;

use super::column::{Column, Encoding, Read};
use super::durable;
use crate::error::{Error, Result};
use mrbd_files::checksum::sha256;

/// Rows a row group: what readers such as DuckDB take as one unit of work.
const ROWS_PER_GROUP: usize = 122_880;

/// zstd's own default: beyond it files shrink by percents and writing slows severalfold.
const ZSTD_LEVEL: i32 = 3;

/// How the pages of a file are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pages {
    /// Small: a file that stays.
    Small,
    /// Not at all: a file that is soon put together with others. To make zstd ready for each of its columns costs more than
    /// all else about so short a file.
    Plain,
}

impl Pages {
    fn compression(self) -> parquet::errors::Result<Compression> {
        Ok(match self {
            Pages::Small => Compression::ZSTD(ZstdLevel::try_new(ZSTD_LEVEL)?),
            Pages::Plain => Compression::UNCOMPRESSED,
        })
    }
}

/// A Parquet file being written; it takes its name only when it is finished.
pub struct ParquetFile<R: 'static> {
    /// The file or, before it has a name, its folder: for messages.
    place: PathBuf,
    columns: &'static [Column<R>],
    schema: SchemaRef,
    writer: ArrowWriter<NamedTempFile>,
}

impl<R> ParquetFile<R> {
    /// Begins a file of these columns in a folder; `metadata` are keys and values about the whole file; `drawn` says
    /// whether the rows are of drawn façades.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the file cannot be begun.
    pub fn create_in(
        folder: &Path,
        columns: &'static [Column<R>],
        metadata: &[(String, String)],
        drawn: bool,
        pages: Pages,
    ) -> Result<Self> {
        let schema = Arc::new(Schema::new(columns.iter().map(Column::field).collect::<Vec<_>>()));
        let properties = properties(columns, metadata, drawn, pages).map_err(|e| Error::table(folder, e))?;
        let file = durable::unfinished_in(folder)?;
        let writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties))
            .map_err(|e| refused(folder, e))?;
        Ok(Self { place: folder.to_path_buf(), columns, schema, writer })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if they cannot be written.
    pub fn write(&mut self, rows: &[R]) -> Result<()> {
        self.write_batch(&self.batch(rows)?)
    }

    /// Rows as columns, for this file and others of the same columns.
    ///
    /// # Errors
    /// [`Error::Table`] if the columns are not as long as each other.
    pub fn batch(&self, rows: &[R]) -> Result<RecordBatch> {
        let arrays = self.columns.iter().map(|column| column.array(rows)).collect();
        RecordBatch::try_new(Arc::clone(&self.schema), arrays).map_err(|e| Error::table(&self.place, e))
    }

    /// Adds rows that are columns already, of the same columns.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if they cannot be written, or are of other columns.
    pub fn write_batch(&mut self, rows: &RecordBatch) -> Result<()> {
        self.writer.write(rows).map_err(|e| refused(&self.place, e))
    }

    /// Ends the file, brings it to the disk and gives it the name that `name` makes of its SHA-256, which is returned.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
    pub fn finish_as(self, name: impl FnOnce(&str) -> PathBuf) -> Result<String> {
        // This writes the last row group and the footer too.
        let file = self.writer.into_inner().map_err(|e| refused(&self.place, e))?;
        let sha256 = file.reopen().and_then(sha256).map_err(|e| Error::io("read back", &self.place, e))?;
        durable::put_in_place(file, &name(&sha256))?;
        Ok(sha256)
    }
}

/// Writes a table as one file, there whole or as it was before; `metadata` as for [`ParquetFile::create_in`].
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
pub fn write_table<R>(
    path: &Path,
    columns: &'static [Column<R>],
    metadata: &[(String, String)],
    rows: &[R],
) -> Result<()> {
    let mut file = ParquetFile::create_in(durable::folder_of(path), columns, metadata, false, Pages::Small)?;
    file.write(rows)?;
    file.finish_as(|_| path.to_path_buf()).map(|_| ())
}

/// What the library said; where it passes on what the disk said, that.
fn refused(place: &Path, error: ParquetError) -> Error {
    match error {
        ParquetError::External(source) => match source.downcast::<std::io::Error>() {
            Ok(source) => Error::io("write into", place, *source),
            Err(source) => Error::table(place, source),
        },
        error => Error::table(place, error),
    }
}

fn properties<R>(
    columns: &[Column<R>],
    metadata: &[(String, String)],
    drawn: bool,
    pages: Pages,
) -> parquet::errors::Result<WriterProperties> {
    let pairs = metadata.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
    let mut builder = WriterProperties::builder()
        .set_compression(pages.compression()?)
        .set_max_row_group_row_count(Some(ROWS_PER_GROUP))
        .set_key_value_metadata(Some(pairs.collect()));
    let distinct = |column: &&Column<R>| match column.encoding {
        Encoding::Distinct => true,
        Encoding::Drawn => drawn,
        Encoding::Repeating => false,
    };
    if pages == Pages::Plain {
        // Nobody looks for rows in it.
        builder = builder.set_statistics_enabled(EnabledStatistics::None).set_offset_index_disabled(true);
    }
    for column in columns.iter().filter(distinct) {
        let path = ColumnPath::from(column.name);
        builder = builder.set_column_dictionary_enabled(path.clone(), false);
        if matches!(column.read, Read::Number(_)) {
            builder = builder.set_column_encoding(path, Bytes::BYTE_STREAM_SPLIT);
        }
    }
    Ok(builder.build())
}

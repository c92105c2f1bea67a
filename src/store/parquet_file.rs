//! One Parquet file, written block by block under a temporary name.

use std::fmt;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::RecordBatch;
use arrow_schema::{Schema, SchemaRef};
use parquet::arrow::arrow_writer::ArrowWriterOptions;
use parquet::arrow::{ArrowSchemaConverter, ArrowWriter, add_encoded_arrow_schema_to_metadata};
use parquet::basic::{Compression, Encoding as Bytes, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::ColumnPath;
use tempfile::NamedTempFile;

use super::column::{Column, Encoding, Read};
use super::durable;
use crate::error::{Error, Result};
use mrbd_files::checksum::Hashing;

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

/// Bytes that go to the disk at once. A file of few rows has small pages: a call for each was a tenth of its cost.
const WRITTEN_AT_ONCE: usize = 1 << 18;

/// What files of the same rows share: their columns and how these are written. Worked out once: of a file of few rows it was a tenth of
/// the cost.
pub struct Form<R: 'static> {
    columns: &'static [Column<R>],
    schema: SchemaRef,
    options: ArrowWriterOptions,
}

impl<R> Form<R> {
    /// Of these columns; `metadata` are keys and values about the whole file; `drawn` says whether the rows are of drawn façades.
    ///
    /// # Errors
    /// What the library says of columns that it cannot write.
    pub fn new(
        columns: &'static [Column<R>],
        metadata: &[(String, String)],
        drawn: bool,
        pages: Pages,
    ) -> std::result::Result<Self, ParquetError> {
        let schema = Arc::new(Schema::new(columns.iter().map(Column::field).collect::<Vec<_>>()));
        let mut properties = properties(columns, metadata, drawn, pages)?;
        // Here, once, and not by the writer of every file: the schema with units and meanings, which readers of Arrow take.
        add_encoded_arrow_schema_to_metadata(&schema, &mut properties);
        let options = ArrowWriterOptions::new()
            .with_parquet_schema(ArrowSchemaConverter::new().convert(&schema)?)
            .with_properties(properties)
            .with_skip_arrow_metadata(true);
        Ok(Self { columns, schema, options })
    }

    /// Rows as columns, for every file of this form.
    ///
    /// # Errors
    /// What the library says if the columns are not as long as each other.
    pub fn batch(&self, rows: &[R]) -> std::result::Result<RecordBatch, ParquetError> {
        let arrays = self.columns.iter().map(|column| column.array(rows)).collect();
        Ok(RecordBatch::try_new(Arc::clone(&self.schema), arrays)?)
    }
}

impl<R> fmt::Debug for Form<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Form").field("columns", &self.columns.len()).finish_non_exhaustive()
    }
}

/// A Parquet file being written; it takes its name only when it is finished.
pub struct ParquetFile {
    /// The file or, before it has a name, its folder: for messages.
    place: PathBuf,
    writer: ArrowWriter<BufWriter<Hashing<NamedTempFile>>>,
}

impl ParquetFile {
    /// Begins a file of a form in a folder.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] or [`Error::Table`] if the file cannot be begun.
    pub fn create_in<R>(folder: &Path, form: &Form<R>) -> Result<Self> {
        let file = Hashing::new(durable::unfinished_in(folder)?);
        let file = BufWriter::with_capacity(WRITTEN_AT_ONCE, file);
        let writer = ArrowWriter::try_new_with_options(file, Arc::clone(&form.schema), form.options.clone())
            .map_err(|e| refused(folder, e))?;
        Ok(Self { place: folder.to_path_buf(), writer })
    }

    /// Adds rows of the columns of its form.
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
        let file = file.into_inner().map_err(|e| Error::io("write into", &self.place, e.into_error()))?;
        let (file, sha256) = file.finish();
        durable::put_in_place(file, &name(&sha256))?;
        Ok(sha256)
    }
}

/// Writes a table as one file, there whole or as it was before; `metadata` are keys and values about the whole file.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
pub fn write_table<R>(
    path: &Path,
    columns: &'static [Column<R>],
    metadata: &[(String, String)],
    rows: &[R],
) -> Result<()> {
    let form = Form::new(columns, metadata, false, Pages::Small).map_err(|e| Error::table(path, e))?;
    let mut file = ParquetFile::create_in(durable::folder_of(path), &form)?;
    file.write_batch(&form.batch(rows).map_err(|e| Error::table(path, e))?)?;
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

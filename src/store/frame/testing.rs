//! Parquet files for tests of what is read off them.

use std::fs::File;
use std::path::{Path, PathBuf};

use arrow_array::{ArrayRef, RecordBatch};
use parquet::arrow::ArrowWriter;

/// Writes columns of one length into a file, which is returned.
pub(crate) fn write(folder: &Path, name: &str, columns: Vec<(&str, ArrayRef)>) -> PathBuf {
    let batch = RecordBatch::try_from_iter(columns).expect("a batch");
    let path = folder.join(name);
    let mut file =
        ArrowWriter::try_new(File::create(&path).expect("a file"), batch.schema(), None).expect("begun");
    file.write(&batch).expect("written");
    file.close().expect("closed");
    path
}

//! Results on disk, written whole or not at all: Parquet files with one row a run, where they came from, histories.

mod column;
mod durable;
mod folder;
mod history;
mod manifest;
mod parquet_file;
mod schema;
mod sink;

pub use column::{Column, Encoding, Read, Stage, print_csv};
pub use durable::write_durably;
pub use folder::{OutputFolder, run_files};
pub use history::{HistoryWriter, write_history};
pub use manifest::{Manifest, file_sha256};
pub use parquet_file::ParquetFile;
pub use schema::{COLUMNS, SCHEMA_VERSION};
pub use sink::RunSink;

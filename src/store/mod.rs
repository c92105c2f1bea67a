//! What is kept of a study: Parquet files with one row a run, and where they came from.

mod column;
mod durable;
mod folder;
mod manifest;
mod parquet_file;
mod schema;
mod sink;

pub use column::{Column, Encoding, Read, Stage, print_csv};
pub use durable::write_durably;
pub use folder::{OutputFolder, run_files};
pub use manifest::{Manifest, file_sha256};
pub use parquet_file::ParquetFile;
pub use schema::{COLUMNS, SCHEMA_VERSION};
pub use sink::RunSink;

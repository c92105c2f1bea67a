//! Results on disk, written whole or not at all: Parquet files with one row a run, where they came from, histories.

mod column;
mod durable;
mod folder;
mod history;
mod manifest;
mod manifest_differences;
mod parquet_file;
mod parts;
mod schema;
mod whole_folder;

pub use column::{Column, Encoding, Read, Stage, print_csv};
pub use durable::write_durably;
pub use folder::{Earlier, OutputFolder};
pub use history::{HistoryWriter, write_history};
pub use manifest::{Manifest, RecordNote, SuiteNote};
pub use parquet_file::{ParquetFile, write_table};
pub use parts::{RunFile, listed_run_files, run_files};
pub use schema::{COLUMNS, SCHEMA_VERSION};
pub use whole_folder::WholeFolder;

//! The folder of a study: Parquet files with one row a run, and where they came from.

mod completeness;
mod folder;
mod manifest;
mod parts;
mod schema;

pub use completeness::Completeness;
pub use folder::{Earlier, OutputFolder};
pub use manifest::{Manifest, RecordNote, SequenceNote, SuiteNote};
pub use parts::{Part, RunFile, listed_run_files, run_files};
pub use schema::{COLUMNS, OLDEST_READ, RESULTS, SCHEMA_VERSION};

//! Results on disk, written whole or not at all: tables as Parquet, histories, folders of files that belong together.

pub(crate) mod column;
pub(crate) mod durable;
pub(crate) mod frame;
mod history;
pub(crate) mod parquet_file;

pub use column::{Column, Encoding, Read, Stage, print_csv};
pub use durable::WholeFolder;
pub use durable::write_durably;
pub use history::{HistoryWriter, history_table, write_history};
pub use parquet_file::write_table;

/// Now, seconds since 1970: when results were begun.
pub(crate) fn now_unix_s() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

/// The page that a report makes of a folder; results that are replaced take it with them.
pub const PAGE_NAME: &str = "report.html";

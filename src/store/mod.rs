//! Results on disk: written whole or not at all.

mod history;

pub use history::{HistoryWriter, write_history};

//! Files the user writes: read, checked at the door, turned into values that are valid.

pub mod assumptions;
pub mod coefficients;
pub mod experiment;
pub mod pipeline;
mod study;
pub mod survey;
mod sweep_table;
pub(crate) mod toml_file;
mod wall_file;

pub(crate) use wall_file::wall_from_table;
pub use wall_file::{load_wall, parse_wall};

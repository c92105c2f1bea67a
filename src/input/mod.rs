//! Files the user writes: read, checked at the door, turned into values that are valid.

pub(crate) mod toml_file;
mod wall_file;

pub use wall_file::load_wall;

//! Files that describe studies: read, checked at the door, turned into values that are valid.

pub mod assumptions;
pub mod pipeline;
mod study;
pub mod survey;
mod sweep_table;

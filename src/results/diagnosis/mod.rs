//! The folder of a diagnosis: `diagnosis.json`, tables, the updated wall.

mod output;
pub mod tables;

pub use output::{KIND, OutputNames, write_results};

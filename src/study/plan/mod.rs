//! A study becomes a list of runs that can be printed and tested before anything runs.
//!
//! The list is computed, not stored: run `i` follows from `i`, so a plan of a million runs costs nothing to hold
//! and any run can be repeated alone. The record varies slowest, so that the runs of a record stand together and end in
//! one file; then the variant; then what the kind of study has, see `kinds.rs`.

mod fingerprint;
mod kinds;
mod level;
mod list;
mod pick_freeze;
mod run;

pub use level::{Level, coefficients, facade};
pub use list::Plan;
pub use pick_freeze::{FACTORS, Factor, Matrix};
pub use run::{Growth, Origin, Run, Scaling};
pub use run::{Motions, RecordHash};

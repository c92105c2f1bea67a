//! How far a given wall is from falling: the smallest factor on each record that takes it beyond a limit.
//!
//! Every record is searched as an incremental analysis is ([`crate::study::ladder`]). A factor found that way may be
//! one of chance: the members of an ensemble at it say whether the wall exceeds the limit there whatever nobody can know.

mod capacity;
mod fragility;

pub use capacity::{COLUMNS, Capacity, MEMBERS, Question, Status, capacities};
pub use fragility::{Curve, MEASURES, curves};

use serde::{Deserialize, Serialize};

/// What a manifest says such results are.
pub const KIND: &str = "margin";

/// What is written beside the manifest and the page.
pub const FILES: [&str; 3] = ["manifest.json", "margin.json", "margin.parquet"];

/// The margin of a wall under the records of a suite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Margin {
    /// Name of the wall file.
    pub wall: String,
    /// Name of the suite.
    pub suite: String,
    /// `collapse`, or the rotation over α_i that may not be exceeded.
    pub limit: String,
    /// First and last factor on the records.
    pub range: [f64; 2],
    /// Each factor over the one before.
    pub growth: f64,
    /// Factor found to exceed the limit over the one below it that did not, at most.
    pub bracket: f64,
    /// Error allowed in rotations relative to α_i.
    pub tolerance: f64,
    /// Free motion after a record, s.
    pub tail_s: f64,
    /// One a record, in the order of the suite.
    pub records: Vec<Capacity>,
    /// One a measure of intensity.
    pub fragility: Vec<Curve>,
}

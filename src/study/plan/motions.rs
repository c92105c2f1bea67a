//! The records of a plan and the hashes that tell them.

use super::id::Fingerprint;
use mrbd_records::{Accelerogram, Suite, SuiteRecord};

/// The ground motions of a plan, and a hash of the samples of each.
#[derive(Debug, Clone)]
pub struct Motions {
    /// The suite.
    pub suite: Suite,
    /// Hashes of its records, by position in the suite.
    pub hashes: Vec<RecordHash>,
}

/// SHA-256 of the step and samples of a record as they are run (scaled), 64 hexadecimal digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordHash {
    /// The horizontal component.
    pub horizontal: String,
    /// The vertical component; none where the record has none.
    pub vertical: Option<String>,
}

impl Motions {
    /// A suite and the hashes of its records.
    pub fn new(suite: Suite) -> Self {
        let hash = |motion: &Accelerogram| Fingerprint::of("motion").motion(motion).hex();
        let of = |record: &SuiteRecord| RecordHash {
            horizontal: hash(&record.horizontal),
            vertical: record.vertical.as_ref().map(hash),
        };
        let hashes = suite.records.iter().map(of).collect();
        Self { suite, hashes }
    }
}

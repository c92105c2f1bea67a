//! One run of a plan: everything that goes into it.

use std::sync::Arc;

use super::facade::Facade;
use super::id::Fingerprint;
use super::level::Level;
use crate::ground::{Accelerogram, Suite, SuiteRecord};
use crate::input::pipeline::{Parameter, Variant};
use crate::input::survey::Configuration;
use crate::model::Wall;
use crate::simulate::{Accuracy, Shaking};

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

/// One run: a wall, the record that shakes it, and how the plan came to it.
#[derive(Debug, Clone)]
pub struct Run {
    /// Position in the plan, from 0.
    pub position: u64,
    /// First 16 hexadecimal digits of the SHA-256 of all inputs; stable under changes of the plan's order.
    pub id: String,
    /// The suite the record belongs to.
    pub motions: Arc<Motions>,
    /// Position of the record in the suite, from 0.
    pub record_index: usize,
    /// Assumptions of the run.
    pub variant: Arc<Variant>,
    /// How the floor runs.
    pub configuration: Configuration,
    /// Parameter that is taken through its levels.
    pub parameter: Parameter,
    /// Level of that parameter.
    pub level: Level,
    /// The façade.
    pub facade: Facade,
    /// The wall it became.
    pub wall: Wall,
}

impl Run {
    /// The record.
    pub fn record(&self) -> &SuiteRecord {
        &self.motions.suite.records[self.record_index]
    }

    /// Hashes of the record's samples.
    pub fn record_hash(&self) -> &RecordHash {
        &self.motions.hashes[self.record_index]
    }

    /// What shakes the wall.
    pub fn shaking(&self) -> Shaking {
        let record = self.record();
        let assumptions = &self.variant.assumptions;
        Shaking {
            horizontal: Some(record.horizontal.clone()),
            vertical: record.vertical.clone().filter(|_| assumptions.vertical),
            tail_s: assumptions.tail_s,
        }
    }

    /// How accurately to run.
    pub fn accuracy(&self) -> Accuracy {
        Accuracy { tolerance: self.variant.assumptions.tolerance }
    }

    /// The id: what was asked for, the wall that came out, the samples that shake it and the accuracy.
    pub(super) fn with_id(mut self) -> Self {
        let assumptions = &self.variant.assumptions;
        let hash = self.record_hash();
        // A component that does not act is no input.
        let vertical = hash.vertical.as_deref().filter(|_| assumptions.vertical);
        self.id = Fingerprint::of("run")
            .text("variant", &self.variant.name)
            .text("configuration", self.configuration.name())
            .text("parameter", self.parameter.name())
            .text("level", self.level.name(self.parameter))
            .number("slenderness", self.facade.slenderness)
            .number("strength", self.facade.compressive_strength_pa)
            .wall(self.wall.parameters())
            .text("record", &self.record().name)
            .text("horizontal", &hash.horizontal)
            .text("vertical", vertical.unwrap_or("none"))
            .numbers("time", &[assumptions.tail_s, assumptions.tolerance])
            .id();
        self
    }
}

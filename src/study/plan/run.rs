//! One run of a plan: everything that goes into it, its record, and its id.
//!
//! The id is a hash of everything that goes into a run, so that equal ids mean equal runs.

use std::sync::Arc;

use super::fingerprint::Fingerprint;
use super::level::Level;
use super::pick_freeze::Matrix;
use crate::study::ladder::Ladder;
use crate::study::pipeline::{Limit, Parameter, Variant};
use crate::study::sequence::{Place, Sequence};
use crate::survey::{Configuration, Facade, ImpossibleFacade};
use mrbd_kernel::model::{Restitution, Wall};
use mrbd_kernel::simulate::{Accuracy, Shaking};
use mrbd_records::{Accelerogram, IntensityMeasures, ScaledMeasure, Suite, SuiteRecord};

/// How the plan came to a façade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Origin {
    /// The mean façade with one parameter at one of its levels.
    Level(Parameter, Level),
    /// A draw from the survey, by its number.
    Draw(u64),
    /// A point of a study of variance, by its number, in a matrix.
    Matrix(u64, Matrix),
}

/// How strongly the record shakes the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scaling {
    /// Times a factor, 1 for the record as the suite has it.
    Factor(f64),
    /// Scaled to an intensity.
    To(ScaledMeasure, f64),
    /// Scaled to growing intensities until a limit is exceeded.
    Growing(Growth),
}

/// An incremental analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// What the wall may reach at most.
    pub limit: Limit,
    /// What grows.
    pub measure: ScaledMeasure,
    /// First and last intensity.
    pub range: [f64; 2],
    /// Each intensity over the one before.
    pub growth: f64,
    /// Lowest intensity that exceeded the limit over the highest below it that did not, at most.
    pub bracket: f64,
}

impl Growth {
    /// The intensities to search.
    pub fn ladder(&self) -> Ladder {
        Ladder { range: self.range, growth: self.growth, bracket: self.bracket }
    }
}

/// One run: a façade, the record that shakes it, and how the plan came to it.
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
    /// The sequence that the record is a part of, and the row of it; none of a record by itself.
    pub sequence: Option<(Arc<Sequence>, Place)>,
    /// Assumptions of the run.
    pub variant: Arc<Variant>,
    /// How the floor runs.
    pub configuration: Configuration,
    /// How the plan came to the façade.
    pub origin: Origin,
    /// How strongly the record shakes it.
    pub scaling: Scaling,
    /// Factor on the record of the suite; of an incremental analysis that is at work or done, the one it is at.
    pub factor: f64,
    /// The façade.
    pub facade: Facade,
    /// What becomes of velocities at impacts.
    pub restitution: Restitution,
    /// The wall it became, or why it is none.
    pub wall: Result<Wall, ImpossibleFacade>,
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

    /// Parameter taken through its levels; none for a drawn façade.
    pub fn parameter(&self) -> Option<Parameter> {
        match self.origin {
            Origin::Level(parameter, _) => Some(parameter),
            Origin::Draw(_) | Origin::Matrix(..) => None,
        }
    }

    /// Level of that parameter.
    pub fn level(&self) -> Option<Level> {
        match self.origin {
            Origin::Level(_, level) => Some(level),
            Origin::Draw(_) | Origin::Matrix(..) => None,
        }
    }

    /// Number of the draw; none for a façade that was not drawn.
    pub fn draw(&self) -> Option<u64> {
        match self.origin {
            Origin::Level(..) => None,
            Origin::Draw(index) | Origin::Matrix(index, _) => Some(index),
        }
    }

    /// Matrix of a study of variance; none in other studies.
    pub fn matrix(&self) -> Option<Matrix> {
        match self.origin {
            Origin::Matrix(_, matrix) => Some(matrix),
            _ => None,
        }
    }

    /// The incremental analysis, if it is one.
    pub fn growth(&self) -> Option<&Growth> {
        match &self.scaling {
            Scaling::Growing(growth) => Some(growth),
            _ => None,
        }
    }

    /// Intensity measures of the record times the factor.
    pub fn intensity(&self) -> IntensityMeasures {
        self.record().intensity.scaled(self.factor)
    }

    /// The measure the record is scaled by and its value; none where it is not scaled to an intensity.
    pub fn scaled_to(&self) -> Option<(ScaledMeasure, f64)> {
        match self.scaling {
            Scaling::Factor(_) => None,
            // As it was asked for, without the rounding of the factor.
            Scaling::To(measure, value) => Some((measure, value)),
            Scaling::Growing(growth) => Some((growth.measure, growth.measure.of(&self.intensity()))),
        }
    }

    /// What shakes the wall.
    pub fn shaking(&self) -> Shaking {
        let record = self.record();
        let assumptions = &self.variant.assumptions;
        // The samples of a suite are shared by its runs unless they are scaled.
        let scaled = |motion: &Accelerogram| match self.factor * self.variant.change().amplitude {
            1.0 => motion.clone(),
            factor => motion.scaled(factor),
        };
        Shaking {
            horizontal: Some(scaled(&record.horizontal)),
            vertical: record.vertical.as_ref().filter(|_| assumptions.vertical).map(scaled),
            tail_s: self.tail_s(),
        }
    }

    /// Free motion after the record: the rest of a sequence, or what the study assumes, s.
    pub fn tail_s(&self) -> f64 {
        let after_last_s = self.variant.assumptions.tail_s;
        match &self.sequence {
            Some((sequence, place)) => sequence.tail_s(place.part, after_last_s),
            None => after_last_s,
        }
    }

    /// The parts that go before the run; none of a wall as it was built.
    pub fn parts_before(&self) -> usize {
        match &self.sequence {
            Some((_, Place { part, alone: false })) => *part,
            _ => 0,
        }
    }

    /// The run of a part that goes before it, or itself.
    #[must_use]
    pub fn part_before(&self, part: usize) -> Self {
        let Some((sequence, place)) = &self.sequence else { return self.clone() };
        let sequence = Arc::clone(sequence);
        let of = sequence.parts[part];
        let before = Self {
            position: self.position - (place.part - part) as u64,
            record_index: of.record_index,
            factor: of.scale,
            sequence: Some((sequence, Place { part, alone: false })),
            ..self.clone()
        };
        before.with_id()
    }

    /// How accurately to run.
    pub fn accuracy(&self) -> Accuracy {
        self.variant.change().accuracy(Accuracy { tolerance: self.variant.assumptions.tolerance })
    }

    /// The id: what was asked for, the wall that came out, the samples that shake it and the accuracy.
    pub(super) fn with_id(mut self) -> Self {
        let assumptions = &self.variant.assumptions;
        let hash = self.record_hash();
        // A component that does not act is no input.
        let vertical = hash.vertical.as_deref().filter(|_| assumptions.vertical);
        let asked = Fingerprint::of("run")
            .text("variant", &self.variant.name)
            .text("configuration", self.configuration.name());
        let asked = match self.origin {
            Origin::Level(parameter, level) => {
                asked.text("parameter", parameter.name()).text("level", level.name(parameter))
            }
            Origin::Draw(index) => self.scaling_into(asked.text("draw", &index.to_string())),
            Origin::Matrix(index, matrix) => {
                let asked = asked.text("draw", &index.to_string()).text("matrix", matrix.name());
                self.scaling_into(asked)
            }
        };
        let asked = asked
            .number("slenderness", self.facade.slenderness)
            .number("strength", self.facade.compressive_strength_pa);
        let asked = match &self.wall {
            Ok(wall) => asked.wall(wall.parameters()),
            Err(impossible) => asked.text("impossible", &impossible.to_string()),
        };
        self.id = asked
            .sequence(self.sequence.as_ref(), assumptions.crushing_stays, &self.motions.hashes)
            .text("record", &self.record().name)
            .text("horizontal", &hash.horizontal)
            .text("vertical", vertical.unwrap_or("none"))
            .numbers("time", &[self.tail_s(), assumptions.tolerance])
            .member(self.variant.member.as_ref())
            .id();
        self
    }

    fn scaling_into(&self, hash: Fingerprint) -> Fingerprint {
        let hash = hash.number("factor", self.factor);
        match self.scaling {
            Scaling::Factor(_) => hash,
            Scaling::To(measure, value) => hash.text("measure", measure.name()).number("intensity", value),
            Scaling::Growing(Growth { limit, measure, range, growth, bracket }) => hash
                .text("limit", &limit.to_string())
                .text("measure", measure.name())
                .numbers("growth", &[range[0], range[1], growth, bracket]),
        }
    }
}

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

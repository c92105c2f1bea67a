//! One run of a plan: everything that goes into it, its record, and its id.
//!
//! The id is a hash of everything that goes into a run, so that equal ids mean equal runs.

use std::sync::Arc;

use super::level::Level;
use super::pick_freeze::Matrix;
use crate::study::ladder::Ladder;
use crate::study::pipeline::{Limit, Member, Parameter, Variant};
use crate::survey::{Configuration, Facade, ImpossibleFacade};
use mrbd_formula::Formula;
use mrbd_kernel::model::{Effect, Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Shaking};
use mrbd_records::{Accelerogram, IntensityMeasures, ScaledMeasure, Suite, SuiteRecord};
use sha2::{Digest, Sha256};

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
            tail_s: assumptions.tail_s,
        }
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
            .text("record", &self.record().name)
            .text("horizontal", &hash.horizontal)
            .text("vertical", vertical.unwrap_or("none"))
            .numbers("time", &[assumptions.tail_s, assumptions.tolerance])
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

/// Digits of an id: 64 bits, so that two of 10⁶ runs share one with a chance of 3e-8.
const ID_DIGITS: usize = 16;

/// A hash under construction, fed with named values.
pub(super) struct Fingerprint(Sha256);

impl Fingerprint {
    /// An empty one; `kind` keeps hashes of different things apart.
    pub fn of(kind: &str) -> Self {
        Self(Sha256::new()).text("kind", kind)
    }

    /// Adds a text; its length goes first, so that neighbours cannot trade letters.
    pub fn text(mut self, name: &str, value: &str) -> Self {
        for part in [name, value] {
            self.0.update((part.len() as u64).to_le_bytes());
            self.0.update(part.as_bytes());
        }
        self
    }

    /// Adds numbers by their bits.
    pub fn numbers(mut self, name: &str, values: &[f64]) -> Self {
        self = self.text("numbers", name);
        self.0.update((values.len() as u64).to_le_bytes());
        values.iter().for_each(|value| self.0.update(value.to_bits().to_le_bytes()));
        self
    }

    /// Adds one number.
    pub fn number(self, name: &str, value: f64) -> Self {
        self.numbers(name, &[value])
    }

    /// Adds every parameter of a wall; a parameter added to the model must be added here to compile.
    pub fn wall(self, parameters: &WallParameters) -> Self {
        let WallParameters {
            thickness_m,
            height_m,
            crack_height_m,
            length_m,
            mass_kg,
            lower_width_m,
            upper_width_m,
            diaphragm_mass_kg,
            carriage_mass_kg,
            stiffness_n_per_m,
            eccentricity_m,
            restitution,
            collapse_rotation_ratio,
            initial_rotation_rad,
            effects,
            formulas,
        } = parameters;
        self.numbers("size", &[*thickness_m, *height_m, crack_height_m.unwrap_or(0.0), *length_m])
            .numbers("masses", &[*mass_kg, *diaphragm_mass_kg, *carriage_mass_kg])
            .numbers("corners", &[*lower_width_m, *upper_width_m])
            .numbers("spring", &[*stiffness_n_per_m, *eccentricity_m])
            .numbers("coefficients", &restitution.coefficients)
            .text("law", restitution.law.name())
            .number("capture velocity", restitution.capture_velocity_rad_s)
            .number("collapse", *collapse_rotation_ratio)
            .numbers("initial", initial_rotation_rad)
            .effects(effects)
            .formulas(formulas)
    }

    /// A wall without formulas hashes as before there were any.
    fn formulas(self, formulas: &[Formula]) -> Self {
        let texts = formulas.iter().map(|formula| serde_json::to_string(formula).unwrap_or_default());
        texts.fold(self, |hash, formula| hash.text("formula", &formula))
    }

    /// Adds the place in an ensemble, of which the factors on motion and tolerance follow; nothing of a run as planned.
    fn member(self, member: Option<&Member>) -> Self {
        match member {
            None => self,
            Some(Member { member_of, number }) => {
                self.text("member of", member_of).text("member", &number.to_string())
            }
        }
    }

    fn effects(self, effects: &[Effect]) -> Self {
        // As a wall file has them; numbers, texts and enums always serialise.
        let texts = effects.iter().map(|effect| serde_json::to_string(effect).unwrap_or_default());
        texts.fold(self.number("effects", effects.len() as f64), |hash, effect| hash.text("effect", &effect))
    }

    /// Adds the step and every sample of a ground motion.
    pub fn motion(self, motion: &Accelerogram) -> Self {
        self.number("step", motion.step_s()).numbers("samples", motion.acceleration_m_s2())
    }

    /// The whole hash, 64 hexadecimal digits.
    pub fn hex(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The beginning of the hash that serves as an id.
    pub fn id(self) -> String {
        let mut hex = self.hex();
        hex.truncate(ID_DIGITS);
        hex
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_sha256_of_nothing_added() {
        // NIST's example value for the empty message.
        let empty = Fingerprint(Sha256::new()).hex();
        assert_eq!(empty, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    }

    #[test]
    fn regress_neighbours_cannot_trade_letters_or_numbers() {
        let of = |a: &str, b: &str| Fingerprint::of("test").text("a", a).text("b", b).id();
        assert_ne!(of("xy", "z"), of("x", "yz"));
        let of = |a: &[f64], b: &[f64]| Fingerprint::of("test").numbers("a", a).numbers("b", b).id();
        assert_ne!(of(&[1.0, 2.0], &[3.0]), of(&[1.0], &[2.0, 3.0]));
        assert_eq!(of(&[1.0], &[2.0]).len(), ID_DIGITS);
    }
}

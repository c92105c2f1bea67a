//! What a conclusion is about: a study that does not vary it has no say in it.

use super::view::{Slender, View};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// What a conclusion compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Reference façades, all parameters at their means.
    Reference,
    /// Reference façades under several records.
    Records,
    /// Parameters that both floors share.
    Shared,
    /// The levels of one parameter.
    Of(Parameter),
}

/// What a study must hold for a conclusion to be asked of it.
#[derive(Debug, Clone, Copy)]
pub struct Needs {
    /// What is compared.
    pub subject: Subject,
    /// Under these floors.
    pub floors: &'static [Configuration],
    /// At slendernesses in each of these ranges.
    pub slender: &'static [Slender],
}

/// Slendernesses on both sides of the source's line.
pub const BOTH_RANGES: &[Slender] = &[Slender::Moderate, Slender::Large];

impl Needs {
    /// What of it the medians of a study lack, in words; `None` where they lack nothing.
    pub fn missing(&self, view: &View) -> Option<String> {
        let lacks = |floor: &&Configuration| !self.subject.is_varied(view, **floor);
        if let Some(floor) = self.floors.iter().find(lacks) {
            return Some(format!("{} under the {} floor", self.subject.name(), floor.name()));
        }
        let lacks = |range: &&Slender| view.slendernesses(**range).is_empty();
        self.slender.iter().find(lacks).map(|range| range.name().to_owned())
    }
}

impl Subject {
    fn is_varied(self, view: &View, floor: Configuration) -> bool {
        let mut rows = view.rows().filter(|row| row.case.configuration == floor);
        match self {
            Subject::Reference => rows.next().is_some(),
            Subject::Records => rows.any(|row| row.runs > 1),
            Subject::Shared => !view.shared_parameters().is_empty(),
            Subject::Of(parameter) => {
                let mut levels = rows.filter(|row| row.case.parameter == parameter).map(|row| row.case.level);
                levels.any(|level| level != Level::Mean)
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Subject::Reference => "façades",
            Subject::Records => "several records",
            Subject::Shared => "levels of a parameter that both floors have",
            Subject::Of(parameter) => match parameter {
                Parameter::Thickness => "levels of the thickness",
                Parameter::CrackHeight => "levels of the crack height",
                Parameter::Strength => "levels of the strength",
                Parameter::Stiffness => "levels of the floor's stiffness",
                Parameter::DiaphragmMass => "levels of the floor's mass m_d",
                Parameter::CarriageMass => "levels of the floor's mass m_dp",
                Parameter::Restitution => "levels of the coefficients C_l",
            },
        }
    }
}

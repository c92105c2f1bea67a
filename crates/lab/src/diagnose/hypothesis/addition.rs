//! What may be added to a wall.

use super::unknown::Slot;
use super::{Scales, Unknown, WallNumber};
use mrbd_kernel::model::{EffectParameter, EffectVariant, Place, WallParameters};

/// Coefficients that impacts under the law `contact` can act with; C_7 and C_8 belong to impacts that end in sticking.
pub const ACTING: usize = 6;
/// Largest damper, in sizes that matter: it holds what it is on, and a stronger one does the same in ever shorter steps.
const STRONGEST_DAMPER: f64 = 100.0;
/// Standard deviation of a factor on C_l about 1: wide, but a factor that never acts stays at 1.
const FACTOR_SD: f64 = 0.3;

/// Something added to the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Addition {
    /// An effect of the catalogue.
    Effect(EffectVariant),
    /// Part of m_d acts sideways only: the carriage of the paper, which its first model lumped into m_d.
    LumpedCarriage,
    /// A number of the wall outside what was known of it: a symptom, never an answer.
    Number(&'static WallNumber),
    /// A vertical motion that cannot have been: the record backwards. Shows what a term without meaning gains.
    Placebo,
}

impl Addition {
    /// Name among the rivals.
    pub fn name(&self) -> String {
        match self {
            Addition::Effect(variant) => variant.name(),
            Addition::LumpedCarriage => "carriage_mass.lumped".into(),
            Addition::Number(number) => number.key.into(),
            Addition::Placebo => "placebo".into(),
        }
    }

    /// Kind of effect it is called by in answers; none for what is no answer.
    pub fn kind(&self) -> Option<&'static str> {
        match self {
            Addition::Effect(variant) => Some(variant.kind.name),
            Addition::LumpedCarriage => Some("carriage_mass"),
            Addition::Number(_) | Addition::Placebo => None,
        }
    }

    /// Where it acts.
    pub fn place(&self) -> &'static str {
        match self {
            Addition::Effect(variant) => place_name(variant),
            Addition::LumpedCarriage => "top",
            Addition::Number(number) if number.key.starts_with("diaphragm") => "top",
            Addition::Number(number) if number.key.starts_with("corners") => "joint",
            Addition::Number(_) => "masses",
            Addition::Placebo => "none",
        }
    }

    /// The numbers to be found of the addition with this index.
    pub(super) fn unknowns(&self, base: &WallParameters, scales: &Scales, index: usize) -> Vec<Unknown> {
        let alone = |key: &str, unit, start, lower, upper| {
            let scale = scales.of_unit(unit, key);
            vec![Unknown {
                key: key.into(),
                unit,
                start,
                scale,
                lower,
                upper,
                prior_sd: None,
                slot: Slot::Added(index, 0),
            }]
        };
        match self {
            Addition::Effect(variant) => effect_unknowns(*variant, scales, index),
            Addition::LumpedCarriage => alone("mass_kg", "kg", 0.0, 0.0, base.diaphragm_mass_kg),
            Addition::Number(number) => {
                let value = (number.get)(base);
                let reach = if value == 0.0 { scales.of_unit(number.unit, number.key) } else { value.abs() };
                let mut unknowns =
                    alone(number.key, number.unit, value, value - 0.9 * reach, value + 4.0 * reach);
                unknowns[0].scale = reach;
                unknowns
            }
            Addition::Placebo => alone("ratio", "", 0.0, -2.0, 2.0),
        }
    }
}

/// Name of the place of a kind in answers.
fn place_name(variant: &EffectVariant) -> &'static str {
    match variant.kind.place {
        Place::Top => "top",
        Place::Joint => match variant.choice {
            Some("ground") => "ground",
            Some("crack") => "crack",
            _ => "joint",
        },
        Place::Impacts => "impacts",
        Place::GroundMotion => "ground motion",
        Place::Sensor => "sensor",
    }
}

fn effect_unknowns(variant: EffectVariant, scales: &Scales, index: usize) -> Vec<Unknown> {
    let parameters = variant.kind.parameters.iter().enumerate();
    let acting = |(i, _): &(usize, _)| variant.kind.name != "impact_dissipation" || *i < ACTING;
    let unknown = |(i, parameter): (usize, &EffectParameter)| {
        let scale = scales.of_unit(parameter.unit, parameter.key);
        let damper = matches!(parameter.unit, "N s/m" | "N m s/rad");
        Unknown {
            key: parameter.key.into(),
            unit: parameter.unit,
            start: neutral(parameter.key).clamp(parameter.least, parameter.most),
            scale,
            lower: parameter.least,
            upper: if damper { parameter.most.min(STRONGEST_DAMPER * scale) } else { parameter.most },
            prior_sd: parameter.key.starts_with("factor").then_some(FACTOR_SD),
            slot: Slot::Added(index, i),
        }
    };
    parameters.filter(acting).map(unknown).collect()
}

/// The value of a number at which its effect does nothing.
pub fn neutral(key: &str) -> f64 {
    if key.starts_with("gain") || key.starts_with("factor") { 1.0 } else { 0.0 }
}

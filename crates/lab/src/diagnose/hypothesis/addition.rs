//! What may be added to a wall, and all the additions that are tried.

use super::unknown::{Measure, Slot, wall_number};
use super::{Scales, Unknown, WallNumber};
use crate::diagnose::formula::{Law, LawSlot};
use crate::limits::{FACTOR_SD, MOST_OF_LAW, PRIOR_REACH, STRONGEST_DAMPER};
use mrbd_kernel::model::{
    EffectKind, EffectParameter, EffectVariant, Joint, Place, Quantity, Role, WallParameters,
};

/// Coefficients that impacts under the law `contact` can act with; C_7 and C_8 belong to impacts that end in sticking.
pub const ACTING: usize = 6;

/// Something added to the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Addition {
    /// An effect of the catalogue.
    Effect(EffectVariant),
    /// Part of m_d acts sideways only: the carriage of the paper, which its first model lumped into m_d.
    LumpedCarriage,
    /// A number of the wall outside what was known of it: a symptom, never an answer.
    Number(&'static WallNumber),
    /// A law that is none of the catalogue, with the numbers that were found for it over points.
    Formula(Law),
    /// A force without a formula, which the hypothesis has beside its additions.
    Curve,
    /// A vertical motion that cannot have been: the record backwards. Shows what a term without meaning gains.
    Placebo,
}

impl Addition {
    /// Name among the rivals.
    pub fn name(&self) -> String {
        match self {
            Addition::Effect(variant) => variant.name(),
            Addition::LumpedCarriage => format!("{}.lumped", EffectKind::CarriageMass.name()),
            Addition::Number(number) => number.key.into(),
            Addition::Formula(law) => law.name(),
            Addition::Curve => "curve".into(),
            Addition::Placebo => "placebo".into(),
        }
    }

    /// Kind of effect it is called by in answers; `None` for what is no answer.
    pub fn kind(&self) -> Option<EffectKind> {
        match self {
            Addition::Effect(variant) => Some(variant.kind),
            Addition::LumpedCarriage => Some(EffectKind::CarriageMass),
            Addition::Number(_) | Addition::Formula(_) | Addition::Curve | Addition::Placebo => None,
        }
    }

    /// The joint it acts at, where it may act at either.
    pub fn joint(&self) -> Option<Joint> {
        match self {
            Addition::Effect(variant) => variant.joint(),
            _ => None,
        }
    }

    /// Whether both may be added to one wall: two kinds, or one kind at two joints.
    pub fn stands_beside(&self, other: &Self) -> bool {
        let at_two_joints = || matches!((self.joint(), other.joint()), (Some(one), Some(two)) if one != two);
        self.kind() != other.kind() || at_two_joints()
    }

    /// Its role in the mechanics of the wall; `None` for what is no answer.
    pub fn role(&self) -> Option<Role> {
        self.kind().map(|kind| kind.entry().role)
    }

    /// Where it acts.
    pub fn place(&self) -> &'static str {
        match self {
            Addition::Effect(variant) => place_name(variant),
            Addition::LumpedCarriage => "top",
            Addition::Number(number) if number.key.starts_with("diaphragm") => "top",
            Addition::Number(number) if number.key.starts_with("corners") => "joint",
            Addition::Number(_) => "masses",
            Addition::Formula(law) => law.first.site.name(),
            Addition::Curve => "top",
            Addition::Placebo => "none",
        }
    }

    /// The numbers to be found of the addition with this index.
    pub(super) fn unknowns(&self, base: &WallParameters, scales: &Scales, index: usize) -> Vec<Unknown> {
        let alone = |key: &str, quantity: Quantity, start, lower, upper| {
            vec![Unknown {
                measure: Measure::Itself,
                key: key.into(),
                unit: quantity.unit(),
                start,
                scale: scales.size(quantity),
                lower,
                upper,
                prior_sd: None,
                slot: Slot::Added(index, 0),
            }]
        };
        match self {
            Addition::Effect(variant) => effect_unknowns(*variant, scales, index),
            Addition::LumpedCarriage => alone("mass_kg", Quantity::TopMass, 0.0, 0.0, base.diaphragm_mass_kg),
            Addition::Number(number) => {
                let value = (number.get)(base);
                let reach = if value == 0.0 { scales.size(number.quantity) } else { value.abs() };
                let mut unknowns =
                    alone(number.key, number.quantity, value, value - 0.9 * reach, value + 4.0 * reach);
                unknowns[0].scale = reach;
                unknowns
            }
            Addition::Formula(law) => law_unknowns(law, index),
            Addition::Curve => Vec::new(),
            Addition::Placebo => alone("ratio", Quantity::Ratio, 0.0, -2.0, 2.0),
        }
    }
}

/// Name of the place of a kind in answers.
fn place_name(variant: &EffectVariant) -> &'static str {
    match variant.entry().place {
        Place::Top => "top",
        Place::Joint => match variant.joint() {
            Some(Joint::Ground) => "ground",
            Some(Joint::Crack) => "crack",
            None => "joint",
        },
        Place::Impacts => "impacts",
        Place::GroundMotion => "ground motion",
        Place::Sensor => "sensor",
    }
}

fn effect_unknowns(variant: EffectVariant, scales: &Scales, index: usize) -> Vec<Unknown> {
    let parameters = variant.entry().parameters.iter().enumerate();
    let acting = |(i, _): &(usize, _)| variant.entry().role != Role::Impact || *i < ACTING;
    let unknown = |(i, parameter): (usize, &EffectParameter)| {
        let scale = scales.size(parameter.quantity);
        let damper = variant.entry().role == Role::Damper;
        let most = if damper { parameter.most.min(STRONGEST_DAMPER * scale) } else { parameter.most };
        let measure = match parameter.quantity {
            Quantity::BedStiffness => Measure::Softness,
            _ => Measure::Itself,
        };
        let known = scales.sensor_gain_sd.filter(|_| variant.kind == EffectKind::SensorGain);
        // Outside what was known a gain is no answer.
        let reach = known.map(|sd| [-1.0, 1.0].map(|side| 1.0 + side * PRIOR_REACH * sd));
        let [lower, upper] = reach.unwrap_or([parameter.least, most]).map(|number| measure.value_of(number));
        Unknown {
            key: parameter.key.into(),
            unit: parameter.unit(),
            start: measure.value_of(parameter.neutral),
            scale: measure.value_of(scale),
            lower: lower.min(upper),
            upper: lower.max(upper),
            measure,
            prior_sd: (parameter.quantity == Quantity::ImpactFactor).then_some(FACTOR_SD).or(known),
            slot: Slot::Added(index, i),
        }
    };
    parameters.filter(acting).map(unknown).collect()
}

/// Sizes, which do nothing at 0, and numbers of shapes, within what the search looks at.
fn law_unknowns(law: &Law, index: usize) -> Vec<Unknown> {
    let atoms = law.atoms().collect::<Vec<_>>();
    let of = |(i, (slot, value)): (usize, (LawSlot, f64))| {
        let bounds =
            |start: f64, scale: f64, [lower, upper]: [f64; 2], key: &str, unit: &'static str| Unknown {
                key: key.into(),
                unit,
                start,
                scale,
                lower,
                upper,
                prior_sd: None,
                measure: Measure::Itself,
                slot: Slot::Added(index, i),
            };
        match slot {
            LawSlot::Size(a) => {
                let most = MOST_OF_LAW * value.abs();
                let least = if atoms[a].may_be(-most) { -most } else { 0.0 };
                bounds(0.0, value.abs(), [least, most], "size", atoms[a].site.unit())
            }
            LawSlot::Number(a, k) => {
                let number = &atoms[a].shape.numbers()[k];
                let ends = atoms[a].bounds(k);
                let unit = atoms[a].site.unit_of(number.meaning);
                let scale = value.abs().max(f64::MIN_POSITIVE);
                bounds(value, scale, ends.map(|end| end * atoms[a].unit_of(k)), number.letter, unit)
            }
        }
    };
    law.slots().into_iter().zip(law.values()).enumerate().map(of).collect()
}

/// Numbers of the wall that stand beside the effects as rivals: what a wrong drawing or a wrong weight would do.
const RIVAL_NUMBERS: [&str; 5] = [
    "diaphragm.stiffness_n_per_m",
    "diaphragm.mass_kg",
    "wall.mass_kg",
    "wall.crack_height_m",
    "diaphragm.eccentricity_m",
];

/// Every addition to a wall that is tried alone: the catalogue, the lumped carriage, numbers outside what was known of
/// them, and a placebo.
pub fn candidates(wall: &WallParameters) -> Vec<Addition> {
    // Beds are tried apart: walls on them take long to simulate. Their rivals are tried where a top is held.
    let sought =
        EffectKind::ALL.iter().filter(|kind| !matches!(kind.entry().role, Role::Bed | Role::JointLaw));
    let mut all = sought.flat_map(|kind| kind.variants()).map(Addition::Effect).collect::<Vec<_>>();
    if wall.diaphragm_mass_kg > 0.0 {
        all.push(Addition::LumpedCarriage);
    }
    let present =
        |number: &&super::WallNumber| (number.get)(wall) != 0.0 || number.key == "diaphragm.eccentricity_m";
    all.extend(RIVAL_NUMBERS.iter().filter_map(|key| wall_number(key)).filter(present).map(Addition::Number));
    all.push(Addition::Placebo);
    all
}

/// Joints that give: at the ground, at the crack, and both alike.
pub fn beds() -> Vec<Addition> {
    let beds = EffectKind::ALL.iter().filter(|kind| kind.entry().role == Role::Bed);
    beds.flat_map(|kind| kind.variants()).map(Addition::Effect).collect()
}

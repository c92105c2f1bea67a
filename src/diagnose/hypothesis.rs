//! A model that might be true: the wall, what is uncertain of it, and what is added to it.

use nalgebra::{DMatrix, DVector};

use super::scale::Scales;
use super::wall_number::WallNumber;
use crate::model::{Effect, EffectParameter, EffectVariant, Place, Wall, WallParameters};

/// Standard deviations of its prior within which a number of the wall is taken to lie.
pub const PRIOR_REACH: f64 = 3.0;
/// A relative prior wider than this says that a number was not known.
const WIDE_PRIOR: f64 = 0.1;
/// Coefficients that impacts under the law `contact` can act with; C_7 and C_8 belong to impacts that end in sticking.
pub const ACTING: usize = 6;
/// Largest damper, in sizes that matter: it holds what it is on, and a stronger one does the same in ever shorter steps.
const STRONGEST_DAMPER: f64 = 100.0;
/// Standard deviation of a factor on C_l about 1: wide, but a factor that never acts stays at 1.
const FACTOR_SD: f64 = 0.3;

/// What was known of a number of the wall before the tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nuisance {
    /// A number, with its relative standard deviation.
    Number(&'static WallNumber, f64),
    /// C_l by its index from 0, with its relative standard deviation.
    Coefficient(usize, f64),
}

impl Nuisance {
    /// Whether what was known says so little that the number was not known.
    pub fn is_wide(&self) -> bool {
        let (Nuisance::Number(_, sd) | Nuisance::Coefficient(_, sd)) = self;
        *sd > WIDE_PRIOR
    }
}

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

    fn unknowns(&self, base: &WallParameters, scales: &Scales, index: usize) -> Vec<Unknown> {
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

/// Where the value of an unknown goes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slot {
    Number(&'static WallNumber),
    Coefficient(usize),
    /// Addition by its index, parameter by its index.
    Added(usize, usize),
}

/// One number to be found.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Key, of the wall file or of the effect.
    pub key: String,
    /// Unit.
    pub unit: &'static str,
    /// Where the search starts: the wall file's value, or the value that does nothing.
    pub start: f64,
    /// A size that matters.
    pub scale: f64,
    /// Least value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
    /// Standard deviation known beforehand, about the start.
    pub prior_sd: Option<f64>,
    slot: Slot,
}

impl Unknown {
    /// Whether it is a number of the addition with this index.
    pub fn belongs_to(&self, index: usize) -> bool {
        matches!(self.slot, Slot::Added(i, _) if i == index)
    }

    /// A value with a share of its distance from the start.
    pub fn with_share(&self, share: f64, value: f64) -> f64 {
        (self.start + share * (value - self.start)).clamp(self.lower, self.upper)
    }
}

/// The wall under a hypothesis, and the share of the reversed record that a placebo shakes it with upwards.
#[derive(Debug, Clone)]
pub struct Physics {
    /// The wall with its effects.
    pub wall: Wall,
    /// Placebo.
    pub reversed_ratio: f64,
}

/// A wall, what is uncertain of it, and what is added to it.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    base: WallParameters,
    /// What is added.
    pub additions: Vec<Addition>,
    /// Every number to be found: the uncertain ones of the wall first.
    pub unknowns: Vec<Unknown>,
    /// How many of them are the wall's.
    pub nuisances: usize,
}

impl Hypothesis {
    /// The wall with these uncertainties and additions.
    pub fn new(
        base: &WallParameters,
        scales: &Scales,
        nuisances: &[Nuisance],
        additions: &[Addition],
    ) -> Self {
        // A number that an addition sets free has no prior.
        let freed = |n: &&Nuisance| match n {
            Nuisance::Number(number, _) => !additions.contains(&Addition::Number(number)),
            Nuisance::Coefficient(..) => !additions.iter().any(|a| a.kind() == Some("impact_dissipation")),
        };
        let mut unknowns = nuisances.iter().filter(freed).map(|n| known(base, n)).collect::<Vec<_>>();
        let count = unknowns.len();
        for (index, addition) in additions.iter().enumerate() {
            unknowns.extend(addition.unknowns(base, scales, index));
        }
        Self { base: base.clone(), additions: additions.to_vec(), unknowns, nuisances: count }
    }

    /// Where the search starts.
    pub fn start(&self) -> Vec<f64> {
        self.unknowns.iter().map(|u| u.start).collect()
    }

    /// The values of another hypothesis for the numbers that both have, and the start for the rest.
    pub fn values_from(&self, other: &Self, values: &[f64]) -> Vec<f64> {
        let of = |unknown: &Unknown| {
            let same = |(theirs, _): &(&Unknown, &f64)| match (unknown.slot, theirs.slot) {
                (Slot::Added(own, i), Slot::Added(index, j)) => {
                    i == j && self.additions[own] == other.additions[index]
                }
                (own, theirs) => own == theirs,
            };
            other.unknowns.iter().zip(values).find(same).map_or(unknown.start, |(_, value)| *value)
        };
        self.unknowns.iter().map(of).collect()
    }

    /// Sum of the squared distances from what was known, in its standard deviations.
    pub fn prior_penalty(&self, values: &[f64]) -> f64 {
        let distance = |(u, v): (&Unknown, &f64)| u.prior_sd.map_or(0.0, |sd| ((v - u.start) / sd).powi(2));
        self.unknowns.iter().zip(values).map(distance).sum()
    }

    /// Adds what was known before to normal equations in these values, as one more measurement; further rows of `a` and `g`
    /// stay as they are.
    pub fn add_prior(&self, values: &[f64], a: &mut DMatrix<f64>, g: &mut DVector<f64>) {
        for (i, unknown) in self.unknowns.iter().enumerate() {
            if let Some(sd) = unknown.prior_sd {
                a[(i, i)] += 1.0 / (sd * sd);
                g[i] += (values[i] - unknown.start) / (sd * sd);
            }
        }
    }

    /// The effects that the additions with these values are, for the wall file; none if one is outside its bounds.
    pub fn effects(&self, values: &[f64]) -> Option<Vec<Effect>> {
        let mut effects = Vec::new();
        for (index, addition) in self.additions.iter().enumerate() {
            match addition {
                Addition::Effect(variant) => {
                    effects.push(variant.with_parameters(&self.parameters(*variant, index, values)).ok()?);
                }
                Addition::LumpedCarriage => {
                    let mass_kg = self.added(index, 0, values)?;
                    effects.push(Effect::with_parameters("carriage_mass", &[mass_kg]).ok()?);
                }
                Addition::Number(_) | Addition::Placebo => {}
            }
        }
        Some(effects)
    }

    /// The wall these values make; none if there is no such wall.
    pub fn physics(&self, values: &[f64]) -> Option<Physics> {
        let parameters = self.parameters_of_wall(values)?;
        let placebo = self.additions.iter().position(|a| *a == Addition::Placebo);
        let reversed_ratio = placebo.and_then(|index| self.added(index, 0, values)).unwrap_or(0.0);
        Some(Physics { wall: Wall::new(parameters).ok()?, reversed_ratio })
    }

    /// The parameters of the wall these values make; none if an effect is outside its bounds.
    pub fn parameters_of_wall(&self, values: &[f64]) -> Option<WallParameters> {
        let mut p = self.base.clone();
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            match unknown.slot {
                Slot::Number(number) => (number.set)(&mut p, value),
                Slot::Coefficient(l) => p.restitution.coefficients[l] = value,
                Slot::Added(index, _) => match self.additions[index] {
                    Addition::Number(number) => (number.set)(&mut p, value),
                    Addition::LumpedCarriage => p.diaphragm_mass_kg -= value,
                    _ => {}
                },
            }
        }
        p.effects.extend(self.effects(values)?);
        Some(p)
    }

    fn added(&self, index: usize, parameter: usize, values: &[f64]) -> Option<f64> {
        let slot = Slot::Added(index, parameter);
        self.unknowns.iter().zip(values).find(|(u, _)| u.slot == slot).map(|(_, v)| *v)
    }

    fn parameters(&self, variant: EffectVariant, index: usize, values: &[f64]) -> Vec<f64> {
        let parameters = variant.kind.parameters.iter().enumerate();
        parameters.map(|(i, p)| self.added(index, i, values).unwrap_or(neutral(p.key))).collect()
    }
}

fn known(base: &WallParameters, nuisance: &Nuisance) -> Unknown {
    let (key, unit, value, relative, slot) = match *nuisance {
        Nuisance::Number(number, sd) => {
            (number.key.to_owned(), number.unit, (number.get)(base), sd, Slot::Number(number))
        }
        Nuisance::Coefficient(l, sd) => {
            let value = base.restitution.coefficients[l];
            (format!("C_{}", l + 1), "", value, sd, Slot::Coefficient(l))
        }
    };
    let sd = relative * value.abs();
    let reach = PRIOR_REACH * sd;
    // A prior as wide as the value itself does not reach what no wall has.
    let lower = if value > 0.0 { (value - reach).max(0.02 * value) } else { value - reach };
    Unknown {
        key,
        unit,
        start: value,
        scale: value.abs(),
        lower,
        upper: value + reach,
        prior_sd: Some(sd),
        slot,
    }
}

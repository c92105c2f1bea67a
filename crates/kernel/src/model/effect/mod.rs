//! Further effects: named additions to the model, each with its place, parameters, units and bounds.
//!
//! The wall is the model of the paper; an effect adds one physical law to it without touching the rest.
//! The carriage mass is the paper's own example of an effect that the first model lacked. Each kind is one entry of the
//! catalogue, in the file of the place where it acts; what all effects of a wall come to is one [`EffectSums`].

use std::fmt;

mod at_impacts;
mod at_joints;
mod at_top;
mod catalogue;
mod check;
mod in_ground;
mod in_sensor;
mod sums;
mod toml_form;

pub use catalogue::{EffectChoice, EffectKind, EffectParameter, EffectVariant, Place};
pub(super) use check::check;
pub use sums::Reading;
pub(crate) use sums::{EffectSums, GroundChange, Yielding};

/// Parameters of the kind that has most: one a coefficient of Table 2.
const MOST_PARAMETERS: usize = 8;

/// One further effect, as written in the `[[effects]]` of a wall file; its values are within their bounds.
#[derive(Clone, Copy)]
pub struct Effect {
    variant: EffectVariant,
    values: [f64; MOST_PARAMETERS],
}

/// Why there is no such effect.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EffectError {
    /// No kind of this name.
    #[error("unknown effect kind `{found}`, expected one of {}", names())]
    UnknownKind {
        /// What was given.
        found: String,
    },
    /// A choice that is not given, or that there is not.
    #[error("{found} for `{key}` of {kind}, expected one of {}", listed(options.iter()))]
    Choice {
        /// The kind.
        kind: &'static str,
        /// The key of the choice.
        key: &'static str,
        /// What was given.
        found: String,
        /// What there is.
        options: &'static [&'static str],
    },
    /// A key the kind does not have, or a key of the kind that is not given.
    #[error("{found} of {kind}, expected {allowed}")]
    Keys {
        /// The kind.
        kind: &'static str,
        /// What was given.
        found: String,
        /// What there is.
        allowed: String,
    },
    /// A value outside the bounds of its parameter.
    #[error("{value} for `{key}` of {kind}, expected {} to {} {}", allowed.least, allowed.most, allowed.unit)]
    Bounds {
        /// The kind.
        kind: &'static str,
        /// The key of the parameter.
        key: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        allowed: &'static EffectParameter,
    },
}

fn listed<'a>(names: impl Iterator<Item = &'a &'static str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn names() -> String {
    listed(Effect::kinds().iter().map(|kind| &kind.name))
}

impl Effect {
    /// The catalogue: every kind of effect.
    pub fn kinds() -> &'static [EffectKind] {
        &catalogue::KINDS
    }

    /// A kind by the name it has in wall files.
    ///
    /// # Errors
    /// [`EffectError::UnknownKind`], with the names there are.
    pub fn kind_named(name: &str) -> Result<&'static EffectKind, EffectError> {
        let found = Self::kinds().iter().find(|kind| kind.name == name);
        found.ok_or_else(|| EffectError::UnknownKind { found: name.to_owned() })
    }

    /// An effect with the values of its parameters in the order of [`EffectKind::parameters`]; the name is that of a
    /// kind, followed by a dot and the choice where the kind has one ([`EffectVariant::name`]): `joint_damping.crack`.
    ///
    /// # Errors
    /// A kind or choice there is not; not as many values as parameters; a value outside its bounds.
    pub fn with_parameters(name: &str, values: &[f64]) -> Result<Self, EffectError> {
        let (kind, choice) = match name.split_once('.') {
            Some((kind, choice)) => (kind, Some(choice)),
            None => (name, None),
        };
        Self::kind_named(kind)?.variant(choice)?.with_parameters(values)
    }

    /// The entry of the catalogue.
    pub fn kind(&self) -> &'static EffectKind {
        self.variant.kind
    }

    /// The kind together with the choice made of it.
    pub fn variant(&self) -> EffectVariant {
        self.variant
    }

    /// The values of the parameters, in the order of [`EffectKind::parameters`].
    pub fn parameters(&self) -> Vec<f64> {
        self.values().to_vec()
    }

    fn values(&self) -> &[f64] {
        &self.values[..self.kind().parameters.len()]
    }

    /// The `i`-th parameter.
    fn value(&self, i: usize) -> f64 {
        self.values[i]
    }

    /// Position of the choice among the options of its kind; 0 where there is none.
    fn choice_index(&self) -> usize {
        let chosen =
            |choice: &EffectChoice| choice.options.iter().position(|o| Some(*o) == self.variant.choice);
        self.kind().choice.as_ref().and_then(chosen).unwrap_or(0)
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.variant == other.variant && self.values() == other.values()
    }
}

impl fmt::Debug for Effect {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {:?}", self.variant.name(), self.values())
    }
}

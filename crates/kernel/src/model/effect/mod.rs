//! Further effects: named additions to the model, each with its place, parameters, units and bounds.
//!
//! The wall is the model of the paper; an effect adds one physical law to it without touching the rest.
//! The carriage mass is the paper's own example of an effect that the first model lacked.
//!
//! Each kind is one line of the catalogue and one [`EffectEntry`], which says what it is and holds its law.
//! The effects of a wall are added up in one [`EffectSums`]. A new kind does not compile until its entry is
//! whole; the tests over the catalogue then run it.

use std::fmt;

use mrbd_formula::Formula;

mod catalogue;
mod entry;
mod joint;
mod signal;
mod structural;
mod sums;
mod toml_form;

pub use catalogue::{EffectKind, EffectVariant};
pub use entry::{EffectChoice, EffectEntry, EffectParameter, Lanes, Place, Quantity, Role};
pub(super) use joint::SHARP_PA_PER_M;
pub use sums::Reading;
pub(crate) use sums::{EffectSums, GroundChange, SaidOfJoint, Yielding};
pub(super) use sums::{check, is_joint_law};
pub use toml_form::FurtherLaw;

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
    #[error("{value} for `{key}` of {kind}, expected {} to {} {}", allowed.least, allowed.most, allowed.unit())]
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
    listed(EffectKind::ALL.iter().map(|kind| &kind.entry().name).chain([&Formula::KIND]))
}

impl Effect {
    /// An effect with the values of its parameters in the order of [`EffectEntry::parameters`].
    ///
    /// The name is that of a kind, with a dot and the choice where the kind has one: `joint_damping.crack`
    /// ([`EffectVariant::name`]).
    ///
    /// # Errors
    /// A kind or choice there is not; not as many values as parameters; a value outside its bounds.
    pub fn with_parameters(name: &str, values: &[f64]) -> Result<Self, EffectError> {
        let (kind, choice) = match name.split_once('.') {
            Some((kind, choice)) => (kind, Some(choice)),
            None => (name, None),
        };
        EffectKind::named(kind)?.variant(choice)?.with_parameters(values)
    }

    /// Its kind.
    pub fn kind(&self) -> EffectKind {
        self.variant.kind
    }

    /// What the catalogue says of its kind.
    pub fn entry(&self) -> &'static EffectEntry {
        self.variant.entry()
    }

    /// The kind together with the choice made of it.
    pub fn variant(&self) -> EffectVariant {
        self.variant
    }

    /// The values of the parameters, in the order of [`EffectEntry::parameters`].
    pub fn parameters(&self) -> Vec<f64> {
        self.values().to_vec()
    }

    /// Whether it does nothing: all its values are the neutral ones of the catalogue.
    pub fn is_neutral(&self) -> bool {
        *self == self.variant.neutral()
    }

    fn values(&self) -> &[f64] {
        &self.values[..self.entry().parameters.len()]
    }

    /// The `i`-th parameter.
    fn value(&self, i: usize) -> f64 {
        self.values[i]
    }

    /// Position of the choice among the options of its kind; 0 for a kind without a choice.
    fn choice_index(&self) -> usize {
        self.variant.choice_index()
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

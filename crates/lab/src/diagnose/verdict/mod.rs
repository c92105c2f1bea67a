//! From fitted hypotheses to a verdict.

mod amplitude;
mod judge;
mod names;
mod other_law;
mod place;
mod power;
mod second;

pub use amplitude::Trend;
pub use judge::{Found, judge};
pub use names::names;
pub use other_law::OtherLaw;
pub use power::power;

use serde::{Deserialize, Serialize};

/// The answer of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No gap between model and measurement beyond the noise.
    None,
    /// The gap closes within what was known of the wall.
    Recalibrated,
    /// One effect, or two, and nothing else in the catalogue.
    Named,
    /// Several that these data cannot tell apart.
    Class,
    /// A place where a force is missing, by a law that is not in the catalogue.
    PlaceOnly,
    /// A gap, and no more is known.
    Unknown,
    /// The tests could not show an effect of a size that matters.
    NoPower,
}

impl Verdict {
    /// Its name in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Recalibrated => "recalibrated",
            Self::Named => "named",
            Self::Class => "class",
            Self::PlaceOnly => "place_only",
            Self::Unknown => "unknown",
            Self::NoPower => "no_power",
        }
    }
}

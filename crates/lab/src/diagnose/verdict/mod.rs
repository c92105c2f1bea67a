//! From fitted hypotheses to a verdict.
//!
//! | module | idea |
//! | --- | --- |
//! | `judge` | nothing missing, the wall's own numbers, one effect, two, or a place |
//! | `within_the_wall` | a gap that the wall's own numbers close |
//! | `found` | the verdict, and what it rests on |
//! | `worth_naming` | whether tests could show an effect, whether a second one shows, and where a force is missing |
//! | `at_impacts` | what is left at impacts, where formulations of a contact part |
//! | `remainder` | a name that leaves more than noise |
//! | `on_beds` | joints that give, where windows ask for them |
//! | `held` | what a strip whose top is held cannot tell from joints that give |
//! | `beds_beside` | the same beside an effect that is not enough on sharp edges |
//! | `outside` | laws outside the catalogue, a curve, or a place |
//! | `shows` | laws outside the catalogue that show where effects say little or nothing |
//! | `other_law` | whether a law outside the catalogue is behind a name |

mod at_impacts;
mod beds_beside;
mod found;
mod held;
mod judge;
mod on_beds;
mod other_law;
mod outside;
mod remainder;
mod shows;
mod within_the_wall;
mod worth_naming;

use super::hypothesis::{Addition, WallNumber};
use super::trials::{FittedHypothesis, kind_of};
pub use found::Found;
pub use judge::{judge, judge_laws, judge_laws_beyond};
pub use on_beds::{beside_beds, on_beds};
pub use other_law::{OtherLaw, Trend};
pub use remainder::{NextRival, Remainder, model_error_rad};
use serde::{Deserialize, Serialize};
pub use worth_naming::{leaves_noise, power, stands_out_held_out};

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
    /// A law outside the catalogue, found as a formula.
    Formula,
    /// Several such laws that these data cannot tell apart.
    FormulaClass,
    /// A force at the top that no formula holds for, as a curve of displacement and one of velocity.
    Curve,
    /// A place where a force is missing, by a law that is not in the catalogue.
    PlaceOnly,
    /// A gap, and no more is known.
    Unknown,
    /// The tests could not show an effect of a size that matters.
    NoPower,
}

impl Verdict {
    /// Whether it gives a law outside the catalogue as a formula.
    pub fn is_formula(self) -> bool {
        matches!(self, Self::Formula | Self::FormulaClass)
    }

    /// Whether something is missing of which no effect and no law is told.
    pub fn is_left_open(self) -> bool {
        matches!(self, Self::PlaceOnly | Self::Unknown | Self::Curve)
    }

    /// Its name in `diagnosis.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Recalibrated => "recalibrated",
            Self::Named => "named",
            Self::Class => "class",
            Self::Formula => "formula",
            Self::FormulaClass => "formula_class",
            Self::Curve => "curve",
            Self::PlaceOnly => "place_only",
            Self::Unknown => "unknown",
            Self::NoPower => "no_power",
        }
    }
}

/// Names by which equivalent hypotheses go in answers: kinds, and last words of keys of the wall.
pub fn names(tried: &FittedHypothesis) -> Vec<String> {
    let h = &tried.hypothesis;
    let name = |(index, addition): (usize, &Addition)| match addition {
        Addition::Number(number) => name_of_number(number),
        addition => kind_of(h, &tried.fit.values, index)
            .map_or_else(|| addition.name(), |kind| kind.name().to_owned()),
    };
    h.additions.iter().enumerate().map(name).collect()
}

/// Names of the best and of others that cannot be told from it, each once.
fn names_of_all<'t>(
    best: &FittedHypothesis,
    others: impl IntoIterator<Item = &'t FittedHypothesis>,
) -> Vec<String> {
    let mut all = Vec::new();
    for name in names(best).into_iter().chain(others.into_iter().flat_map(names)) {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// Last word of the key of a number of the wall, without its unit.
pub fn name_of_number(number: &WallNumber) -> String {
    let last = number.key.rsplit('.').next().unwrap_or(number.key);
    last.trim_end_matches("_n_per_m").trim_end_matches("_kg").trim_end_matches("_m").to_owned()
}

//! Units of acceleration that record files come in.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use mrbd_kernel::model::G_M_S2;

/// A unit of acceleration; inside the program everything is m/s².
///
/// One g is [`G_M_S2`], the same as the weight of the walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Unit {
    /// m/s².
    MetrePerSecond2,
    /// Acceleration of gravity.
    G,
    /// cm/s², also called gal.
    CentimetrePerSecond2,
    /// mm/s².
    MillimetrePerSecond2,
}

/// What may be written for a unit.
pub(crate) const UNIT_NAMES: &str = "\"m/s2\", \"g\", \"cm/s2\" (or \"gal\") or \"mm/s2\"";

impl Unit {
    /// Metres per second squared in one of this unit.
    pub fn m_s2(self) -> f64 {
        match self {
            Unit::MetrePerSecond2 => 1.0,
            Unit::G => G_M_S2,
            Unit::CentimetrePerSecond2 => 1e-2,
            Unit::MillimetrePerSecond2 => 1e-3,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Unit::MetrePerSecond2 => "m/s2",
            Unit::G => "g",
            Unit::CentimetrePerSecond2 => "cm/s2",
            Unit::MillimetrePerSecond2 => "mm/s2",
        })
    }
}

/// A word that is no unit of acceleration known here.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unit `{0}`, expected {UNIT_NAMES}")]
pub struct UnknownUnit(String);

impl FromStr for Unit {
    type Err = UnknownUnit;

    /// Reads the spellings of suites and of the headers of record files.
    fn from_str(text: &str) -> Result<Self, UnknownUnit> {
        let plain = text.trim().to_lowercase().replace("sec", "s").replace("**", "").replace('^', "");
        match plain.trim_end_matches(['.', ',']) {
            "m/s2" | "m/s/s" => Ok(Unit::MetrePerSecond2),
            "g" => Ok(Unit::G),
            "cm/s2" | "cm/s/s" | "gal" => Ok(Unit::CentimetrePerSecond2),
            "mm/s2" | "mm/s/s" => Ok(Unit::MillimetrePerSecond2),
            _ => Err(UnknownUnit(text.chars().take(40).collect())),
        }
    }
}

impl TryFrom<String> for Unit {
    type Error = UnknownUnit;

    fn try_from(text: String) -> Result<Self, UnknownUnit> {
        text.parse()
    }
}

impl From<Unit> for String {
    fn from(unit: Unit) -> Self {
        unit.to_string()
    }
}

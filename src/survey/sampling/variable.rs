//! The quantities of a façade that vary (the source's Table 3).

use serde::{Deserialize, Serialize};

use crate::survey::{Configuration, Survey, ThreeLevels};

/// A quantity of a façade that varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Variable {
    /// Thickness b, m.
    #[serde(rename = "thickness_m")]
    Thickness,
    /// Slenderness h_tot / b.
    #[serde(rename = "slenderness")]
    Slenderness,
    /// Height of the crack h_1 / h_tot.
    #[serde(rename = "crack_height_ratio")]
    CrackHeight,
    /// Compressive strength f, Pa.
    #[serde(rename = "compressive_strength_pa")]
    Strength,
    /// Stiffness of the floor k_d, N/m.
    #[serde(rename = "stiffness_n_per_m")]
    Stiffness,
    /// Floor mass m_d / m_tot.
    #[serde(rename = "diaphragm_mass_ratio")]
    DiaphragmMass,
    /// Floor mass m_dp / m_tot.
    #[serde(rename = "carriage_mass_ratio")]
    CarriageMass,
}

impl Variable {
    /// All; the position decides the random numbers of a variable, so new ones go to the end.
    pub const ALL: [Variable; 7] = [
        Variable::Thickness,
        Variable::Slenderness,
        Variable::CrackHeight,
        Variable::Strength,
        Variable::Stiffness,
        Variable::DiaphragmMass,
        Variable::CarriageMass,
    ];

    /// Name in input and result files; the unit stands in it.
    pub fn name(self) -> &'static str {
        match self {
            Variable::Thickness => "thickness_m",
            Variable::Slenderness => "slenderness",
            Variable::CrackHeight => "crack_height_ratio",
            Variable::Strength => "compressive_strength_pa",
            Variable::Stiffness => "stiffness_n_per_m",
            Variable::DiaphragmMass => "diaphragm_mass_ratio",
            Variable::CarriageMass => "carriage_mass_ratio",
        }
    }

    /// Its three levels in a survey.
    pub(super) fn levels(self, survey: &Survey, configuration: Configuration) -> ThreeLevels {
        let (wall, floor) = (&survey.wall, survey.floor(configuration));
        match self {
            Variable::Thickness => wall.thickness_m,
            Variable::Slenderness => wall.slenderness,
            Variable::CrackHeight => wall.crack_height_ratio,
            Variable::Strength => wall.compressive_strength_pa,
            Variable::Stiffness => floor.stiffness_n_per_m,
            Variable::DiaphragmMass => floor.diaphragm_mass_ratio,
            Variable::CarriageMass => floor.carriage_mass_ratio,
        }
    }

    /// Key of the survey the levels stand under.
    pub(super) fn key(self, configuration: Configuration) -> String {
        let table = match self {
            Variable::Thickness | Variable::Slenderness | Variable::CrackHeight | Variable::Strength => {
                "wall"
            }
            _ => configuration.name(),
        };
        format!("{table}.{}", self.name())
    }

    /// Values a façade can have: above 0 or from 0, and for ratios below 1.
    pub(super) fn possible(self, value: f64) -> bool {
        match self {
            Variable::Thickness | Variable::Slenderness | Variable::Strength => value > 0.0,
            Variable::CrackHeight => value > 0.0 && value < 1.0,
            Variable::Stiffness => value >= 0.0,
            Variable::DiaphragmMass | Variable::CarriageMass => (0.0..1.0).contains(&value),
        }
    }
}

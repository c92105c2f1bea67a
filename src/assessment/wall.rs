//! The assessment of a wall at a site, as a folder of results keeps it.

use serde::{Deserialize, Serialize};

use mrbd_assessment::Assessment;
use mrbd_kernel::model::{FurtherLaw, Wall};
use mrbd_records::{COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Site, Suite, SuiteCheck};

/// What a manifest says such results are.
pub const KIND: &str = "assessment";

/// What is written beside the page; the last only where there are records.
pub const FILES: [&str; 3] = ["manifest.json", "assessment.json", "governing_run.csv"];

/// Language of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// English.
    #[default]
    En,
    /// Italian.
    It,
}

impl Language {
    /// Its code.
    pub fn code(self) -> &'static str {
        match self {
            Language::En => "en",
            Language::It => "it",
        }
    }
}

/// An assessment with the wall it is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Assessed {
    /// The wall.
    pub wall: WallNumbers,
    /// Mechanisms, capacity, checks.
    #[serde(flatten)]
    pub assessment: Assessment,
    /// The suite, where there are records.
    pub suite: Option<SuiteNote>,
    /// Another wall at the same site, or this one with other springs.
    pub compared: Option<Compared>,
    /// Language of the page.
    pub language: Language,
}

/// Another wall, assessed in the same way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// The wall.
    pub wall: WallNumbers,
    /// Its assessment.
    #[serde(flatten)]
    pub assessment: Assessment,
}

/// What of a wall a page shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WallNumbers {
    /// Name of its file.
    pub name: String,
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Height h, m.
    pub height_m: f64,
    /// Height of the crack h_1, m.
    pub crack_height_m: Option<f64>,
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Widths b_1, b_2 between the rocking corners, m.
    pub width_m: [f64; 2],
    /// Mass m, kg.
    pub mass_kg: f64,
    /// m_d, kg.
    pub diaphragm_mass_kg: f64,
    /// m_dp, kg.
    pub carriage_mass_kg: f64,
    /// k_d, N/m.
    pub stiffness_n_per_m: f64,
    /// e_C, m.
    pub eccentricity_m: f64,
    /// Effects by their names.
    pub effects: Vec<String>,
}

impl WallNumbers {
    /// Of a wall with the name of its file.
    pub fn of(name: &str, wall: &Wall) -> Self {
        let p = wall.parameters();
        Self {
            name: name.to_owned(),
            thickness_m: p.thickness_m,
            height_m: p.height_m,
            crack_height_m: p.crack_height_m,
            length_m: p.length_m,
            width_m: wall.width_m(),
            mass_kg: p.mass_kg,
            diaphragm_mass_kg: p.diaphragm_mass_kg,
            carriage_mass_kg: p.carriage_mass_kg,
            stiffness_n_per_m: p.stiffness_n_per_m,
            eccentricity_m: p.eccentricity_m,
            effects: p.further_laws().iter().map(FurtherLaw::to_string).collect(),
        }
    }
}

/// A suite, and how its mean spectrum stands to the site's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SuiteNote {
    /// Its name.
    pub name: String,
    /// Whether its records are generated.
    pub generated: bool,
    /// Least and greatest of mean over code less one, at the ground, over the periods of compatibility.
    pub deviation: [f64; 2],
    /// Whether that is within -10 % and +30 %.
    pub compatible: bool,
}

impl SuiteNote {
    /// Of a suite at a site.
    pub fn of(suite: &Suite, site: &Site) -> Self {
        let check = SuiteCheck::of(suite, site, COMPATIBLE_PERIODS_S);
        Self {
            name: suite.name.clone(),
            generated: suite.generated,
            deviation: [check.lowest_deviation, check.highest_deviation],
            compatible: check.is_within(COMPATIBLE_DEVIATION),
        }
    }
}

//! The survey: what is known of the façades, as three values of every log-normal parameter.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use mrbd_files::toml_file;

/// A parameter at μ − σ, μ and μ + σ of its log-normal distribution, in that order.
pub type ThreeLevels = [f64; 3];

/// How the beams of the floor run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Configuration {
    /// The beams rest on the façade: the floor's mass acts vertically and horizontally.
    Perpendicular,
    /// The beams run along the façade: most of the floor's mass acts horizontally only.
    Parallel,
}

impl Configuration {
    /// Both, in the order of the source's tables.
    pub const ALL: [Configuration; 2] = [Configuration::Perpendicular, Configuration::Parallel];

    /// Name in input and result files.
    pub fn name(self) -> &'static str {
        match self {
            Configuration::Perpendicular => "perpendicular",
            Configuration::Parallel => "parallel",
        }
    }
}

/// The wall of the façades, whichever way the floor runs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallSurvey {
    /// Thickness b, m.
    pub thickness_m: ThreeLevels,
    /// Slenderness h_tot / b.
    pub slenderness: ThreeLevels,
    /// Height of the crack h_1 / h_tot; the source gives the higher one at μ − σ.
    pub crack_height_ratio: ThreeLevels,
    /// Compressive strength of the masonry f, Pa.
    pub compressive_strength_pa: ThreeLevels,
}

/// The floor of one configuration.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FloorSurvey {
    /// Stiffness k_d, N/m.
    pub stiffness_n_per_m: ThreeLevels,
    /// m_d / m_tot.
    pub diaphragm_mass_ratio: ThreeLevels,
    /// m_dp / m_tot.
    pub carriage_mass_ratio: ThreeLevels,
}

/// Log-normal parameters of the façades and of their floors.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Survey {
    /// Where the numbers come from.
    pub source: String,
    /// The wall.
    pub wall: WallSurvey,
    /// The floor whose beams rest on the façade.
    pub perpendicular: FloorSurvey,
    /// The floor whose beams run along the façade.
    pub parallel: FloorSurvey,
}

impl Survey {
    /// Reads and checks a survey file.
    ///
    /// # Errors
    /// Input errors that name the file, the key, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, &toml_file::read(path)?)
    }

    /// Checks the text of a survey file that came from `path`.
    ///
    /// # Errors
    /// As [`Survey::load`].
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let survey: Self = toml_file::parse(path, text)?;
        survey.check(path)?;
        Ok(survey)
    }

    /// The floor of a configuration.
    pub fn floor(&self, configuration: Configuration) -> &FloorSurvey {
        match configuration {
            Configuration::Perpendicular => &self.perpendicular,
            Configuration::Parallel => &self.parallel,
        }
    }

    fn check(&self, path: &Path) -> Result<()> {
        let above_0 = |x: f64| x > 0.0;
        let ratio = |x: f64| (0.0..1.0).contains(&x);
        let wall = &self.wall;
        levels(path, "wall.thickness_m", wall.thickness_m, above_0, "above 0")?;
        levels(path, "wall.slenderness", wall.slenderness, above_0, "above 0")?;
        let crack = |x: f64| x > 0.0 && x < 1.0;
        levels(path, "wall.crack_height_ratio", wall.crack_height_ratio, crack, "above 0 and below 1")?;
        levels(path, "wall.compressive_strength_pa", wall.compressive_strength_pa, above_0, "above 0")?;
        for configuration in Configuration::ALL {
            let (floor, name) = (self.floor(configuration), configuration.name());
            let key = |key: &str| format!("{name}.{key}");
            levels(path, &key("stiffness_n_per_m"), floor.stiffness_n_per_m, |x| x >= 0.0, "0 or more")?;
            let (at, allowed) = (key("diaphragm_mass_ratio"), "0 or more and below 1");
            levels(path, &at, floor.diaphragm_mass_ratio, ratio, allowed)?;
            levels(path, &key("carriage_mass_ratio"), floor.carriage_mass_ratio, ratio, allowed)?;
        }
        Ok(())
    }
}

fn levels(
    path: &Path,
    key: &str,
    values: ThreeLevels,
    valid: impl Fn(f64) -> bool,
    allowed: &str,
) -> Result<()> {
    match values.into_iter().find(|&x| !(x.is_finite() && valid(x))) {
        Some(wrong) => {
            Err(InputError::key(path, key, wrong.to_string(), format!("finite numbers, {allowed}")).into())
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE_3: &str = include_str!("../../inputs/survey.toml");

    #[test]
    fn published_table_3_is_read_with_its_reversed_crack_heights() {
        let survey = Survey::parse(Path::new("survey.toml"), TABLE_3).expect("the repository's own survey");
        assert_eq!(survey.wall.crack_height_ratio, [0.73, 0.62, 0.52]);
        assert_eq!(survey.floor(Configuration::Parallel).carriage_mass_ratio, [0.06, 0.14, 0.27]);
        assert_eq!(survey.floor(Configuration::Perpendicular).stiffness_n_per_m, [4e5, 1.4e6, 4.6e6]);
    }

    #[test]
    fn rejects_values_that_cannot_be_with_their_key() {
        let refused = |from: &str, to: &str| {
            let text = TABLE_3.replace(from, to);
            assert_ne!(text, TABLE_3, "the test must change the file");
            Survey::parse(Path::new("s.toml"), &text).expect_err("must be refused").to_string()
        };
        let message = refused("0.73, 0.62", "1.73, 0.62");
        assert!(message.contains("s.toml: wall.crack_height_ratio: found 1.73"), "{message}");
        let message = refused("500e3, 1200e3", "500e3, nan");
        assert!(message.contains("parallel.stiffness_n_per_m: found NaN"), "{message}");
        let message = refused("[9.0, 12.0, 15.0]", "[9.0, 12.0]");
        assert!(message.contains("wall.slenderness"), "{message}");
        let message = refused("[perpendicular]", "[perpendicular]\nbeams = 4");
        assert!(message.contains("beams"), "{message}");
    }
}

//! The site file of an assessment: spectrum, building, confidence, and where each number comes from.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use mrbd_files::error::{InputError, Result};
use mrbd_files::toml_file;
use mrbd_records::{Building, Site};

/// Confidence factors of the code for three levels of knowledge (NTC 2018, C8.5.4).
const CONFIDENCE: [f64; 3] = [1.35, 1.20, 1.00];

/// A site file (TOML), checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteFile {
    /// Name of the site; empty where it has none.
    #[serde(default)]
    pub name: String,
    /// Where its numbers come from.
    #[serde(default)]
    pub source: String,
    /// `[site]`: a_g, F_0, T_C*, soil, topography.
    pub site: Site,
    /// `[building]`: where in a building the wall stands; absent at the ground.
    pub building: Option<Building>,
    /// `[assessment]`: confidence, and what else the check asks for.
    #[serde(default)]
    pub assessment: Assumed,
    /// `[sources]`: where an input comes from, by its key.
    #[serde(default)]
    pub sources: BTreeMap<String, String>,
}

/// `[assessment]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assumed {
    /// FC: 1.35, 1.20 or 1.00 for limited, extended and exhaustive knowledge.
    #[serde(default = "limited")]
    pub confidence_factor: f64,
    /// E of the masonry, Pa: gives T_0 (C8.7.1.7). Absent: a rigid wall, T_0 = 0.
    pub elastic_modulus_pa: Option<f64>,
    /// a_g of the damage limit state, g; absent: its ζ is not told.
    pub ag_sld_g: Option<f64>,
    /// a_g of the limit state of collapse, g; absent: its ζ is not told.
    pub ag_slc_g: Option<f64>,
}

fn limited() -> f64 {
    CONFIDENCE[0]
}

impl Default for Assumed {
    fn default() -> Self {
        Self { confidence_factor: limited(), elastic_modulus_pa: None, ag_sld_g: None, ag_slc_g: None }
    }
}

impl SiteFile {
    /// Reads a site file.
    ///
    /// # Errors
    /// Input errors that name the file and the key.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, &toml_file::read(path)?)
    }

    /// Checks the text of a site file that came from `path`.
    ///
    /// # Errors
    /// As [`SiteFile::load`].
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let file: Self = toml_file::parse(path, text)?;
        file.site.check(path)?;
        if let Some(building) = &file.building {
            building.check(path, "building")?;
        }
        file.assessment.check(path)?;
        Ok(file)
    }

    /// The building, where the wall stands above its foot.
    pub fn floor(&self) -> Option<&Building> {
        self.building.as_ref().filter(|building| building.height_ratio > 0.0)
    }
}

impl Assumed {
    fn check(&self, path: &Path) -> Result<(), InputError> {
        let fc = self.confidence_factor;
        if !CONFIDENCE.contains(&fc) {
            let allowed = "1.35, 1.20 or 1.00: limited, extended or exhaustive knowledge";
            return Err(InputError::key(path, "assessment.confidence_factor", fc.to_string(), allowed));
        }
        for (key, value, [least, most]) in [
            ("elastic_modulus_pa", self.elastic_modulus_pa, [1e7, 1e11]),
            ("ag_sld_g", self.ag_sld_g, [0.001, 2.0]),
            ("ag_slc_g", self.ag_slc_g, [0.001, 2.0]),
        ] {
            let Some(value) = value.filter(|value| !(least..=most).contains(value)) else { continue };
            let allowed = format!("{least} to {most}");
            return Err(InputError::key(path, format!("assessment.{key}"), value.to_string(), allowed));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SITE: &str = "[site]\nag_g = 0.25\nf0 = 2.5\ntc_star_s = 0.3\nsoil = \"A\"\n";

    fn parse(more: &str) -> Result<SiteFile> {
        SiteFile::parse(Path::new("site.toml"), &format!("{SITE}{more}"))
    }

    #[test]
    fn regress_the_fewest_keys_are_the_ground_and_limited_knowledge() {
        let file = parse("").expect("a site");
        assert!(file.floor().is_none() && file.assessment == Assumed::default());
        let file = parse("[building]\nheight_ratio = 0.0\nperiod_s = 0.2\nstoreys = 2\n").expect("a site");
        assert!(file.floor().is_none() && file.building.is_some());
    }

    #[test]
    fn rejects_numbers_that_no_site_has() {
        for (more, parts) in [
            (
                "[assessment]\nconfidence_factor = 1.3\n",
                &["assessment.confidence_factor", "found 1.3", "1.35"][..],
            ),
            ("[assessment]\nelastic_modulus_pa = 1500.0\n", &["assessment.elastic_modulus_pa", "found 1500"]),
            (
                "[building]\nheight_ratio = 1.4\nperiod_s = 0.2\nstoreys = 2\n",
                &["building.height_ratio", "0 to 1"],
            ),
            (
                "[building]\nheight_ratio = 0.5\nperiod_s = 0.2\nstoreys = 0\n",
                &["building.storeys", "found 0"],
            ),
            ("[building]\nheight_ratio = 0.5\nperiod_s = 0.2\n", &["missing field `storeys`"]),
            (
                "[building]\nheight_ratio = 0.5\nperiod_s = 0.2\nstoreys = 2\n\
                 [[building.modes]]\nperiod_s = 0.0\nparticipation = -0.3\n",
                &["building.modes[0].period_s", "found 0"],
            ),
            ("[assesment]\n", &["assesment", "did you mean `assessment`"]),
        ] {
            let told = parse(more).expect_err("must be refused").to_string();
            assert!(parts.iter().all(|part| told.contains(part)), "{parts:?} in: {told}");
        }
    }
}

//! The elastic horizontal spectrum of the Italian building code, and a suite held against it.
//!
//! NTC 2018: Decreto Ministeriale 17 gennaio 2018, "Aggiornamento delle Norme tecniche per le costruzioni",
//! section 3.2.3.2.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::spectrum::{CODE_DAMPING, response_spectrum_m_s2};
use super::{Accelerogram, Suite};
use mrbd_files::error::{InputError, Result};
use mrbd_files::toml_file;
use mrbd_kernel::model::G_M_S2;

/// Class of the ground (NTC 2018, Table 3.2.II).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Soil {
    /// Rock.
    A,
    /// Soft rock, very dense soil.
    B,
    /// Dense to medium soil.
    C,
    /// Loose soil.
    D,
    /// C or D, shallow over rock.
    E,
}

/// Class of the topography (NTC 2018, Table 3.2.III).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Topography {
    /// Flat ground and slopes up to 15°.
    #[default]
    T1,
    /// Slopes above 15°.
    T2,
    /// Crests of slopes of 15° to 30°.
    T3,
    /// Crests of slopes above 30°.
    T4,
}

/// A site and a return period as the code describes them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Site {
    /// a_g: peak acceleration on flat rock, g.
    pub ag_g: f64,
    /// F_0: largest amplification on flat rock.
    pub f0: f64,
    /// T_C*: start of constant velocity on flat rock, s.
    pub tc_star_s: f64,
    /// Class of the ground.
    pub soil: Soil,
    /// Class of the topography.
    #[serde(default)]
    pub topography: Topography,
    /// ξ: damping relative to critical.
    #[serde(default = "code_damping")]
    pub damping: f64,
}

fn code_damping() -> f64 {
    CODE_DAMPING
}

impl Site {
    /// Loads `[site]` of a TOML file, which may carry a `name`, a `source`, and what an assessment needs beside it.
    ///
    /// # Errors
    /// Input errors that name the file and the key.
    pub fn load(path: &Path) -> Result<Self> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct SiteFile {
            #[serde(rename = "name")]
            _name: Option<String>,
            #[serde(rename = "source")]
            _source: Option<String>,
            site: Site,
            #[serde(rename = "building")]
            _building: Option<toml::Table>,
            #[serde(rename = "assessment")]
            _assessment: Option<toml::Table>,
            #[serde(rename = "sources")]
            _sources: Option<toml::Table>,
        }
        let file: SiteFile = toml_file::load(path)?;
        file.site.check(path)?;
        Ok(file.site)
    }

    /// Checks the numbers of `[site]` in a file.
    ///
    /// # Errors
    /// An input error that names file and key.
    pub fn check(&self, path: &Path) -> Result<(), InputError> {
        for (key, value, range) in [
            ("ag_g", self.ag_g, 0.001..=2.0),
            // The code itself bounds F_0 from below (NTC 2018, 3.2.3.2).
            ("f0", self.f0, 2.2..=5.0),
            ("tc_star_s", self.tc_star_s, 0.05..=2.0),
            ("damping", self.damping, 0.005..=0.5),
        ] {
            if !range.contains(&value) {
                let allowed = format!("{} to {}", range.start(), range.end());
                return Err(InputError::key(path, format!("site.{key}"), value.to_string(), allowed));
            }
        }
        Ok(())
    }

    /// S = S_S·S_T (eq. 3.2.3), with S_S of Table 3.2.IV and S_T of Table 3.2.V.
    pub fn amplification(&self) -> f64 {
        let product = self.f0 * self.ag_g;
        let stratigraphic = match self.soil {
            Soil::A => 1.0,
            Soil::B => (1.40 - 0.40 * product).clamp(1.00, 1.20),
            Soil::C => (1.70 - 0.60 * product).clamp(1.00, 1.50),
            Soil::D => (2.40 - 1.50 * product).clamp(0.90, 1.80),
            Soil::E => (2.00 - 1.10 * product).clamp(1.00, 1.60),
        };
        let topographic = match self.topography {
            Topography::T1 => 1.0,
            Topography::T2 | Topography::T3 => 1.2,
            Topography::T4 => 1.4,
        };
        stratigraphic * topographic
    }

    /// T_C = C_C·T_C* (eq. 3.2.5), s, with C_C of Table 3.2.IV.
    pub fn tc_s(&self) -> f64 {
        let (factor, power) = match self.soil {
            Soil::A => (1.0, 0.0),
            Soil::B => (1.10, -0.20),
            Soil::C => (1.05, -0.33),
            Soil::D => (1.25, -0.50),
            Soil::E => (1.15, -0.40),
        };
        factor * self.tc_star_s.powf(power) * self.tc_star_s
    }

    /// T_B = T_C/3 (eq. 3.2.6), s.
    pub fn tb_s(&self) -> f64 {
        self.tc_s() / 3.0
    }

    /// T_D = 4.0·a_g/g + 1.6 (eq. 3.2.7), s.
    pub fn td_s(&self) -> f64 {
        4.0 * self.ag_g + 1.6
    }

    /// η = √(10/(5+ξ)) ≥ 0.55, ξ in percent (eq. 3.2.4).
    pub fn damping_factor(&self) -> f64 {
        (10.0 / (5.0 + 100.0 * self.damping)).sqrt().max(0.55)
    }

    /// S_De(T) (3.2.3.2.3), m, for a period in seconds: S_e T²/4π² up to T_E, then ever nearer to the ground's own
    /// displacement d_g = 0.025 a_g S T_C T_D, which it has from T_F on.
    pub fn displacement_m(&self, period_s: f64) -> f64 {
        let t_e = match self.soil {
            Soil::A => 4.5,
            Soil::B => 5.0,
            Soil::C | Soil::D | Soil::E => 6.0,
        };
        let t_f = 10.0;
        if period_s <= t_e {
            return self.elastic_m_s2(period_s) * (period_s / std::f64::consts::TAU).powi(2);
        }
        let ground_m = 0.025 * self.ag_g * G_M_S2 * self.amplification() * self.tc_s() * self.td_s();
        let raised = self.f0 * self.damping_factor();
        let beyond = ((period_s - t_e) / (t_f - t_e)).min(1.0);
        ground_m * (raised + (1.0 - raised) * beyond)
    }

    /// S_e(T) (eq. 3.2.2), m/s², for a period in seconds.
    pub fn elastic_m_s2(&self, period_s: f64) -> f64 {
        let (tb, tc, td) = (self.tb_s(), self.tc_s(), self.td_s());
        let eta_f0 = self.damping_factor() * self.f0;
        let shape = if period_s < tb {
            period_s / tb + (1.0 - period_s / tb) / eta_f0
        } else if period_s < tc {
            1.0
        } else if period_s < td {
            tc / period_s
        } else {
            tc * td / (period_s * period_s)
        };
        self.ag_g * G_M_S2 * self.amplification() * eta_f0 * shape
    }
}

/// Periods over which the suite of the paper is compatible with the code (its section 4.1), s.
pub const COMPATIBLE_PERIODS_S: (f64, f64) = (0.15, 2.0);
/// How far below and above the code a mean spectrum may lie, relative.
pub const COMPATIBLE_DEVIATION: (f64, f64) = (-0.10, 0.30);

/// Spacing of the periods at which spectra are compared, s: peaks of a mean spectrum are some hundredths wide.
const PERIOD_STEP_S: f64 = 0.01;

/// The mean spectrum of a suite against the code.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuiteCheck {
    /// Periods, s.
    pub period_s: Vec<f64>,
    /// Code spectrum, m/s².
    pub code_m_s2: Vec<f64>,
    /// Mean of the scaled records, m/s².
    pub mean_m_s2: Vec<f64>,
    /// Smallest of mean/code − 1.
    pub lowest_deviation: f64,
    /// Largest of mean/code − 1.
    pub highest_deviation: f64,
}

impl SuiteCheck {
    /// Compares the mean of spectra of scaled records with the code, over periods from `low_s` to `high_s`.
    pub fn of(suite: &Suite, site: &Site, (low_s, high_s): (f64, f64)) -> Self {
        let period_s = periods_s(low_s, high_s);
        let records: Vec<&Accelerogram> = suite.records.iter().map(|r| &r.horizontal).collect();
        let spectra = records.iter().map(|r| response_spectrum_m_s2(r, &period_s, site.damping));
        let mut mean_m_s2 = vec![0.0; period_s.len()];
        for spectrum in spectra {
            for (mean, value) in mean_m_s2.iter_mut().zip(spectrum) {
                *mean += value / records.len() as f64;
            }
        }
        let code_m_s2: Vec<f64> = period_s.iter().map(|&period| site.elastic_m_s2(period)).collect();
        let (lowest_deviation, highest_deviation) = deviation_range(&mean_m_s2, &code_m_s2);
        Self { period_s, code_m_s2, mean_m_s2, lowest_deviation, highest_deviation }
    }

    /// Whether the mean stays within the bounds, given as relative deviations below and above.
    pub fn is_within(&self, (lowest, highest): (f64, f64)) -> bool {
        self.lowest_deviation >= lowest && self.highest_deviation <= highest
    }
}

/// Least and greatest of value/reference − 1.
pub(crate) fn deviation_range(values: &[f64], references: &[f64]) -> (f64, f64) {
    let deviations = values.iter().zip(references).map(|(value, reference)| value / reference - 1.0);
    deviations.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)))
}

/// Periods from `low_s` to `high_s`, 0.01 s apart, s.
pub(crate) fn periods_s(low_s: f64, high_s: f64) -> Vec<f64> {
    let steps = ((high_s - low_s) / PERIOD_STEP_S).round().max(0.0) as usize;
    (0..=steps).map(|i| low_s + i as f64 * PERIOD_STEP_S).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIRANDOLA: Site = Site {
        ag_g: 0.14,
        f0: 2.588,
        tc_star_s: 0.269,
        soil: Soil::C,
        topography: Topography::T1,
        damping: 0.05,
    };

    #[test]
    fn published_corner_periods_of_mirandola() {
        // Values rounded to three digits, hence half of the last.
        assert!((MIRANDOLA.amplification() - 1.483).abs() < 5e-4);
        assert!((MIRANDOLA.tb_s() - 0.145).abs() < 5e-4);
        assert!((MIRANDOLA.tc_s() - 0.436).abs() < 5e-4);
        assert!((MIRANDOLA.td_s() - 2.16).abs() < 1e-12);
    }

    #[test]
    fn analytic_branches_of_the_spectrum_meet() {
        let plateau = 0.14 * G_M_S2 * MIRANDOLA.amplification() * 2.588;
        for (period, value) in [
            (0.0, plateau / 2.588),
            (MIRANDOLA.tb_s(), plateau),
            (0.3, plateau),
            (MIRANDOLA.tc_s(), plateau),
            (MIRANDOLA.td_s(), plateau * MIRANDOLA.tc_s() / 2.16),
            (4.32, plateau * MIRANDOLA.tc_s() * 2.16 / (4.32 * 4.32)),
        ] {
            // Rounding only.
            assert!((MIRANDOLA.elastic_m_s2(period) / value - 1.0).abs() < 1e-12, "{period}");
        }
    }

    #[test]
    fn analytic_displacements_follow_the_spectrum_and_end_at_the_ground_s() {
        let short = MIRANDOLA.elastic_m_s2(2.0) / std::f64::consts::PI.powi(2);
        assert!((MIRANDOLA.displacement_m(2.0) / short - 1.0).abs() < 1e-12);
        // 1/4π² is 0.02533 and not 0.025: the code's branches meet within 1.4 %.
        let [before, after] = [6.0, 6.0 + 1e-9].map(|period| MIRANDOLA.displacement_m(period));
        assert!((before / after - 1.0).abs() < 0.014, "{before} {after}");
        let ground = 0.025 * 0.14 * G_M_S2 * MIRANDOLA.amplification() * MIRANDOLA.tc_s() * MIRANDOLA.td_s();
        assert!([10.0, 20.0].iter().all(|t| (MIRANDOLA.displacement_m(*t) / ground - 1.0).abs() < 1e-12));
    }

    #[test]
    fn analytic_damping_lowers_the_plateau_to_a_floor() {
        let damped = |damping| Site { damping, ..MIRANDOLA }.elastic_m_s2(0.3) / MIRANDOLA.elastic_m_s2(0.3);
        assert!((damped(0.10) - (10.0_f64 / 15.0).sqrt()).abs() < 1e-12);
        assert!((damped(0.45) - 0.55).abs() < 1e-12);
    }
}

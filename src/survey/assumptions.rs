//! What the survey leaves open: strip, density, impact law, accuracy.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use mrbd_kernel::model::{ImpactLaw, Restitution, WallParameters};
use mrbd_kernel::simulate::Accuracy;

/// What a study assumes where the survey is silent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assumptions {
    /// Length L of the strip, m.
    pub length_m: f64,
    /// Density ρ of the masonry, kg/m³.
    pub density_kg_m3: f64,
    /// What the C_l scale.
    pub law: ImpactLaw,
    /// Relative velocity below which a joint that would open stays closed, rad/s.
    pub capture_velocity_rad_s: f64,
    /// Rotation over α_i at which the wall counts as collapsed.
    pub collapse_rotation_ratio: f64,
    /// Error allowed in rotations relative to α_i.
    pub tolerance: f64,
    /// Free motion after the record, s.
    pub tail_s: f64,
    /// Whether the records' vertical components act too.
    pub vertical: bool,
}

/// Assumptions that differ from those they build on.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Changes {
    length_m: Option<f64>,
    density_kg_m3: Option<f64>,
    law: Option<ImpactLaw>,
    capture_velocity_rad_s: Option<f64>,
    collapse_rotation_ratio: Option<f64>,
    tolerance: Option<f64>,
    tail_s: Option<f64>,
    vertical: Option<bool>,
}

impl Default for Assumptions {
    /// Strip of 1 m of solid brick and lime mortar, 18 kN/m³ (commentary to the Italian code); Eq. 7.
    fn default() -> Self {
        Self {
            length_m: 1.0,
            density_kg_m3: 1800.0,
            law: ImpactLaw::Whole,
            capture_velocity_rad_s: Restitution::DEFAULT_CAPTURE_RAD_S,
            collapse_rotation_ratio: WallParameters::DEFAULT_COLLAPSE_RATIO,
            tolerance: Accuracy::default().tolerance,
            tail_s: 5.0,
            vertical: false,
        }
    }
}

impl Changes {
    pub(crate) fn onto(&self, base: &Assumptions) -> Assumptions {
        Assumptions {
            length_m: self.length_m.unwrap_or(base.length_m),
            density_kg_m3: self.density_kg_m3.unwrap_or(base.density_kg_m3),
            law: self.law.unwrap_or(base.law),
            capture_velocity_rad_s: self.capture_velocity_rad_s.unwrap_or(base.capture_velocity_rad_s),
            collapse_rotation_ratio: self.collapse_rotation_ratio.unwrap_or(base.collapse_rotation_ratio),
            tolerance: self.tolerance.unwrap_or(base.tolerance),
            tail_s: self.tail_s.unwrap_or(base.tail_s),
            vertical: self.vertical.unwrap_or(base.vertical),
        }
    }
}

impl Assumptions {
    /// Checks every value; `table` is where the keys stand in `path`.
    pub(crate) fn check(&self, path: &Path, table: &str) -> Result<()> {
        let rule = |key: &str, value: f64, holds: bool, allowed: &str| match value.is_finite() && holds {
            true => Ok(()),
            false => Err(InputError::key(path, format!("{table}.{key}"), value.to_string(), allowed)),
        };
        let above_0 = "a finite number above 0";
        let not_below_0 = "a finite number, 0 or more";
        rule("length_m", self.length_m, self.length_m > 0.0, above_0)?;
        rule("density_kg_m3", self.density_kg_m3, self.density_kg_m3 > 0.0, above_0)?;
        let capture = self.capture_velocity_rad_s;
        rule("capture_velocity_rad_s", capture, capture >= 0.0, not_below_0)?;
        let ratio = self.collapse_rotation_ratio;
        rule("collapse_rotation_ratio", ratio, ratio > 0.0, above_0)?;
        let within = Accuracy::TOLERANCES.contains(&self.tolerance);
        rule("tolerance", self.tolerance, within, Accuracy::ALLOWED)?;
        rule("tail_s", self.tail_s, self.tail_s >= 0.0, not_below_0)?;
        Ok(())
    }
}

//! A building as the code describes it for what stands on its floors: its modes, and the height of the wall in it.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::spectrum::CODE_DAMPING;
use mrbd_files::error::InputError;

/// A mode of a building, at the height of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// T_k, s.
    pub period_s: f64,
    /// γ_k ψ_k(z): participation times the mode's shape at the height of the wall.
    pub participation: f64,
}

/// `[building]`: where the wall is in a building (Circolare 2019, C7.2.3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Building {
    /// z/H: height of the wall's restraints over that of the building.
    pub height_ratio: f64,
    /// T_1: period of the first mode, s.
    pub period_s: f64,
    /// n: number of storeys.
    pub storeys: u32,
    /// ξ_k: damping of its modes relative to critical.
    #[serde(default = "code_damping")]
    pub damping: f64,
    /// Modes beyond the first, as an analysis of the building has them.
    #[serde(default)]
    pub modes: Vec<Mode>,
}

fn code_damping() -> f64 {
    CODE_DAMPING
}

impl Building {
    /// γ_1 = 3n/(2n + 1) (C7.2.10).
    pub fn participation(&self) -> f64 {
        let n = f64::from(self.storeys);
        3.0 * n / (2.0 * n + 1.0)
    }

    /// All modes, the first with ψ_1 = z/H.
    pub fn all_modes(&self) -> Vec<Mode> {
        let first = Mode { period_s: self.period_s, participation: self.participation() * self.height_ratio };
        std::iter::once(first).chain(self.modes.iter().copied()).collect()
    }

    /// Checks the numbers of `[building]`, or of another table of this name, in a file.
    ///
    /// # Errors
    /// An input error that names file and key.
    pub fn check(&self, path: &Path, table: &str) -> Result<(), InputError> {
        let within = |key: String, value: f64, range: [f64; 2]| {
            let [least, most] = range;
            if (least..=most).contains(&value) {
                return Ok(());
            }
            let allowed = format!("{least} to {most}");
            Err(InputError::key(path, format!("{table}.{key}"), value.to_string(), allowed))
        };
        within("height_ratio".into(), self.height_ratio, [0.0, 1.0])?;
        within("period_s".into(), self.period_s, PERIODS_S)?;
        within("storeys".into(), f64::from(self.storeys), [1.0, 100.0])?;
        within("damping".into(), self.damping, [0.005, 0.3])?;
        for (k, mode) in self.modes.iter().enumerate() {
            within(format!("modes[{k}].period_s"), mode.period_s, PERIODS_S)?;
            within(format!("modes[{k}].participation"), mode.participation, [-5.0, 5.0])?;
        }
        Ok(())
    }
}

/// Periods of buildings, s.
const PERIODS_S: [f64; 2] = [0.02, 5.0];

//! The one-at-a-time sweep of a pipeline file: parameters, slendernesses.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use crate::survey::Configuration;

/// A parameter of the façade that a sweep takes through its three levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Thickness b.
    Thickness,
    /// Height of the crack h_1 / h_tot.
    CrackHeight,
    /// Compressive strength f.
    Strength,
    /// Stiffness of the floor k_d.
    Stiffness,
    /// Floor mass m_d / m_tot that acts in both directions.
    DiaphragmMass,
    /// Floor mass m_dp / m_tot that acts horizontally only.
    CarriageMass,
    /// All C_l together.
    Restitution,
}

/// A one-at-a-time sweep: every parameter of a configuration at three levels, over slendernesses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepTable {
    /// Slendernesses h_tot / b.
    pub slenderness: Vec<f64>,
    /// Parameters by configuration.
    pub parameters: ParameterLists,
}

/// Parameters by configuration; an empty or absent list leaves the configuration out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterLists {
    /// Parameters of façades whose floor rests on them.
    #[serde(default)]
    pub perpendicular: Vec<Parameter>,
    /// Parameters of façades along which the floor runs.
    #[serde(default)]
    pub parallel: Vec<Parameter>,
}

impl SweepTable {
    /// The parameters of a configuration.
    pub fn parameters(&self, configuration: Configuration) -> &[Parameter] {
        match configuration {
            Configuration::Perpendicular => &self.parameters.perpendicular,
            Configuration::Parallel => &self.parameters.parallel,
        }
    }

    pub(super) fn check(&self, path: &Path) -> Result<()> {
        let refuse =
            |key: &str, found: String, allowed: &str| Err(InputError::key(path, key, found, allowed).into());
        if self.slenderness.is_empty() {
            return refuse("sweep.slenderness", "an empty list".into(), "at least one slenderness");
        }
        if let Some(wrong) = self.slenderness.iter().find(|x| !(x.is_finite() && **x > 0.0)) {
            return refuse("sweep.slenderness", wrong.to_string(), "finite numbers above 0");
        }
        if !self.slenderness.is_sorted_by(|a, b| a < b) {
            let found = format!("{:?}", self.slenderness);
            return refuse("sweep.slenderness", found, "increasing numbers, each once");
        }
        if Configuration::ALL.iter().all(|&c| self.parameters(c).is_empty()) {
            return refuse("sweep.parameters", "no parameters".into(), "at least one parameter");
        }
        for configuration in Configuration::ALL {
            let list = self.parameters(configuration);
            if list.iter().collect::<BTreeSet<_>>().len() < list.len() {
                let key = format!("sweep.parameters.{}", configuration.name());
                return refuse(&key, "a parameter twice".into(), "each parameter once");
            }
        }
        Ok(())
    }
}

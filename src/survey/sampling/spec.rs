//! What is asked of a sampler, as a user writes it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::design::Design;
use super::marginal::Truncation;
use super::variable::Variable;

/// The highest crack: above it the upper body is a row of bricks.
pub const HIGHEST_CRACK: f64 = 0.95;

/// How façades are drawn; as a table of a TOML file, every key but `count` may be left out.
///
/// ```toml
/// count = 10000
/// seed = 1                                   # the default
/// design = "latin_hypercube"                 # "plain" (the default), "sobol"
/// fixed = { slenderness = 15.0 }
/// rank_correlation = [["thickness_m", "slenderness", -0.4]]
/// [truncation]                               # crack_height_ratio is below 0.95 unless given here
/// carriage_mass_ratio = { upper = 0.6 }
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sampling {
    /// Number of façades.
    pub count: u64,
    /// Seed of all draws.
    #[serde(default = "first_seed")]
    pub seed: u64,
    /// How they are spread.
    #[serde(default)]
    pub design: Design,
    /// Variables that do not vary, and their values.
    #[serde(default)]
    pub fixed: BTreeMap<Variable, f64>,
    /// Spearman's rank correlations of pairs.
    #[serde(default)]
    pub rank_correlation: Vec<(Variable, Variable, f64)>,
    /// Limits of variables.
    #[serde(default)]
    pub truncation: BTreeMap<Variable, Truncation>,
}

fn first_seed() -> u64 {
    1
}

impl Sampling {
    /// Independent façades, truncated as the source's crack heights need.
    pub fn plain(count: u64, seed: u64) -> Self {
        Self {
            count,
            seed,
            design: Design::Plain,
            fixed: BTreeMap::new(),
            rank_correlation: Vec::new(),
            truncation: BTreeMap::new(),
        }
    }

    /// Limits of a variable, given or by default.
    pub(super) fn truncation_of(&self, variable: Variable) -> Truncation {
        let default = match variable {
            Variable::CrackHeight => Truncation { lower: None, upper: Some(HIGHEST_CRACK) },
            _ => Truncation::default(),
        };
        self.truncation.get(&variable).copied().unwrap_or(default)
    }
}

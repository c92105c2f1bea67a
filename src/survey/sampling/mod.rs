//! Façades for Monte Carlo campaigns: the survey's distributions, spread over the unit cube by a design.
//!
//! | step | module |
//! | --- | --- |
//! | a point of the unit cube: plain, Latin hypercube, scrambled Sobol | [`Design`] |
//! | rank correlations by a Gaussian copula | `variable` |
//! | log-normal, truncated or constant values | [`Marginal`] |
//! | the variables of a façade | [`FacadeSampler`] |
//!
//! Every number depends on the seed, the index of the draw and the variable alone: any draw can be repeated by itself,
//! threads and shards change nothing, and a sampler of 10⁶ draws takes no more memory than one of ten.

mod design;
mod facade;
mod marginal;
mod sobol;
mod variable;

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::InputError;
pub use design::{Design, MOST_STRATA, Points};
pub use facade::FacadeSampler;
pub use marginal::{Marginal, Truncation};
use serde::{Deserialize, Serialize};
pub use variable::Variable;

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

/// A fault under a key of whatever file the caller read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key}: found {found}; allowed: {allowed}")]
pub struct Refused {
    /// Dotted key.
    pub key: String,
    /// What was found there.
    pub found: String,
    /// What is allowed there.
    pub allowed: String,
}

impl Refused {
    pub(super) fn new(key: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { key: key.into(), found: found.into(), allowed: allowed.into() }
    }

    /// The fault as one of the file `path`.
    pub fn at(self, path: &Path) -> InputError {
        InputError::key(path, self.key, self.found, self.allowed)
    }
}

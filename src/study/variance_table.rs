//! The table of a study of variance: what is assumed where nobody knows, as levels and ranges.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::pipeline::Variant;
use crate::error::{InputError, Result};
use crate::survey::Bed;
use crate::survey::sampling::Sampling;
use mrbd_kernel::model::ImpactLaw;

/// What is assumed in a study of variance, each level as likely as another and ranges evenly.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variance {
    /// What the C_l scale.
    pub laws: Vec<ImpactLaw>,
    /// Length L of the strip, m, from and to.
    pub length_m: [f64; 2],
    /// Density ρ of the masonry, kg/m³, from and to.
    pub density_kg_m3: [f64; 2],
    /// What lies in both joints.
    pub beds: Vec<Bed>,
    /// Factor on all records; 1 for the suite as it is.
    #[serde(default = "own_scale")]
    pub factor: f64,
}

fn own_scale() -> f64 {
    1.0
}

/// Key of the beds.
const BEDS: &str = "variance.beds";

impl Variance {
    /// The table, if its values are possible.
    ///
    /// # Errors
    /// Input errors under its keys.
    pub(super) fn checked(self, path: &Path) -> Result<Self> {
        check_levels(path, "variance.laws", &self.laws)?;
        check_levels(path, BEDS, &self.beds)?;
        let is_possible = |bed: &Bed| bed.check(path, BEDS);
        self.beds.iter().try_for_each(is_possible)?;
        for (key, [from, to]) in [("length_m", self.length_m), ("density_kg_m3", self.density_kg_m3)] {
            if !(from > 0.0 && from <= to && to.is_finite()) {
                let (key, found) = (format!("variance.{key}"), format!("{from} to {to}"));
                return Err(InputError::key(path, key, found, "finite numbers, 0 < from ≤ to").into());
            }
        }
        if !(self.factor > 0.0 && self.factor.is_finite()) {
            let found = self.factor.to_string();
            return Err(InputError::key(path, "variance.factor", found, "a finite number above 0").into());
        }
        Ok(self)
    }
}

fn check_levels<T: PartialEq + std::fmt::Debug>(path: &Path, key: &str, levels: &[T]) -> Result<()> {
    let twice = (1..levels.len()).any(|i| levels[..i].contains(&levels[i]));
    if levels.is_empty() || twice {
        return Err(InputError::key(path, key, format!("{levels:?}"), "at least one, each once").into());
    }
    Ok(())
}

/// What a study of variance needs beside its table: inputs that are independent, one set of assumptions, and members.
pub(super) fn check_variance(path: &Path, sampling: &Sampling, variants: &[Variant]) -> Result<()> {
    if !sampling.rank_correlation.is_empty() {
        let found = format!("{} pairs", sampling.rank_correlation.len());
        let allowed = "none: shares of a variance are defined for inputs that are independent";
        return Err(InputError::key(path, "sampling.rank_correlation", found, allowed).into());
    }
    let own = variants.iter().filter(|variant| variant.member.is_none()).count();
    if own != 1 {
        let allowed = "one: laws, lengths, densities and beds are levels of [variance]";
        return Err(InputError::key(path, "variants", own.to_string(), allowed).into());
    }
    if variants.iter().any(|variant| variant.assumptions.bed.is_some()) {
        let allowed = "beds as levels of [variance]";
        return Err(InputError::key(path, "assumptions.bed", "a bed", allowed).into());
    }
    if variants.len() == own {
        let allowed = "1 to 100, or the share that no input decides is not told";
        return Err(InputError::key(path, "variants[0].members", "0", allowed).into());
    }
    Ok(())
}

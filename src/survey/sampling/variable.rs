//! The quantities of a façade that vary (the source's Table 3), and rank correlations between them.
//!
//! Correlations follow a Gaussian copula. Normal scores Φ⁻¹(u) are mixed by the Cholesky factor of their correlation and
//! turned back into u. Spearman's rank correlation ρ_S of the variables, whatever their distributions, is that of the
//! scores' correlation ρ = 2 sin(π ρ_S/6) (Pearson 1907; Kruskal 1958, Eq. 6.5).
//!
//! Mixing takes strata apart. Of a Latin hypercube or a Sobol sequence the first of correlated variables keeps its
//! strata. The later ones keep what the mixture leaves of them.

use super::Refused;
use crate::survey::{Configuration, Survey, ThreeLevels};
use mrbd_statistics::normal;
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

/// A quantity of a façade that varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Variable {
    /// Thickness b, m.
    #[serde(rename = "thickness_m")]
    Thickness,
    /// Slenderness h_tot / b.
    #[serde(rename = "slenderness")]
    Slenderness,
    /// Height of the crack h_1 / h_tot.
    #[serde(rename = "crack_height_ratio")]
    CrackHeight,
    /// Compressive strength f, Pa.
    #[serde(rename = "compressive_strength_pa")]
    Strength,
    /// Stiffness of the floor k_d, N/m.
    #[serde(rename = "stiffness_n_per_m")]
    Stiffness,
    /// Floor mass m_d / m_tot.
    #[serde(rename = "diaphragm_mass_ratio")]
    DiaphragmMass,
    /// Floor mass m_dp / m_tot.
    #[serde(rename = "carriage_mass_ratio")]
    CarriageMass,
}

impl Variable {
    /// All; the position decides the random numbers of a variable, so new ones go to the end.
    pub const ALL: [Variable; 7] = [
        Variable::Thickness,
        Variable::Slenderness,
        Variable::CrackHeight,
        Variable::Strength,
        Variable::Stiffness,
        Variable::DiaphragmMass,
        Variable::CarriageMass,
    ];

    /// Name in input and result files; the unit stands in it.
    pub fn name(self) -> &'static str {
        match self {
            Variable::Thickness => "thickness_m",
            Variable::Slenderness => "slenderness",
            Variable::CrackHeight => "crack_height_ratio",
            Variable::Strength => "compressive_strength_pa",
            Variable::Stiffness => "stiffness_n_per_m",
            Variable::DiaphragmMass => "diaphragm_mass_ratio",
            Variable::CarriageMass => "carriage_mass_ratio",
        }
    }

    /// Its three levels in a survey.
    pub(super) fn levels(self, survey: &Survey, configuration: Configuration) -> ThreeLevels {
        let (wall, floor) = (&survey.wall, survey.floor(configuration));
        match self {
            Variable::Thickness => wall.thickness_m,
            Variable::Slenderness => wall.slenderness,
            Variable::CrackHeight => wall.crack_height_ratio,
            Variable::Strength => wall.compressive_strength_pa,
            Variable::Stiffness => floor.stiffness_n_per_m,
            Variable::DiaphragmMass => floor.diaphragm_mass_ratio,
            Variable::CarriageMass => floor.carriage_mass_ratio,
        }
    }

    /// Key of the survey the levels stand under.
    pub(super) fn key(self, configuration: Configuration) -> String {
        let table = match self {
            Variable::Thickness | Variable::Slenderness | Variable::CrackHeight | Variable::Strength => {
                "wall"
            }
            _ => configuration.name(),
        };
        format!("{table}.{}", self.name())
    }

    /// Values a façade can have: above 0 or from 0, and for ratios below 1.
    pub(super) fn possible(self, value: f64) -> bool {
        match self {
            Variable::Thickness | Variable::Slenderness | Variable::Strength => value > 0.0,
            Variable::CrackHeight => value > 0.0 && value < 1.0,
            Variable::Stiffness => value >= 0.0,
            Variable::DiaphragmMass | Variable::CarriageMass => (0.0..1.0).contains(&value),
        }
    }
}

/// Rank correlation of two variables by position.
pub(super) type Pair = (usize, usize, f64);

/// Lower triangular mixture of normal scores, by rows; rows of variables without correlation are unit rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mixture {
    factor: DMatrix<f64>,
}

impl Mixture {
    /// The mixture of `variables` variables; none without pairs.
    ///
    /// # Errors
    /// [`Refused`] under `key` for a correlation not above -1 and below 1, a variable with itself, a pair given twice,
    /// and pairs that no joint distribution has.
    pub fn new(key: &str, variables: usize, pairs: &[Pair]) -> Result<Option<Self>, Refused> {
        if pairs.is_empty() {
            return Ok(None);
        }
        let mut scores = DMatrix::identity(variables, variables);
        for &(i, j, rank) in pairs {
            if !(rank > -1.0 && rank < 1.0) {
                return Err(Refused::new(key, rank.to_string(), "rank correlations above -1 and below 1"));
            }
            if i == j || scores[(i, j)] != 0.0 {
                return Err(Refused::new(key, "a pair twice, or a variable with itself", "each pair once"));
            }
            let score = 2.0 * (std::f64::consts::PI * rank / 6.0).sin();
            scores[(i, j)] = score;
            scores[(j, i)] = score;
        }
        let least = SymmetricEigen::new(scores.clone()).eigenvalues.min();
        // Nearer to singular than this, the later variables are functions of the earlier ones to rounding.
        let factor = Cholesky::new(scores).filter(|_| least > 1e-10).map(|cholesky| cholesky.unpack());
        let impossible = || {
            let found = format!("correlations whose matrix of scores has the eigenvalue {least:.3e}");
            Refused::new(key, found, "a positive definite matrix: correlations that can be together")
        };
        Ok(Some(Self { factor: factor.ok_or_else(impossible)? }))
    }

    /// Mixes the coordinates of a point.
    pub fn apply<const N: usize>(&self, point: [f64; N]) -> [f64; N] {
        let scores = point.map(normal::quantile);
        std::array::from_fn(|i| {
            let row = self.factor.row(i);
            if row[i] == 1.0 {
                return point[i];
            }
            normal::cdf(row.iter().zip(scores).take(i + 1).map(|(weight, score)| weight * score).sum())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_perfect_mixtures_at_the_ends() {
        let mixture = Mixture::new("c", 3, &[(0, 2, 0.999_999)]).expect("valid").expect("pairs");
        let mixed = mixture.apply([0.2, 0.6, 0.9]);
        assert_eq!(mixed[..2], [0.2, 0.6], "what comes first or alone is untouched");
        // ρ = 1 - 9e-7 leaves √(2 · 9e-7) = 0.0013 of the own score 1.28, times φ.
        assert!((mixed[2] - 0.2).abs() < 0.002, "{mixed:?}");
    }

    #[test]
    fn rejects_correlations_that_cannot_be() {
        let refused = |pairs: &[Pair]| Mixture::new("corr", 3, pairs).expect_err("refused").to_string();
        assert!(refused(&[(0, 1, 1.0)]).starts_with("corr: found 1"));
        assert!(refused(&[(0, 1, f64::NAN)]).contains("NaN"));
        assert!(refused(&[(1, 1, 0.5)]).contains("itself"));
        assert!(refused(&[(0, 1, 0.5), (1, 0, 0.5)]).contains("twice"));
        let message = refused(&[(0, 1, 0.9), (1, 2, 0.9), (0, 2, -0.9)]);
        assert!(message.contains("positive definite") && message.contains("eigenvalue -"), "{message}");
        assert_eq!(Mixture::new("corr", 3, &[]), Ok(None));
    }
}

//! Designs: how points fill the unit cube of the variables. Any point can be computed alone.

use serde::{Deserialize, Serialize};

use super::permutation::Permutation;
use super::random::{Purpose, bits, unit};
use super::refused::Refused;
use super::sobol;

/// Most points of a Latin hypercube: place and stratum then share the digits of a number without rounding.
pub const MOST_STRATA: u64 = 1 << 24;

/// Digits of the place inside a stratum.
const JITTER_DIGITS: u32 = 22;

/// How points are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Independent points.
    #[default]
    Plain,
    /// One point in each of `count` equal strata of every variable (McKay, Beckman & Conover 1979).
    LatinHypercube,
    /// The scrambled sequence of Sobol; counts that are powers of 2 keep its balance.
    Sobol,
}

impl Design {
    /// Name in pipeline files.
    pub fn name(self) -> &'static str {
        match self {
            Design::Plain => "plain",
            Design::LatinHypercube => "latin_hypercube",
            Design::Sobol => "sobol",
        }
    }
}

/// A design of a number of points in a number of variables.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Points {
    seed: u64,
    count: u64,
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Kind {
    Plain,
    LatinHypercube(Vec<Permutation>),
    Sobol(Vec<sobol::Dimension>),
}

impl Points {
    /// A design of `count` points in `variables` variables.
    ///
    /// # Errors
    /// [`Refused`] for no points, and for more than the design has.
    pub fn new(design: Design, count: u64, seed: u64, variables: usize) -> Result<Self, Refused> {
        let most = match design {
            Design::Plain => u64::MAX,
            Design::LatinHypercube => MOST_STRATA,
            Design::Sobol => sobol::POINTS as u64,
        };
        if count == 0 || count > most {
            return Err(Refused::new("count", count.to_string(), format!("1 to {most} points")));
        }
        if design == Design::Sobol && variables > sobol::DIMENSIONS {
            let allowed = format!("at most {} variables", sobol::DIMENSIONS);
            return Err(Refused::new("design", format!("sobol in {variables} variables"), allowed));
        }
        let kind = match design {
            Design::Plain => Kind::Plain,
            Design::LatinHypercube => {
                Kind::LatinHypercube((0..variables).map(|v| Permutation::new(count, seed, v)).collect())
            }
            Design::Sobol => Kind::Sobol((0..variables).map(|v| sobol::Dimension::new(v, seed)).collect()),
        };
        Ok(Self { seed, count, kind })
    }

    /// Number of points.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// A number in (0, 1) beside the coordinates of a point, at a position that no variable has: independent of all.
    pub fn further(&self, index: u64, position: usize) -> f64 {
        unit(bits(self.seed, index, position, Purpose::Draw), 52)
    }

    /// Coordinate of a point, above 0 and below 1.
    ///
    /// # Panics
    /// For a point or a variable that the design has not.
    pub fn at(&self, index: u64, variable: usize) -> f64 {
        assert!(index < self.count, "point {index} of {}", self.count);
        match &self.kind {
            Kind::Plain => unit(bits(self.seed, index, variable, Purpose::Draw), 52),
            Kind::LatinHypercube(permutations) => {
                let jitter = unit(bits(self.seed, index, variable, Purpose::Jitter), JITTER_DIGITS);
                (permutations[variable].at(index) as f64 + jitter) / self.count as f64
            }
            // The count was checked to be at most 2³².
            Kind::Sobol(dimensions) => dimensions[variable].at(index as u32),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_one_point_in_each_stratum_of_each_variable() {
        for count in [1, 7, 1000, 4096] {
            let points = Points::new(Design::LatinHypercube, count, 42, 3).expect("valid");
            for variable in 0..3 {
                let mut strata = vec![0; count as usize];
                (0..count).for_each(|i| {
                    strata[(points.at(i, variable) * count as f64) as usize] += 1;
                });
                assert!(strata.iter().all(|&points| points == 1), "{count} points, variable {variable}");
            }
        }
    }

    #[test]
    fn analytic_strata_of_the_largest_design_do_not_round_over() {
        let points = Points::new(Design::LatinHypercube, MOST_STRATA, 1, 1).expect("valid");
        let Kind::LatinHypercube(permutations) = &points.kind else { panic!("a hypercube") };
        for index in (0..MOST_STRATA).step_by(4099) {
            let stratum = (points.at(index, 0) * MOST_STRATA as f64) as u64;
            assert_eq!(stratum, permutations[0].at(index));
        }
    }

    #[test]
    fn analytic_every_design_is_uniform_and_its_variables_unrelated() {
        for design in [Design::Plain, Design::LatinHypercube, Design::Sobol] {
            let points = Points::new(design, 4096, 6, 2).expect("valid");
            let mean = |f: &dyn Fn(f64, f64) -> f64| {
                (0..4096).map(|i| f(points.at(i, 0) - 0.5, points.at(i, 1) - 0.5)).sum::<f64>() / 4096.0
            };
            // Deviations of uniform numbers: √(1/12), √(1/180) for squares, 1/12 for products; over 64, times four.
            assert!(mean(&|x, _| x).abs() < 0.018, "{design:?}");
            assert!((mean(&|x, _| x * x) - 1.0 / 12.0).abs() < 0.0047, "{design:?}");
            assert!(mean(&|x, y| x * y).abs() < 0.0052, "{design:?}");
        }
    }

    #[test]
    fn rejects_counts_a_design_has_not() {
        let refused = |design, count| Points::new(design, count, 0, 1).expect_err("refused").to_string();
        assert!(refused(Design::Plain, 0).starts_with("count: found 0; allowed: 1 to"));
        assert!(refused(Design::LatinHypercube, MOST_STRATA + 1).contains("16777216"));
        assert!(refused(Design::Sobol, 1 << 33).contains("4294967296"));
        assert!(Points::new(Design::Sobol, 8, 0, 11).is_err());
    }
}

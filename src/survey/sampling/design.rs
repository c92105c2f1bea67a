//! Designs: how points fill the unit cube of the variables. Any point can be computed alone.
//!
//! A Latin hypercube needs a random order of 0 … n - 1 of which any place can be computed alone, in no memory. A Feistel
//! network permutes the numbers of an even number of bits. Places it sends to n or beyond are sent on until they land
//! below n (cycle walking; Black & Rogaway 2002, "Ciphers with arbitrary finite domains").

use super::Refused;
use super::sobol;
use super::sobol::{Purpose, bits, mix, unit};
use serde::{Deserialize, Serialize};

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
pub struct Points {
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

/// Rounds of the network: four make a pseudorandom permutation of large halves (Luby & Rackoff 1988), eight leave a
/// margin for small ones.
const ROUNDS: usize = 8;

/// Bits of a half at least, so that small n are permuted among 256 and walk home.
const LEAST_HALF: u32 = 4;

/// A permutation of `0..count`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Permutation {
    count: u64,
    half: u32,
    keys: [u64; ROUNDS],
}

impl Permutation {
    /// The permutation of a seed and a variable; `count` above 0 and at most 2³².
    pub fn new(count: u64, seed: u64, variable: usize) -> Self {
        let digits = u64::BITS - (count - 1).leading_zeros();
        let half = digits.div_ceil(2).max(LEAST_HALF);
        let keys = std::array::from_fn(|round| bits(seed, round as u64, variable, Purpose::Key));
        Self { count, half, keys }
    }

    /// Where `index`, below the count, is sent.
    pub fn at(&self, index: u64) -> u64 {
        let mut place = self.network(index);
        while place >= self.count {
            place = self.network(place);
        }
        place
    }

    fn network(&self, value: u64) -> u64 {
        let mask = (1 << self.half) - 1;
        let (mut left, mut right) = (value >> self.half, value & mask);
        for key in self.keys {
            (left, right) = (right, left ^ (mix(right ^ key) & mask));
        }
        (left << self.half) | right
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
        assert!(Points::new(Design::Sobol, 8, 0, 41).is_err());
    }

    #[test]
    fn analytic_every_place_is_taken_once() {
        for count in [1, 2, 3, 7, 100, 255, 256, 257, 10_000, 65_537] {
            let permutation = Permutation::new(count, 11, 2);
            let mut taken = vec![false; count as usize];
            for index in 0..count {
                let place = permutation.at(index) as usize;
                assert!(!taken[place], "{place} of {count} twice");
                taken[place] = true;
            }
        }
    }

    #[test]
    fn analytic_first_places_are_even_over_seeds() {
        // Where 0 and 1 are sent, among 6: 30 ordered pairs, 6000 seeds, 200 a pair.
        let mut counts = [[0u32; 6]; 6];
        for seed in 0..6000 {
            let permutation = Permutation::new(6, seed, 0);
            counts[permutation.at(0) as usize][permutation.at(1) as usize] += 1;
        }
        let pairs = counts.iter().flatten().filter(|&&count| count > 0);
        let chi: f64 = pairs.clone().map(|&count| (f64::from(count) - 200.0).powi(2) / 200.0).sum();
        assert_eq!(pairs.count(), 30);
        // χ² with 29 degrees of freedom has mean 29 and deviation 7.6; 58 is beyond one in a thousand.
        assert!(chi < 58.0, "{chi}");
    }
}

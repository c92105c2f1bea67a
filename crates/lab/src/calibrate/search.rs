//! What every search shares: bounds, a population, costs, and random numbers.
//!
//! A random number depends only on seed, search, generation, candidate and variable. Every candidate of every generation
//! has its own stream of ChaCha8, and every variable its own place in it. So a draw is the same whatever was drawn before,
//! on whatever thread.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

use mrbd_files::error::Result;

/// Bounds of one variable: β_0 and β_f of Eq. 9.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// β_0.
    pub lower: f64,
    /// β_f.
    pub upper: f64,
}

impl Bounds {
    /// The nearest value within.
    pub fn clamp(&self, value: f64) -> f64 {
        value.clamp(self.lower, self.upper)
    }

    /// Value at a share of the way from the lower to the upper bound.
    pub fn at(&self, share: f64) -> f64 {
        self.lower + share * (self.upper - self.lower)
    }

    /// Upper less lower.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// A candidate and its cost; a candidate whose runs failed costs infinity.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Values of the variables.
    pub values: Vec<f64>,
    /// What is minimised.
    pub cost: f64,
}

/// Gives the costs of a generation of candidates, in order.
pub trait Evaluate {
    /// Costs of these candidates, the `generation`-th asked for.
    ///
    /// # Errors
    /// What keeping the results meets; a candidate that cannot be simulated is no error but costs infinity.
    fn costs(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<f64>> {
        self.costs_below(generation, candidates, &vec![f64::INFINITY; candidates.len()])
    }

    /// The same where a candidate whose cost is certain to be more than its `most` may be abandoned: it costs infinity.
    ///
    /// # Errors
    /// As [`Evaluate::costs`].
    fn costs_below(&mut self, generation: u32, candidates: &[Vec<f64>], most: &[f64]) -> Result<Vec<f64>>;
}

/// How a search went.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The last generation.
    pub population: Vec<Member>,
    /// Candidates evaluated.
    pub evaluations: usize,
    /// Candidates evaluated up to the end of each generation.
    pub vectors: Vec<usize>,
    /// Lowest cost after each generation, the first generation included.
    pub best_costs: Vec<f64>,
    /// Sum of the population's costs after each generation; the paper's Fig. 6.
    pub cost_sums: Vec<f64>,
}

impl Found {
    pub(super) fn start(population: Vec<Member>) -> Self {
        let evaluations = population.len();
        let [best_costs, cost_sums] = [Vec::new(), Vec::new()];
        let mut found = Self { population, evaluations, vectors: Vec::new(), best_costs, cost_sums };
        found.note();
        found
    }

    /// Notes the state after a generation.
    pub(super) fn note(&mut self) {
        self.vectors.push(self.evaluations);
        self.best_costs.push(self.best().cost);
        self.cost_sums.push(self.population.iter().map(|member| member.cost).sum());
    }

    /// The member of lowest cost, the first of equals.
    pub fn best(&self) -> &Member {
        let cheaper = |best, member| if member_cost(member) < member_cost(best) { member } else { best };
        self.population.iter().skip(1).fold(&self.population[0], cheaper)
    }
}

fn member_cost(member: &Member) -> f64 {
    member.cost
}

/// Candidates with their costs.
pub(super) fn members(values: Vec<Vec<f64>>, costs: Vec<f64>) -> Vec<Member> {
    values.into_iter().zip(costs).map(|(values, cost)| Member { values, cost }).collect()
}

/// Words kept for one variable: more than the longest rejection loop here has a chance to use.
const WORDS_PER_VARIABLE: u128 = 256;

/// The random numbers of one search.
#[derive(Debug, Clone)]
pub struct Draws {
    key: [u8; 32],
}

impl Draws {
    /// Those of the search of this name under a seed.
    pub fn new(seed: u64, search: &str) -> Self {
        let mut hash = Sha256::new();
        hash.update(seed.to_le_bytes());
        hash.update(search.as_bytes());
        Self { key: hash.finalize().into() }
    }

    /// Those of a part of the search.
    pub fn part(&self, name: &str) -> Self {
        let hash = Sha256::new().chain_update(self.key).chain_update(name.as_bytes());
        Self { key: hash.finalize().into() }
    }

    /// The generator of one variable of one candidate of one generation.
    pub fn of(&self, generation: u32, candidate: u32, variable: u32) -> impl Rng + use<> {
        let mut rng = ChaCha8Rng::from_seed(self.key);
        rng.set_stream(u64::from(generation) << 32 | u64::from(candidate));
        rng.set_word_pos(u128::from(variable) * WORDS_PER_VARIABLE);
        rng
    }

    /// Uniform in 0 to 1.
    pub fn uniform(&self, generation: u32, candidate: u32, variable: u32) -> f64 {
        self.of(generation, candidate, variable).random()
    }
}

/// `N` different indices below `count`, none of them `besides`.
///
/// `count` must exceed `N`; there are no others to draw from.
pub fn different<const N: usize>(rng: &mut impl Rng, count: usize, besides: usize) -> [usize; N] {
    assert!(count > N, "{N} indices besides one cannot be drawn from {count}");
    let mut drawn = [besides; N];
    for k in 0..N {
        drawn[k] = loop {
            let index = rng.random_range(0..count);
            if index != besides && !drawn[..k].contains(&index) {
                break index;
            }
        };
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_draw_depends_only_on_its_address() {
        let draws = Draws::new(7, "paper/test 1");
        let first = draws.uniform(3, 4, 5);
        draws.uniform(1, 1, 1);
        assert_eq!(first, draws.uniform(3, 4, 5));
        let others = [
            Draws::new(8, "paper/test 1").uniform(3, 4, 5),
            Draws::new(7, "paper/test 2").uniform(3, 4, 5),
            draws.uniform(4, 4, 5),
            draws.uniform(3, 5, 5),
            draws.uniform(3, 4, 6),
        ];
        assert!(others.iter().all(|other| *other != first), "{first} in {others:?}");
    }

    #[test]
    fn analytic_drawn_indices_differ_from_each_other_and_from_the_target() {
        let draws = Draws::new(1, "");
        for candidate in 0..200 {
            let [a, b, c] = different::<3>(&mut draws.of(0, candidate, 0), 4, 2);
            assert!(a != b && b != c && a != c && [a, b, c].iter().all(|i| *i != 2 && *i < 4));
        }
    }
}

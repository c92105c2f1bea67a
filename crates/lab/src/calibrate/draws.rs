//! Random numbers that depend only on seed, search, generation, candidate and variable.
//!
//! Every candidate of every generation has its own stream of ChaCha8, and every variable its own place in it, so a draw
//! is the same whatever was drawn before, on whatever thread.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

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

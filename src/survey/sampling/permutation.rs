//! A random order of 0 … n - 1 of which any place can be computed alone, in no memory.
//!
//! A Feistel network permutes the numbers of an even number of bits; places it sends to n or beyond are sent on until
//! they land below n (cycle walking; Black & Rogaway 2002, "Ciphers with arbitrary finite domains").

use super::random::{Purpose, bits, mix};

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

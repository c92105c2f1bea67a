//! Numbers in (0, 1) that depend on the seed, the index and the variable alone.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Streams of one seed, kept apart for each variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// The uniform number itself.
    Draw,
    /// The place inside a stratum.
    Jitter,
    /// Keys of permutations and scrambles.
    Key,
}

/// 64 random bits: word `index` of the stream of (`seed`, `variable`, `purpose`), reached without those before it.
pub(super) fn bits(seed: u64, index: u64, variable: usize, purpose: Purpose) -> u64 {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(4 * variable as u64 + purpose as u64);
    // A number takes two words of 32 bits.
    rng.set_word_pos(2 * u128::from(index));
    rng.next_u64()
}

/// The middle of one of 2^`digits` equal cells of (0, 1), `digits` at most 52: never 0 and never 1.
pub(super) fn unit(bits: u64, digits: u32) -> f64 {
    ((bits >> (64 - digits)) as f64 + 0.5) / (1u64 << digits) as f64
}

/// A good mixture of 64 bits (Steele, Lea & Flood 2014, SplitMix64's finaliser by Stafford).
pub(super) fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_first_number_of_splitmix64() {
        // The reference implementation's first output for the seed 1234567.
        assert_eq!(mix(1_234_567), 6_457_827_717_110_365_317);
    }

    #[test]
    fn analytic_a_word_is_the_same_alone_and_in_its_stream() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        rng.set_stream(8);
        let stream: Vec<u64> = (0..100).map(|_| rng.next_u64()).collect();
        let alone: Vec<u64> = (0..100).map(|index| bits(5, index, 2, Purpose::Draw)).collect();
        assert_eq!(stream, alone);
        assert_ne!(bits(5, 0, 2, Purpose::Jitter), alone[0]);
        assert_ne!(bits(5, 0, 1, Purpose::Draw), alone[0]);
    }

    #[test]
    fn analytic_units_lie_inside() {
        assert!(unit(0, 52) > 0.0 && unit(u64::MAX, 52) < 1.0);
        assert_eq!(unit(u64::MAX, 1), 0.75);
    }
}

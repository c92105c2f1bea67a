//! Sobol's sequence, scrambled as Owen (1995) does: any point alone, 2³² of them.
//!
//! Direction numbers of Joe & Kuo (2008), "Constructing Sobol sequences with better two-dimensional projections", SIAM
//! J. Sci. Comput. 30, table new-joe-kuo-6. The scramble flips each binary digit by a hash of the digits before it. So
//! every scrambled point is uniform and the strata of the sequence stay what they are.
//!
//! The hashes also give numbers in (0, 1) that depend on the seed, the index and the variable alone.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Dimensions there are direction numbers for.
pub(super) const DIMENSIONS: usize = 40;

/// 2³²: points of the sequence, and cells of (0, 1) they lie in the middle of.
pub(super) const POINTS: f64 = 4_294_967_296.0;

/// Degree s, coefficients a and first direction numbers m of dimensions 2, 3, …
const TABLE: [(u32, u32, [u32; 8]); DIMENSIONS - 1] = [
    (1, 0, [1, 0, 0, 0, 0, 0, 0, 0]),
    (2, 1, [1, 3, 0, 0, 0, 0, 0, 0]),
    (3, 1, [1, 3, 1, 0, 0, 0, 0, 0]),
    (3, 2, [1, 1, 1, 0, 0, 0, 0, 0]),
    (4, 1, [1, 1, 3, 3, 0, 0, 0, 0]),
    (4, 4, [1, 3, 5, 13, 0, 0, 0, 0]),
    (5, 2, [1, 1, 5, 5, 17, 0, 0, 0]),
    (5, 4, [1, 1, 5, 5, 5, 0, 0, 0]),
    (5, 7, [1, 1, 7, 11, 19, 0, 0, 0]),
    (5, 11, [1, 1, 5, 1, 1, 0, 0, 0]),
    (5, 13, [1, 1, 1, 3, 11, 0, 0, 0]),
    (5, 14, [1, 3, 5, 5, 31, 0, 0, 0]),
    (6, 1, [1, 3, 3, 9, 7, 49, 0, 0]),
    (6, 13, [1, 1, 1, 15, 21, 21, 0, 0]),
    (6, 16, [1, 3, 1, 13, 27, 49, 0, 0]),
    (6, 19, [1, 1, 1, 15, 7, 5, 0, 0]),
    (6, 22, [1, 3, 1, 15, 13, 25, 0, 0]),
    (6, 25, [1, 1, 5, 5, 19, 61, 0, 0]),
    (7, 1, [1, 3, 7, 11, 23, 15, 103, 0]),
    (7, 4, [1, 3, 7, 13, 13, 15, 69, 0]),
    (7, 7, [1, 1, 3, 13, 7, 35, 63, 0]),
    (7, 8, [1, 3, 5, 9, 1, 25, 53, 0]),
    (7, 14, [1, 3, 1, 13, 9, 35, 107, 0]),
    (7, 19, [1, 3, 1, 5, 27, 61, 31, 0]),
    (7, 21, [1, 1, 5, 11, 19, 41, 61, 0]),
    (7, 28, [1, 3, 5, 3, 3, 13, 69, 0]),
    (7, 31, [1, 1, 7, 13, 1, 19, 1, 0]),
    (7, 32, [1, 3, 7, 5, 13, 19, 59, 0]),
    (7, 37, [1, 1, 3, 9, 25, 29, 41, 0]),
    (7, 41, [1, 3, 5, 13, 23, 1, 55, 0]),
    (7, 42, [1, 3, 7, 3, 13, 59, 17, 0]),
    (7, 50, [1, 3, 1, 3, 5, 53, 69, 0]),
    (7, 55, [1, 1, 5, 5, 23, 33, 13, 0]),
    (7, 56, [1, 1, 7, 7, 1, 61, 123, 0]),
    (7, 59, [1, 1, 7, 9, 13, 61, 49, 0]),
    (7, 62, [1, 3, 3, 5, 3, 55, 33, 0]),
    (8, 14, [1, 3, 1, 15, 31, 13, 49, 245]),
    (8, 21, [1, 3, 5, 15, 31, 59, 63, 97]),
    (8, 22, [1, 3, 1, 11, 11, 11, 77, 249]),
];

/// One dimension of the sequence and its scramble.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Dimension {
    directions: [u32; 32],
    key: u64,
}

impl Dimension {
    /// Dimension `number`, from 0 and below [`DIMENSIONS`], scrambled by a seed.
    pub fn new(number: usize, seed: u64) -> Self {
        Self { directions: directions(number), key: bits(seed, 0, number, Purpose::Key) }
    }

    /// Point `index` in (0, 1).
    pub fn at(&self, index: u32) -> f64 {
        (f64::from(self.scrambled(self.plain(index))) + 0.5) / POINTS
    }

    /// The point before the scramble, as a binary fraction of 32 digits.
    fn plain(&self, index: u32) -> u32 {
        let set = self.directions.iter().enumerate().filter(|(i, _)| index >> i & 1 == 1);
        set.fold(0, |x, (_, direction)| x ^ direction)
    }

    fn scrambled(&self, x: u32) -> u32 {
        let flips = (0..u32::BITS).map(|digit| {
            // The digits before this one, with a leading 1 that tells how many they are.
            let before = (1u64 << digit) | (u64::from(x) >> (u32::BITS - digit));
            ((mix(self.key ^ mix(before)) >> 63) as u32) << (31 - digit)
        });
        x ^ flips.sum::<u32>()
    }
}

/// v_i = m_i 2^(32 - i) by the recurrence of the dimension's primitive polynomial (Joe & Kuo 2008, Eq. 3).
fn directions(number: usize) -> [u32; 32] {
    let mut v = [0u32; 32];
    let Some(&(degree, coefficients, first)) = number.checked_sub(1).and_then(|i| TABLE.get(i)) else {
        // The first dimension: van der Corput's sequence.
        return std::array::from_fn(|i| 1 << (31 - i));
    };
    let s = degree as usize;
    for i in 0..32 {
        v[i] = if i < s {
            first[i] << (31 - i)
        } else {
            let sum = v[i - s] ^ (v[i - s] >> s);
            let terms = (1..s).filter(|k| coefficients >> (s - 1 - k) & 1 == 1);
            terms.fold(sum, |sum, k| sum ^ v[i - k])
        };
    }
    v
}

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
    fn verified_points_before_the_scramble() {
        // tests/python/sampling_reference.py: scipy.stats.qmc.Sobol(40, scramble=False), scipy 1.17.1.
        // In units of 2⁻¹⁴, which the first 2¹⁴ points are whole multiples of.
        let point_13448: [u32; DIMENSIONS] = [
            1_099, 15_097, 16_101, 5_561, 3_659, 2_211, 823, 11_911, 5_879, 16_285, 13_055, 7_205, 3_235,
            8_185, 4_443, 8_173, 10_559, 1_149, 7_775, 8_481, 1_635, 3_297, 14_103, 8_877, 9_337, 16_323,
            5_499, 3_771, 5_507, 12_897, 12_215, 1_009, 1_089, 8_177, 16_327, 10_733, 6_197, 13_899, 13_077,
            2_637,
        ];
        let point_15 = [0.9375, 0.0625, 0.6875, 0.1875, 0.3125, 0.5625, 0.1875, 0.1875, 0.1875, 0.5625];
        let found = |number: usize, index| f64::from(Dimension::new(number, 0).plain(index)) / 2f64.powi(32);
        for (number, expected) in point_15.into_iter().enumerate() {
            assert_eq!(found(number, 15), expected, "dimension {number}");
        }
        for (number, expected) in point_13448.into_iter().enumerate() {
            assert_eq!(found(number, 13_448) * 2f64.powi(14), f64::from(expected), "dimension {number}");
        }
    }

    #[test]
    fn analytic_the_scramble_keeps_every_stratum() {
        for number in 0..DIMENSIONS {
            let dimension = Dimension::new(number, 77);
            let mut strata = [0; 64];
            // Any 64 points that begin at a multiple of 64.
            (128..192).for_each(|index| strata[(dimension.at(index) * 64.0) as usize] += 1);
            assert_eq!(strata, [1; 64], "dimension {number}");
        }
        // The first two dimensions are a (0, m, 2)-net: one point a box of 4 × 16.
        let (x, y) = (Dimension::new(0, 3), Dimension::new(1, 3));
        let mut boxes = [[0; 16]; 4];
        (0..64).for_each(|i| boxes[(x.at(i) * 4.0) as usize][(y.at(i) * 16.0) as usize] += 1);
        assert_eq!(boxes, [[1; 16]; 4]);
    }

    #[test]
    fn analytic_a_scrambled_point_is_uniform_over_seeds() {
        let counts = (0..4000).fold([0u32; 8], |mut counts, seed| {
            counts[(Dimension::new(3, seed).at(5) * 8.0) as usize] += 1;
            counts
        });
        let chi: f64 = counts.iter().map(|&count| (f64::from(count) - 500.0).powi(2) / 500.0).sum();
        // χ² with 7 degrees of freedom is beyond 24.3 once in a thousand.
        assert!(chi < 24.3, "{counts:?}");
    }

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

//! Powers of positive numbers, of one or of those of several walls side by side, with the same bits on every machine.
//!
//! x^n = exp(n ln x), with ln x as a sum of two numbers: an exponent of ten makes ten times its error one of the power. Of x = m 2^e, m
//! from √½ to √2, ln m = 2 artanh s with s = (m - 1)/(m + 1), by its series; exp by its own, over half a doubling to either side. A power
//! that is a number (4^1.5, x^1) is that number: what comes before the last rounding is off by less than half of it.

use std::ops::{Add, Div, Mul, Sub};

use fearless_simd::{Bytes, Simd, SimdBase, SimdFloat, SimdMask, f64x4, f64x8, i64x4, i64x8};

use crate::lanes::Lanes;

/// What powers calculate with.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same constant beside this number.
    fn beside(self, value: f64) -> Self;
    /// This number times a factor, less another, rounded once.
    fn times_less(self, factor: Self, other: Self) -> Self;
    /// e and m of m 2^e, m from √½ to √2, of a normal positive number.
    fn parts(self) -> (Self, Self);
    /// This number times 2^k, for a whole k and a product that is normal.
    fn times_two_to(self, k: Self) -> Self;
}

/// Added to a number of up to 51 bits this leaves the nearest whole one in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;
const BITS_OF_WHOLE: i64 = WHOLE.to_bits().cast_signed();
/// Bits of 1, and of √½, rounded.
const BITS_OF_ONE: i64 = 1.0_f64.to_bits().cast_signed();
const BITS_OF_ROOT: i64 = std::f64::consts::FRAC_1_SQRT_2.to_bits().cast_signed();
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// ln 2 in two parts; the first has 42 bits, so that its product with an exponent is exact.
const LN_2_HIGH: f64 = f64::from_bits(std::f64::consts::LN_2.to_bits() & !0x7ff);
const LN_2_LOW: f64 = std::f64::consts::LN_2 - LN_2_HIGH + LN_2_BEYOND;
/// ln 2 less its nearest number.
const LN_2_BEYOND: f64 = 2.319_046_813_846_299_6e-17;
/// Up to which n ln x a power, and its reciprocal, is a normal number.
const LARGEST_LOGARITHM: f64 = 700.0;

/// 2/3, 2/5, 2/7, …: ln m = 2 s + s³ (2/3 + 2/5 s² + …). What comes after them is below 1e-18 of 2 s.
const OF_LN: [f64; 10] = of_ln();
/// 1/2!, 1/3!, …: exp r = 1 + r + r² (1/2! + r/3! + …). What comes after them is below 5e-18.
const OF_EXP: [f64; 12] = of_exp();

const fn of_ln() -> [f64; 10] {
    let mut c = [0.0; 10];
    let mut k = 0;
    while k < c.len() {
        c[k] = 2.0 / (2 * k + 3) as f64;
        k += 1;
    }
    c
}

const fn of_exp() -> [f64; 12] {
    let mut c = [0.0; 12];
    let (mut k, mut factorial) = (0, 1.0);
    while k < c.len() {
        factorial *= (k + 2) as f64;
        c[k] = 1.0 / factorial;
        k += 1;
    }
    c
}

/// c_k + c_{k+1} z.
#[inline(always)]
fn pair<N: Real>(c: &[f64], k: usize, z: N) -> N {
    z.beside(c[k]) + z * z.beside(c[k + 1])
}

/// The sum of c_k z^k, pairs of neighbours first: they wait for each other less.
#[inline(always)]
fn polynomial<N: Real, const COUNT: usize>(c: &[f64; COUNT], z: N) -> N {
    const { assert!(COUNT.is_multiple_of(2)) };
    let z_2 = z * z;
    let z_4 = z_2 * z_2;
    let mut k = COUNT - 4;
    let mut sum = pair(c, k, z) + z_2 * pair(c, k + 2, z);
    while k >= 4 {
        k -= 4;
        sum = (pair(c, k, z) + z_2 * pair(c, k + 2, z)) + z_4 * sum;
    }
    if k == 2 { pair(c, 0, z) + z_2 * sum } else { sum }
}

/// x^n of normal positive numbers, and n ln x, up to which size of that the power is one.
#[inline(always)]
fn regular<N: Real>(x: N, n: N) -> (N, N) {
    let (zero, one) = (x.beside(0.0), x.beside(1.0));
    let [ln_2_high, ln_2_low] = [x.beside(LN_2_HIGH), x.beside(LN_2_LOW)];
    let (e, m) = x.parts();
    // s, and what its rounding and that of m + 1 lost.
    let (f, t) = (m - one, m + one);
    let t_lost = m - (t - one);
    let inverse = one / t;
    let s = f * inverse;
    let s_lost = (zero - (s.times_less(t, f) + s * t_lost)) * inverse;
    let z = s * s;
    let beyond = s * z * polynomial(&OF_LN, z);
    // ln x, the larger part first.
    let (whole, twice) = (e * ln_2_high, s + s);
    let sum = whole + twice;
    let lost = twice - (sum - whole);
    let rest = lost + (e * ln_2_low + ((s_lost + s_lost) + beyond));
    let ln = sum + rest;
    let ln_lost = rest - (ln - sum);
    // n ln x = k ln 2 + r.
    let y = n * ln;
    let y_lost = n.times_less(ln, y) + n * ln_lost;
    let k = (y * x.beside(std::f64::consts::LOG2_E) + x.beside(WHOLE)) - x.beside(WHOLE);
    let near = y - k * ln_2_high;
    let apart = y_lost - k * ln_2_low;
    let r = near + apart;
    let r_lost = apart - (r - near);
    let one_and_r = one + r;
    let lost = r - (one_and_r - one);
    let power = one_and_r + (lost + (r_lost + r * r * polynomial(&OF_EXP, r)));
    (power.times_two_to(k), y)
}

/// x^n of a number that is not negative; as [`libm::pow`] where x is zero or no normal number, or the power is none.
pub(crate) fn power(x: f64, n: f64) -> f64 {
    if !(f64::MIN_POSITIVE..=f64::MAX).contains(&x) {
        return libm::pow(x, n);
    }
    let (power, y) = regular(x, n);
    if y.abs() <= LARGEST_LOGARITHM { power } else { libm::pow(x, n) }
}

/// The same of every lane.
#[inline(always)]
pub(crate) fn powers<F: Lanes>(x: F, n: F) -> F {
    let (powers, y) = regular(x, n);
    let is_regular = x.simd_ge(f64::MIN_POSITIVE) & x.simd_le(f64::MAX) & y.abs().simd_le(LARGEST_LOGARITHM);
    if is_regular.all_true() { powers } else { powers_one_by_one(x, n) }
}

#[cold]
fn powers_one_by_one<F: Lanes>(x: F, n: F) -> F {
    F::of_each(x.token(), |i| power(x[i], n[i]))
}

impl Real for f64 {
    #[inline(always)]
    fn beside(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn times_less(self, factor: Self, other: Self) -> Self {
        self.mul_add(factor, -other)
    }
    #[inline(always)]
    fn parts(self) -> (Self, Self) {
        let bits = self.to_bits().cast_signed();
        let e = (bits - BITS_OF_ROOT) >> FRACTION_BITS;
        let m = bits - (e << FRACTION_BITS);
        let real = |bits: i64| Self::from_bits(bits.cast_unsigned());
        (real(e + BITS_OF_WHOLE) - WHOLE, real(m))
    }
    #[inline(always)]
    fn times_two_to(self, k: Self) -> Self {
        let k = (k + WHOLE).to_bits().cast_signed() - BITS_OF_WHOLE;
        self * Self::from_bits(((k << FRACTION_BITS) + BITS_OF_ONE).cast_unsigned())
    }
}

macro_rules! real_lanes {
    ($lanes:ident, $bits:ident) => {
        impl<S: Simd> Real for $lanes<S> {
            #[inline(always)]
            fn beside(self, value: f64) -> Self {
                Self::splat(self.simd, value)
            }
            #[inline(always)]
            fn times_less(self, factor: Self, other: Self) -> Self {
                self.mul_sub_precise(factor, other)
            }
            #[inline(always)]
            fn parts(self) -> (Self, Self) {
                let bits = self.bitcast::<$bits<S>>();
                let e = (bits - BITS_OF_ROOT) >> FRACTION_BITS;
                let m = bits - (e << FRACTION_BITS);
                ((e + BITS_OF_WHOLE).bitcast::<Self>() - WHOLE, m.bitcast())
            }
            #[inline(always)]
            fn times_two_to(self, k: Self) -> Self {
                let k = (k + WHOLE).bitcast::<$bits<S>>() - BITS_OF_WHOLE;
                self * ((k << FRACTION_BITS) + BITS_OF_ONE).bitcast::<Self>()
            }
        }
    };
}

real_lanes!(f64x4, i64x4);
real_lanes!(f64x8, i64x8);

#[cfg(test)]
pub(crate) mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::lanes::MOST_LANES;

    /// The vector instructions of this processor, and those of lesser ones that it has too.
    pub(crate) fn levels() -> Vec<Level> {
        let best = Level::new();
        #[cfg(target_arch = "x86_64")]
        let others = [best.as_sse2().map(Simd::level), best.as_avx2().map(Simd::level)];
        #[cfg(not(target_arch = "x86_64"))]
        let others = [Some(Level::baseline())];
        std::iter::once(best).chain(others.into_iter().flatten()).collect()
    }

    /// Numbers over many doublings, among them some next to 1 and whole ones, and exponents.
    fn pairs() -> impl Iterator<Item = (f64, f64)> {
        let xs =
            (-600..600).map(|k| 1.37_f64.powi(k)).chain((1..200).map(|k| 1.0 + f64::from(k - 100) * 1e-4));
        let xs = xs.chain((1..100).map(f64::from)).chain([1.0 + f64::EPSILON, 1.0 - f64::EPSILON / 2.0]);
        let ns = (-40..=40).map(|k| 0.17 * f64::from(k)).chain([0.0, 0.5, 1.0, 1.05, 1.5, 2.0, 3.0, 64.5]);
        xs.flat_map(move |x| ns.clone().map(move |n| (x, n)))
    }

    /// Of how many units in the last place two numbers of one sign differ.
    fn apart(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    #[test]
    fn verified_powers_are_those_of_another_library() {
        // Each is off by less than one unit in the last place.
        let off = pairs().map(|(x, n)| (apart(power(x, n), libm::pow(x, n)), x, n)).max_by_key(|off| off.0);
        let (off, x, n) = off.expect("pairs");
        assert!(off <= 1, "{x}^{n} is {off} units off");
    }

    #[test]
    fn analytic_a_power_that_is_a_number_is_that_number() {
        for k in 1..2000 {
            let x = f64::from(k) / 64.0;
            assert_eq!(power(x, 1.0), x);
            assert_eq!(power(x, 2.0), x * x);
            assert_eq!(power(x * x, 0.5), x);
            assert_eq!(power(x * x, 1.5), x * x * x);
            assert_eq!(power(x, 0.0), 1.0);
        }
        for k in -1020..1020 {
            assert_eq!(power(2.0, f64::from(k)), libm::pow(2.0, f64::from(k)));
        }
    }

    #[test]
    fn analytic_what_is_no_power_is_as_in_the_library() {
        let odd = [0.0, -0.0, 5e-324, 1e-310, f64::INFINITY, f64::NAN, -2.0, 1e-300, 1e300];
        for x in odd {
            for n in [0.0, 0.5, 1.0, 2.0, -1.0, 900.0, -900.0, f64::INFINITY, f64::NAN] {
                let [own, other] = [power(x, n), libm::pow(x, n)];
                assert!(
                    own.to_bits() == other.to_bits()
                        || own.is_nan() && other.is_nan()
                        || apart(own, other) <= 1
                );
            }
        }
    }

    #[test]
    fn analytic_lanes_have_the_bits_of_one_number() {
        let all = pairs().chain([(0.0, 1.5), (1e-310, 0.3), (2.0, 1e4)]).collect::<Vec<_>>();
        for pairs in all.chunks_exact(MOST_LANES) {
            let alone = pairs.iter().map(|(x, n)| power(*x, *n).to_bits()).collect::<Vec<_>>();
            for level in levels() {
                let four = dispatch!(level, simd => bits_of_powers::<f64x4<_>>(simd, pairs));
                let eight = dispatch!(level, simd => bits_of_powers::<f64x8<_>>(simd, pairs));
                assert_eq!((&four[..], &eight[..]), (&alone[..4], &alone[..]), "{pairs:?} by {level:?}");
            }
        }
    }

    fn bits_of_powers<F: Lanes>(simd: F::Token, pairs: &[(f64, f64)]) -> Vec<u64> {
        let [x, n] = [F::of_each(simd, |i| pairs[i].0), F::of_each(simd, |i| pairs[i].1)];
        powers(x, n).as_slice().iter().map(|power| power.to_bits()).collect()
    }
}

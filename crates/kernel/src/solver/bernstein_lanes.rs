//! Roots of several polynomials in Bernstein form side by side; the same sums in the same order as in [`super::Bernstein`].

use fearless_simd::{Select, SimdMask};

use super::bernstein::{MOST_CORRECTIONS, SAME_SHARE, binomials, taylor};
use crate::lanes::Wide;

/// Which polynomials are positive at their start and negative at their end, with one change of sign between.
#[inline(always)]
pub(crate) fn turn_negative_once<F: Wide, const N: usize>(c: &[F; N]) -> F::Mask {
    let mut once = c[0].simd_gt(0.0) & c[N - 1].simd_lt(0.0);
    for i in 1..N - 1 {
        once &= c[i].simd_gt(0.0) | c[i + 1].simd_lt(0.0);
    }
    once
}

/// Shares at which those of `which` do, as [`super::Bernstein::first_root`] has it. Others have any.
#[inline(always)]
pub(crate) fn only_roots<F: Wide, const N: usize>(which: F::Mask, c: &[F; N]) -> F {
    let (simd, powers) = (c[0].token(), powers(c));
    let none = F::splat(simd, 0.0);
    let (mut low, mut high) = (none, F::splat(simd, 1.0));
    let (mut share, mut open) = (c[0] / (c[0] - c[N - 1]), which);
    for _ in 0..MOST_CORRECTIONS {
        let [value, slope, second, third] = taylor(&powers, share, none);
        let above = value.simd_ge(0.0);
        (low, high) = (above.select(share, low), above.select(high, share));
        let square = slope * slope;
        let halley = share - value * slope / (square - value * second);
        let is_inside = halley.simd_gt(low) & halley.simd_lt(high);
        let next = is_inside.select(halley, (low + high) * 0.5);
        let moved = (next - share).abs();
        let cubed = moved * moved * moved * (second * second + (third * slope).abs());
        let found = moved.simd_le(SAME_SHARE)
            | (high - low).simd_le(SAME_SHARE)
            | (is_inside & cubed.simd_le(square * SAME_SHARE));
        share = open.select(next, share);
        open &= !found;
        if !open.any_true() {
            break;
        }
    }
    share
}

/// As [`super::Bernstein`] has the coefficients of the powers.
#[inline(always)]
fn powers<F: Wide, const N: usize>(c: &[F; N]) -> [F; N] {
    let mut differences = *c;
    for k in 1..N {
        for i in (k..N).rev() {
            differences[i] -= differences[i - 1];
        }
    }
    let choose = const { binomials::<N>() };
    for k in 0..N {
        differences[k] *= choose[k];
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instructions::{dispatch_lanes, lanes_pay};
    use crate::lanes::{LANES, Wide};
    use crate::solver::Bernstein;
    use fearless_simd::Level;

    /// Which of the first few fall once, and where.
    #[inline(always)]
    fn side_by_side<F: Wide>(simd: F::Token, falls: &[Bernstein<6>]) -> Vec<Option<f64>> {
        let c: [F; 6] = std::array::from_fn(|k| F::of_each(simd, |i| falls[i].0[k]));
        let once = turn_negative_once(&c);
        let (bits, roots) = (once.to_bitmask(), only_roots(once, &c));
        (0..F::LEN).map(|i| (bits >> i & 1 == 1).then_some(roots[i])).collect()
    }

    #[test]
    fn analytic_roots_side_by_side_have_the_bits_of_each() {
        let level = Level::new();
        if !lanes_pay(level) {
            return;
        }
        // Falls of all steepnesses: some turn back before, some are all but flat where they cross.
        let falls = (0..4000).map(|n: u64| {
            let digit = |k: u64| ((n * n + 7 * n + 11) * (2 * k + 3) % 1009) as f64 / 1009.0;
            let start = 1e-3 + digit(0);
            Bernstein([start, digit(1) - 0.2, digit(2) - 0.4, digit(3) - 0.6, -digit(4), -1e-4 - digit(5)])
        });
        let falls: Vec<_> = falls.collect();
        let (mut crossing, mut others) = (0, 0);
        for falls in falls.chunks_exact(LANES) {
            let four = dispatch_lanes!(level, Four of f64x4, simd => side_by_side::<Four<_>>(simd, falls));
            let most = dispatch_lanes!(level, Most of f64x8, simd => side_by_side::<Most<_>>(simd, falls));
            for (fall, root) in falls.iter().zip(four).chain(falls.iter().zip(most)) {
                if root.is_some() {
                    crossing += 1;
                    assert_eq!(fall.first_root(), root, "{fall:?}");
                } else {
                    others += 1;
                }
            }
        }
        assert!(crossing > 500 && others > 500, "{crossing} cross once, {others} do not");
    }
}

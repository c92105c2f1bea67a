//! Roots of several polynomials in Bernstein form side by side; the same sums in the same order as in [`super::Bernstein`].

use fearless_simd::{Select, Simd, SimdBase, SimdMask, f64x4, mask64x4};

use super::bernstein::{MOST_CORRECTIONS, SAME_SHARE, binomials, taylor};

type F<S> = f64x4<S>;

/// Which polynomials are positive at their start and negative at their end, with one change of sign between.
#[inline(always)]
pub(crate) fn turn_negative_once<S: Simd, const N: usize>(c: &[F<S>; N]) -> mask64x4<S> {
    let mut once = c[0].simd_gt(0.0) & c[N - 1].simd_lt(0.0);
    for i in 1..N - 1 {
        once &= c[i].simd_gt(0.0) | c[i + 1].simd_lt(0.0);
    }
    once
}

/// Shares at which those of `which` do, as [`super::Bernstein::first_root`] has it. Others have any.
#[inline(always)]
pub(crate) fn only_roots<S: Simd, const N: usize>(which: mask64x4<S>, c: &[F<S>; N]) -> F<S> {
    let (simd, powers) = (c[0].simd, powers(c));
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
fn powers<S: Simd, const N: usize>(c: &[F<S>; N]) -> [F<S>; N] {
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
    use crate::lanes::{LANES, lanes};
    use crate::solver::Bernstein;
    use fearless_simd::Level;

    /// Which of four fall once, and where.
    #[inline(always)]
    fn side_by_side<S: Simd>(simd: S, four: &[Bernstein<6>]) -> (u64, [f64; LANES]) {
        let c: [F<S>; 6] = std::array::from_fn(|k| lanes(simd, |i| four[i].0[k]));
        let once = turn_negative_once(&c);
        (once.to_bitmask(), only_roots(once, &c).into())
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
        for four in falls.chunks_exact(LANES) {
            let (once, roots) = dispatch_lanes!(level, simd => side_by_side(simd, four));
            for i in 0..LANES {
                if once >> i & 1 == 1 {
                    crossing += 1;
                    assert_eq!(four[i].first_root(), Some(roots[i]), "{:?}", four[i]);
                } else {
                    others += 1;
                }
            }
        }
        assert!(crossing > 500 && others > 500, "{crossing} cross once, {others} do not");
    }
}

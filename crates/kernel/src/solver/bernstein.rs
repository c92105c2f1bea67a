//! Polynomials over a step in Bernstein form, whose coefficients bound them: crossings cannot slip through.

use std::ops::{Add, Mul};

/// Coefficients of a polynomial of degree N - 1 over [0, 1] in the Bernstein basis.
///
/// The polynomial starts at the first coefficient, ends at the last, and stays between the smallest and the largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bernstein<const N: usize>(pub [f64; N]);

/// Halvings after which a pair of roots that has not come apart counts as a touch, not a crossing.
const MOST_HALVINGS: u32 = 40;

/// Shares nearer than this are one: a root is known no better, because coefficients carry roundings.
pub(super) const SAME_SHARE: f64 = 1e-14;

/// Corrections of a root, more than halving takes.
pub(super) const MOST_CORRECTIONS: u32 = 80;

impl<const N: usize> Bernstein<N> {
    /// Value at a share of the interval (de Casteljau).
    #[inline]
    pub fn value(&self, share: f64) -> f64 {
        let mut c = self.0;
        for width in (1..N).rev() {
            for i in 0..width {
                c[i] += share * (c[i + 1] - c[i]);
            }
        }
        c[0]
    }

    /// The same polynomial times a factor.
    #[must_use]
    #[inline]
    pub fn times(&self, factor: f64) -> Self {
        Self(self.0.map(|c| c * factor))
    }

    /// A number less the polynomial.
    #[must_use]
    #[inline]
    pub fn below(&self, limit: f64) -> Self {
        Self(self.0.map(|c| limit - c))
    }

    /// Whether the coefficients prove the polynomial positive, its end included; its start may be zero.
    #[inline]
    pub fn is_surely_positive(&self) -> bool {
        self.0[1..].iter().all(|c| *c > 0.0) && self.0[0] >= 0.0
    }

    /// Bound on the magnitude.
    #[inline]
    pub fn magnitude_bound(&self) -> f64 {
        self.0.iter().fold(0.0, |bound, c| f64::max(bound, c.abs()))
    }

    /// Left and right halves, each over [0, 1].
    fn halves(&self) -> (Self, Self) {
        let (mut left, mut right) = (self.0, self.0);
        for width in (1..N).rev() {
            for i in 0..width {
                right[i] = 0.5 * (right[i] + right[i + 1]);
            }
            left[N - width] = right[0];
        }
        (Self(left), Self(right))
    }

    fn sign_changes(&self) -> usize {
        let mut changes = 0;
        let mut last = self.0[0];
        for &c in &self.0[1..] {
            if c != 0.0 {
                changes += usize::from((c < 0.0) != (last < 0.0) && last != 0.0);
                last = c;
            }
        }
        changes
    }

    /// Share at which the polynomial, positive at its start, first turns negative; `None` if it does not.
    ///
    /// The root is right to a few roundings of one. A touch without crossing is no root.
    pub fn first_root(&self) -> Option<f64> {
        self.root_in(0.0, 1.0, MOST_HALVINGS)
    }

    fn root_in(&self, from: f64, to: f64, halvings: u32) -> Option<f64> {
        if self.0[0] < 0.0 {
            return Some(from);
        }
        let negative_end = self.0[N - 1] < 0.0;
        match self.sign_changes() {
            0 => return None,
            1 if negative_end => return Some(from + (to - from) * self.only_root()),
            _ if halvings == 0 => return negative_end.then_some(to),
            _ => {}
        }
        let (left, right) = self.halves();
        let middle = 0.5 * (from + to);
        left.root_in(from, middle, halvings - 1).or_else(|| right.root_in(middle, to, halvings - 1))
    }

    /// The root of a polynomial with one change of sign: Halley, kept inside a shrinking bracket.
    fn only_root(&self) -> f64 {
        let powers = self.powers();
        let (mut low, mut high) = (0.0, 1.0);
        let (first, last) = (self.0[0], self.0[N - 1]);
        let mut share = first / (first - last);
        for _ in 0..MOST_CORRECTIONS {
            let [value, slope, second, third] = taylor(&powers, share, 0.0);
            if value >= 0.0 {
                low = share
            } else {
                high = share
            }
            let square = slope * slope;
            let halley = share - value * slope / (square - value * second);
            let is_inside = halley > low && halley < high;
            let next = if is_inside { halley } else { 0.5 * (low + high) };
            let moved = (next - share).abs();
            // What Halley's next correction would be: a share of its cube.
            let cubed = moved * moved * moved * (second * second + (third * slope).abs());
            if moved <= SAME_SHARE || high - low <= SAME_SHARE || (is_inside && cubed <= SAME_SHARE * square)
            {
                return next;
            }
            share = next;
        }
        share
    }

    /// Coefficients of the powers of the share: C(n, k) Δ^k.
    #[inline]
    fn powers(&self) -> [f64; N] {
        let mut differences = self.0;
        for k in 1..N {
            for i in (k..N).rev() {
                differences[i] -= differences[i - 1];
            }
        }
        let choose = const { binomials::<N>() };
        std::array::from_fn(|k| differences[k] * choose[k])
    }
}

/// C(N - 1, k).
pub(super) const fn binomials<const N: usize>() -> [f64; N] {
    let (mut choose, mut k) = ([1.0; N], 1);
    while k < N {
        choose[k] = choose[k - 1] * (N - k) as f64 / k as f64;
        k += 1;
    }
    choose
}

/// Value and slope of a polynomial by its powers, and halves and sixths of its next derivatives (Horner), of one or of several side by
/// side; `none` is zero.
#[inline(always)]
pub(super) fn taylor<T, const N: usize>(powers: &[T; N], share: T, none: T) -> [T; 4]
where
    T: Copy + Add<Output = T> + Mul<Output = T>,
{
    let [mut value, mut slope, mut second, mut third] = [powers[N - 1], none, none, none];
    for k in (0..N - 1).rev() {
        third = third * share + second;
        second = second * share + slope;
        slope = slope * share + value;
        value = value * share + powers[k];
    }
    [value, slope, second, third]
}

impl Bernstein<6> {
    /// Derivative with respect to the share.
    #[inline]
    pub fn derivative(&self) -> Bernstein<5> {
        Bernstein(std::array::from_fn(|i| 5.0 * (self.0[i + 1] - self.0[i])))
    }

    /// First root after the start of a polynomial that may itself start at zero, with any slope that leads up.
    ///
    /// A zero at the start is divided out: once for a gap that opens at a speed, twice from rest.
    pub fn first_root_after_start(&self) -> Option<f64> {
        if self.0[0] > 0.0 {
            return self.first_root();
        }
        // p(x) = x q(x): q_i = n/(i+1) p_(i+1).
        let once: Bernstein<5> = Bernstein(std::array::from_fn(|i| self.0[i + 1] * 5.0 / (i + 1) as f64));
        if once.0[0] > 0.0 {
            return once.first_root();
        }
        let twice: Bernstein<4> = Bernstein(std::array::from_fn(|i| once.0[i + 1] * 4.0 / (i + 1) as f64));
        twice.first_root()
    }

    /// Largest value and the share at which it is reached. It lies where a slope that turns once vanishes,
    /// else halving finds it to roundings of the bound.
    pub fn maximum(&self) -> (f64, f64) {
        let mut best = if self.0[5] >= self.0[0] { (self.0[5], 1.0) } else { (self.0[0], 0.0) };
        let slope = self.derivative();
        if slope.0[0] > 0.0 && slope.0[4] < 0.0 && slope.sign_changes() == 1 {
            let share = slope.only_root();
            return (self.value(share).max(best.0), share);
        }
        self.raise_maximum(0.0, 1.0, &mut best, MOST_HALVINGS);
        best
    }

    fn raise_maximum(&self, from: f64, to: f64, best: &mut (f64, f64), halvings: u32) {
        let bound = self.0.iter().fold(f64::NEG_INFINITY, |bound, c| bound.max(*c));
        if bound <= best.0 + 4.0 * f64::EPSILON * best.0.abs() || halvings == 0 {
            return;
        }
        let (left, right) = self.halves();
        let middle = 0.5 * (from + to);
        if right.0[0] > best.0 {
            *best = (right.0[0], middle);
        }
        left.raise_maximum(from, middle, best, halvings - 1);
        right.raise_maximum(middle, to, best, halvings - 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein form of a polynomial given by its values, through monomials on [0, 1].
    fn from_monomials(a: [f64; 6]) -> Bernstein<6> {
        let choose = |n: u32, k: u32| (0..k).fold(1.0, |c, i| c * f64::from(n - i) / f64::from(i + 1));
        Bernstein(std::array::from_fn(|i| {
            (0..=i).map(|j| choose(i as u32, j as u32) / choose(5, j as u32) * a[j]).sum()
        }))
    }

    #[test]
    fn analytic_finds_a_dip_between_positive_ends() {
        // (x - 0.50)(x - 0.51): positive at both ends, negative on a hundredth in between.
        let p = from_monomials([0.255, -1.01, 1.0, 0.0, 0.0, 0.0]);
        let root = p.first_root().expect("the dip");
        // The two roots are a hundredth apart, so a rounding is magnified a hundredfold.
        assert!((root - 0.5).abs() < 1e-13, "{root}");
        assert!(!p.is_surely_positive());
    }

    #[test]
    fn analytic_a_touch_is_no_crossing() {
        assert_eq!(from_monomials([0.25 + 1e-9, -1.0, 1.0, 0.0, 0.0, 0.0]).first_root(), None);
    }

    #[test]
    fn analytic_ignores_the_zero_it_starts_from() {
        // x (0.3 - x): opens at a speed and closes again.
        let root = from_monomials([0.0, 0.3, -1.0, 0.0, 0.0, 0.0]).first_root_after_start().expect("closes");
        assert!((root - 0.3).abs() < 1e-15, "{root}");
        // x² (0.4 - x): opens from rest and closes again.
        let root = from_monomials([0.0, 0.0, 0.4, -1.0, 0.0, 0.0]).first_root_after_start().expect("closes");
        assert!((root - 0.4).abs() < 1e-15, "{root}");
        assert_eq!(from_monomials([0.0, 0.0, 0.4, 1.0, 0.0, 0.0]).first_root_after_start(), None);
    }

    #[test]
    fn analytic_maximum_between_samples() {
        // 1 - (x - 0.3)²
        let (value, share) = from_monomials([0.91, 0.6, -1.0, 0.0, 0.0, 0.0]).maximum();
        assert!((value - 1.0).abs() < 1e-14, "{value}");
        // The place of a flat maximum is known to the square root of a rounding.
        assert!((share - 0.3).abs() < 1e-7, "{share}");
    }
}

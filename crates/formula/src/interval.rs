//! Intervals: what a formula may be over a whole range of states, rounded outwards.

use crate::number::Number;
use crate::power::power;

/// All numbers from `low` to `high`; NaN in one of them where the result need not be a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

/// Results of the mathematical library are within a rounding: two are added on each side.
const ROUNDINGS: u32 = 2;

impl Interval {
    const NOTHING_KNOWN: Self = Self { low: f64::NAN, high: f64::NAN };

    /// From the least to the largest.
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Whether every number in it is finite.
    pub fn is_finite(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// Whether zero is in it.
    pub fn has_zero(self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// Its width.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// The hull of some numbers, rounded outwards.
    fn hull(numbers: &[f64], roundings: u32) -> Self {
        if numbers.iter().any(|x| x.is_nan()) {
            return Self::NOTHING_KNOWN;
        }
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self { low: (0..roundings).fold(low, down), high: (0..roundings).fold(high, up) }
    }

    fn rising(self, of: fn(f64) -> f64) -> Self {
        Self::hull(&[of(self.low), of(self.high)], ROUNDINGS)
    }
}

/// Zero and one are results without roundings.
fn down(x: f64, _: u32) -> f64 {
    if x == 0.0 { x } else { x.next_down() }
}

fn up(x: f64, _: u32) -> f64 {
    if x == 0.0 { x } else { x.next_up() }
}

impl Number for Interval {
    fn constant(value: f64) -> Self {
        Self { low: value, high: value }
    }
    fn add(self, other: Self) -> Self {
        if other == Self::constant(0.0) {
            return self;
        }
        Self::hull(&[self.low + other.low, self.high + other.high], 1)
    }
    fn mul(self, other: Self) -> Self {
        let zero = Self::constant(0.0);
        if (self == zero && other.is_finite()) || (other == zero && self.is_finite()) {
            return zero;
        }
        let products =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Self::hull(&products, 1)
    }
    fn div(self, other: Self) -> Self {
        if other.has_zero() {
            return Self::NOTHING_KNOWN;
        }
        self.mul(Self::hull(&[1.0 / other.low, 1.0 / other.high], 1))
    }
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
    fn powi(self, exponent: i32) -> Self {
        if exponent < 0 && self.has_zero() {
            return Self::NOTHING_KNOWN;
        }
        let ends = [self.low, self.high].map(|x| Number::powi(x, exponent));
        // A product of n factors has n - 1 roundings.
        let roundings = exponent.unsigned_abs();
        match exponent % 2 == 0 && exponent > 0 && self.low < 0.0 && self.high > 0.0 {
            true => Self::hull(&[0.0, ends[0], ends[1]], roundings),
            false => Self::hull(&ends, roundings),
        }
    }
    fn pow(self, exponent: Self) -> Self {
        let from_zero = self.low == 0.0 && exponent.low < 0.0;
        if self.low.is_nan() || self.low < 0.0 || from_zero {
            return Self::NOTHING_KNOWN;
        }
        let corner = |base: f64, exponent: f64| power(base, exponent);
        let corners = [
            corner(self.low, exponent.low),
            corner(self.low, exponent.high),
            corner(self.high, exponent.low),
            corner(self.high, exponent.high),
        ];
        Self::hull(&corners, ROUNDINGS)
    }
    fn sqrt(self) -> Self {
        if self.low >= 0.0 { self.rising(f64::sqrt) } else { Self::NOTHING_KNOWN }
    }
    fn exp(self) -> Self {
        self.rising(libm::exp)
    }
    fn tanh(self) -> Self {
        self.rising(libm::tanh)
    }
    fn atan(self) -> Self {
        self.rising(libm::atan)
    }
    fn abs(self) -> Self {
        let (low, high) = (self.low.abs(), self.high.abs());
        let most = low.max(high);
        match self.has_zero() {
            _ if self.low.is_nan() || self.high.is_nan() => Self::NOTHING_KNOWN,
            true => Self { low: 0.0, high: most },
            false => Self { low: low.min(high), high: most },
        }
    }
    fn sign(self) -> Self {
        Self { low: Number::sign(self.low), high: Number::sign(self.high) }
    }
    fn max(self, other: Self) -> Self {
        if [self.low, self.high, other.low, other.high].iter().any(|x| x.is_nan()) {
            return Self::NOTHING_KNOWN;
        }
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }
    fn not_negative(self) -> Self {
        self.max(Self::constant(0.0))
    }
    fn above(self, other: Self, or_equal: bool) -> Self {
        if [self.low, self.high, other.low, other.high].iter().any(|x| x.is_nan()) {
            return Self::NOTHING_KNOWN;
        }
        Self { low: self.low.above(other.high, or_equal), high: self.high.above(other.low, or_equal) }
    }
}

//! Numbers that a formula is evaluated with: values, values with their rate of change, intervals.

use crate::power::power;

/// A number and what a formula does to it.
pub trait Number: Copy {
    /// A constant.
    fn constant(value: f64) -> Self;
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// Quotient.
    fn div(self, other: Self) -> Self;
    /// Times -1, exactly.
    fn neg(self) -> Self;
    /// A whole power by squaring.
    fn powi(self, exponent: i32) -> Self;
    /// Any power of a number that is not negative.
    fn pow(self, exponent: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// -1, 0 or 1.
    fn sign(self) -> Self;
    /// The larger.
    fn max(self, other: Self) -> Self;
    /// The number, or zero in its place where it is negative.
    fn not_negative(self) -> Self;
    /// 1 where larger than another, or as large if `or_equal`; else 0.
    fn above(self, other: Self, or_equal: bool) -> Self;

    /// Difference.
    fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    /// The smaller.
    fn min(self, other: Self) -> Self {
        self.neg().max(other.neg()).neg()
    }
}

/// A whole power as a product: the bits do not depend on the machine.
pub fn whole_power<N: Number>(base: N, exponent: i32) -> N {
    let power = product_of_equals(base, exponent.unsigned_abs(), N::mul).unwrap_or_else(|| N::constant(1.0));
    if exponent < 0 { N::constant(1.0).div(power) } else { power }
}

/// The product of so many equal factors by squaring; `None` of none.
#[inline(always)]
pub fn product_of_equals<T: Copy>(factor: T, count: u32, mul: impl Fn(T, T) -> T) -> Option<T> {
    let mut left = count;
    let (mut square, mut product) = (factor, None::<T>);
    while left > 0 {
        if left & 1 == 1 {
            product = Some(product.map_or(square, |product| mul(product, square)));
        }
        left >>= 1;
        if left > 0 {
            square = mul(square, square);
        }
    }
    product
}

/// A number, where it is not too large for one.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

impl Number for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // As in Python, where it is an error.
        if other == 0.0 { f64::NAN } else { self / other }
    }
    #[inline(always)]
    fn neg(self) -> Self {
        -self
    }
    fn powi(self, exponent: i32) -> Self {
        whole_power(self, exponent)
    }
    fn pow(self, exponent: Self) -> Self {
        finite(power(self, exponent))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn exp(self) -> Self {
        finite(libm::exp(self))
    }
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    fn atan(self) -> Self {
        libm::atan(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sign(self) -> Self {
        // What is no number has no sign.
        if self.is_nan() { self } else { f64::from(i8::from(self > 0.0) - i8::from(self < 0.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other > self || other.is_nan() { other } else { self }
    }
    #[inline(always)]
    fn not_negative(self) -> Self {
        if self < 0.0 { 0.0 } else { self }
    }
    #[inline(always)]
    fn above(self, other: Self, or_equal: bool) -> Self {
        if self.is_nan() || other.is_nan() {
            return f64::NAN;
        }
        f64::from(u8::from(self > other || (or_equal && self == other)))
    }
}

/// A value and its rate of change along one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moving {
    /// The value.
    pub value: f64,
    /// Its rate.
    pub rate: f64,
}

impl Moving {
    /// The rate of a function of this value: chain rule, where a number that stands still has no part in it.
    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, rate: if self.rate == 0.0 { 0.0 } else { slope * self.rate } }
    }
}

impl Number for Moving {
    fn constant(value: f64) -> Self {
        Self { value, rate: 0.0 }
    }
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, rate: self.rate + other.rate }
    }
    fn mul(self, other: Self) -> Self {
        let share = |value: f64, rate: f64| if rate == 0.0 { 0.0 } else { value * rate };
        Self {
            value: self.value * other.value,
            rate: share(self.value, other.rate) + share(other.value, self.rate),
        }
    }
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self.mul(other.through(inverse, -inverse * inverse))
    }
    fn neg(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
    fn powi(self, exponent: i32) -> Self {
        let slope = f64::from(exponent) * whole_power(self.value, exponent - 1);
        self.through(whole_power(self.value, exponent), slope)
    }
    fn pow(self, exponent: Self) -> Self {
        let value = power(self.value, exponent.value);
        // A slope takes as long as the value: none where nothing changes.
        let by_base = match self.rate {
            0.0 => 0.0,
            rate => exponent.value * power(self.value, exponent.value - 1.0) * rate,
        };
        let by_exponent = match exponent.rate {
            0.0 => 0.0,
            // Zero to any power above zero stays zero.
            rate => (if value == 0.0 { 0.0 } else { value * libm::log(self.value) }) * rate,
        };
        Self { value, rate: by_base + by_exponent }
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }
    fn exp(self) -> Self {
        let exp = libm::exp(self.value);
        self.through(exp, exp)
    }
    fn tanh(self) -> Self {
        let tanh = libm::tanh(self.value);
        self.through(tanh, 1.0 - tanh * tanh)
    }
    fn atan(self) -> Self {
        self.through(libm::atan(self.value), 1.0 / (1.0 + self.value * self.value))
    }
    fn abs(self) -> Self {
        self.through(self.value.abs(), Number::sign(self.value))
    }
    fn sign(self) -> Self {
        Self::constant(Number::sign(self.value))
    }
    fn max(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
    fn not_negative(self) -> Self {
        if self.value < 0.0 { Self::constant(0.0) } else { self }
    }
    fn above(self, other: Self, or_equal: bool) -> Self {
        Self::constant(self.value.above(other.value, or_equal))
    }
}

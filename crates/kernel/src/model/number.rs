//! A number of one wall, or those of several walls side by side.
//!
//! Laws that are written in it are written once: a run alone and the lanes of vector registers do the same sums
//! in the same order.

use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f64x4, f64x8};

use super::formula::angles;
use super::side_by_side::sin_cos_lanes;
use super::vector::sin_cos;
use crate::fused::{fused, fused_lanes};

/// What laws calculate with.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The same constant for every wall of this number.
    #[must_use]
    fn constant(self, value: f64) -> Self;

    /// This number times a factor, and another, rounded once.
    #[must_use]
    fn fused(self, factor: Self, other: Self) -> Self;

    /// Square root.
    #[must_use]
    fn root(self) -> Self;

    /// Without its sign.
    #[must_use]
    fn magnitude(self) -> Self;

    /// This number, or a least one where it is below that or no number.
    #[must_use]
    fn at_least(self, least: Self) -> Self;

    /// One of two numbers: the first where this number is at most a limit.
    #[must_use]
    fn choose_up_to(self, limit: f64, within: Self, beyond: Self) -> Self;

    /// Sine and cosine by the polynomials of [`sin_cos`].
    fn sine_and_cosine(self) -> (Self, Self);

    /// The angle with this sine and a cosine.
    #[must_use]
    fn angle(self, cosine: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn fused(self, factor: Self, other: Self) -> Self {
        fused(self, factor, other)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn at_least(self, least: Self) -> Self {
        self.max(least)
    }

    #[inline(always)]
    fn choose_up_to(self, limit: f64, within: Self, beyond: Self) -> Self {
        if self <= limit { within } else { beyond }
    }

    #[inline(always)]
    fn sine_and_cosine(self) -> (Self, Self) {
        sin_cos(self)
    }

    #[inline(always)]
    fn angle(self, cosine: f64) -> f64 {
        self.atan2(cosine)
    }
}

macro_rules! number_in_lanes {
    ($lanes:ident) => {
        impl<S: Simd> Number for $lanes<S> {
            #[inline(always)]
            fn constant(self, value: f64) -> Self {
                Self::splat(self.simd, value)
            }

            #[inline(always)]
            fn fused(self, factor: Self, other: Self) -> Self {
                fused_lanes(self, factor, other)
            }

            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn magnitude(self) -> Self {
                self.abs()
            }

            #[inline(always)]
            fn at_least(self, least: Self) -> Self {
                self.max_precise(least)
            }

            #[inline(always)]
            fn choose_up_to(self, limit: f64, within: Self, beyond: Self) -> Self {
                self.simd_le(limit).select(within, beyond)
            }

            #[inline(always)]
            fn sine_and_cosine(self) -> (Self, Self) {
                sin_cos_lanes(self)
            }

            #[inline(always)]
            fn angle(self, cosine: Self) -> Self {
                angles(self, cosine)
            }
        }
    };
}

number_in_lanes!(f64x4);
number_in_lanes!(f64x8);

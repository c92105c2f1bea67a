//! What a step of several runs moves: one rotation of each, or both.

use std::ops::Mul;

use fearless_simd::{Simd, SimdBase, f64x4};

use crate::fused::fused_lanes;
use crate::solver::Values;

type F<S> = f64x4<S>;

/// One coordinate of every run, or both of them.
#[derive(Clone, Copy)]
pub(super) struct OneRotation<S: Simd>(pub F<S>);

#[derive(Clone, Copy)]
pub(super) struct TwoRotations<S: Simd>(pub [F<S>; 2]);

impl<S: Simd> Mul<f64> for OneRotation<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl<S: Simd> Values for OneRotation<S> {
    type Length = F<S>;
    #[inline(always)]
    fn over(self, length: F<S>) -> Self {
        Self(self.0 * length)
    }

    #[inline(always)]
    fn over_plus(self, length: F<S>, other: Self) -> Self {
        Self(fused_lanes(self.0, length, other.0))
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        Self(fused_lanes(self.0, F::splat(self.0.simd, factor), other.0))
    }
}

impl<S: Simd> Mul<f64> for TwoRotations<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self([self.0[0] * factor, self.0[1] * factor])
    }
}

impl<S: Simd> Values for TwoRotations<S> {
    type Length = F<S>;
    #[inline(always)]
    fn over(self, length: F<S>) -> Self {
        Self([self.0[0] * length, self.0[1] * length])
    }

    #[inline(always)]
    fn over_plus(self, length: F<S>, other: Self) -> Self {
        Self([fused_lanes(self.0[0], length, other.0[0]), fused_lanes(self.0[1], length, other.0[1])])
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        self.over_plus(F::splat(self.0[0].simd, factor), other)
    }
}

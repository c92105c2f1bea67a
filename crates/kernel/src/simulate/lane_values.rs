//! What a step of several runs moves: one rotation of each, or both.

use std::ops::Mul;

use crate::fused::fused_lanes;
use crate::lanes::Wide;
use crate::solver::Values;

/// One coordinate of every run, or both of them.
#[derive(Clone, Copy)]
pub(super) struct OneRotation<F: Wide>(pub F);

#[derive(Clone, Copy)]
pub(super) struct TwoRotations<F: Wide>(pub [F; 2]);

impl<F: Wide> Mul<f64> for OneRotation<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl<F: Wide> Values for OneRotation<F> {
    type Length = F;
    #[inline(always)]
    fn over(self, length: F) -> Self {
        Self(self.0 * length)
    }

    #[inline(always)]
    fn over_plus(self, length: F, other: Self) -> Self {
        Self(fused_lanes(self.0, length, other.0))
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        Self(fused_lanes(self.0, F::splat(self.0.token(), factor), other.0))
    }
}

impl<F: Wide> Mul<f64> for TwoRotations<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self([self.0[0] * factor, self.0[1] * factor])
    }
}

impl<F: Wide> Values for TwoRotations<F> {
    type Length = F;
    #[inline(always)]
    fn over(self, length: F) -> Self {
        Self([self.0[0] * length, self.0[1] * length])
    }

    #[inline(always)]
    fn over_plus(self, length: F, other: Self) -> Self {
        Self([fused_lanes(self.0[0], length, other.0[0]), fused_lanes(self.0[1], length, other.0[1])])
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        self.over_plus(F::splat(self.0[0].token(), factor), other)
    }
}

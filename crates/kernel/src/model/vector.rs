//! Plane vectors and the clockwise rotation of the model.

use std::f64::consts::FRAC_PI_4;
use std::ops::{Add, Mul, Sub};

use wide::f64x2;

use super::number::Number;
use crate::fused::{fused, fused_pair};

/// A vector in the plane: x out of the wall, y up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vector<N = f64> {
    /// Out of the wall's plane.
    pub x: N,
    /// Up.
    pub y: N,
}

impl<N: Number> Vector<N> {
    #[inline(always)]
    pub(crate) fn new(x: N, y: N) -> Self {
        Self { x, y }
    }

    /// R(θ)(x, y) = (x cos θ + y sin θ, -x sin θ + y cos θ).
    #[inline(always)]
    pub(crate) fn rotated(self, (sin, cos): (N, N)) -> Self {
        Self::new(self.x * cos + self.y * sin, self.y * cos - self.x * sin)
    }

    /// R(-θ): from the world's axes to those of a body turned by θ.
    #[inline(always)]
    pub(crate) fn rotated_back(self, (sin, cos): (N, N)) -> Self {
        Self::new(self.x * cos - self.y * sin, self.y * cos + self.x * sin)
    }

    /// d/dθ of a vector that turns with θ: (X, Y) becomes (Y, -X).
    #[inline(always)]
    pub(crate) fn perpendicular(self) -> Self {
        Self::new(self.y, -self.x)
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y
    }

    /// This vector times a factor, and another.
    #[inline(always)]
    pub(crate) fn times_plus(self, factor: N, other: Self) -> Self {
        Self::new(self.x.fused(factor, other.x), self.y.fused(factor, other.y))
    }

    /// Clockwise moment of a force at this arm: Y F_x - X F_y.
    #[inline(always)]
    pub(crate) fn moment_of(self, force: Self) -> N {
        self.y * force.x - self.x * force.y
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

/// Coefficients of fdlibm's `__kernel_sin` and `__kernel_cos`, for powers of θ² from the third and fourth power of θ on.
pub(super) const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
pub(super) const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine. Within ±π/4, where walls live, the polynomials of fdlibm serve: their error is below one
/// unit in the last place. The library's argument reduction would cost more than the motion.
#[inline(always)]
pub(crate) fn sin_cos(theta: f64) -> (f64, f64) {
    if theta.abs() > FRAC_PI_4 {
        return theta.sin_cos();
    }
    let z = theta * theta;
    let zz = z * z;
    let sin = fused(theta * z, polynomial(&SIN, z, zz), theta);
    (sin, fused(zz, polynomial(&COS, z, zz), fused(z, -0.5, 1.0)))
}

/// In Estrin's order: pairs side by side, because each sum would otherwise wait for the one before.
#[inline(always)]
fn polynomial(c: &[f64; 6], z: f64, zz: f64) -> f64 {
    fused(zz, fused(zz, fused(z, c[5], c[4]), fused(z, c[3], c[2])), fused(z, c[1], c[0]))
}

/// [`sin_cos`] of two angles side by side, to the same bits.
#[inline(always)]
pub(crate) fn sin_cos_pair(theta: f64x2) -> (f64x2, f64x2) {
    if theta.abs().simd_gt(f64x2::splat(FRAC_PI_4)).any() {
        return library_sin_cos_pair(theta);
    }
    let z = theta * theta;
    let zz = z * z;
    let sin = fused_pair(theta * z, polynomial_pair(&SIN, z, zz), theta);
    let first = fused_pair(z, f64x2::splat(-0.5), f64x2::ONE);
    (sin, fused_pair(zz, polynomial_pair(&COS, z, zz), first))
}

#[inline(always)]
fn polynomial_pair(c: &[f64; 6], z: f64x2, zz: f64x2) -> f64x2 {
    let two = |n: usize| fused_pair(z, f64x2::splat(c[n + 1]), f64x2::splat(c[n]));
    fused_pair(zz, fused_pair(zz, two(4), two(2)), two(0))
}

#[cold]
fn library_sin_cos_pair(theta: f64x2) -> (f64x2, f64x2) {
    let [(s0, c0), (s1, c1)] = theta.to_array().map(sin_cos);
    (f64x2::new([s0, s1]), f64x2::new([c0, c1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_sin_cos_agree_with_the_library() {
        for i in -4000..=4000 {
            let theta = f64::from(i) * 2.5e-4;
            let (sin, cos) = sin_cos(theta);
            // One unit in the last place of a number near one.
            assert!((sin - theta.sin()).abs() <= f64::EPSILON, "sin {theta}");
            assert!((cos - theta.cos()).abs() <= f64::EPSILON, "cos {theta}");
            let (sines, cosines) = sin_cos_pair(f64x2::new([theta, -theta]));
            assert_eq!((sines.to_array(), cosines.to_array()), ([sin, -sin], [cos, cos]), "pair at {theta}");
        }
    }
}

//! A product and a sum rounded once, which processors do in the time of one of them. It serves sums whose
//! other term is there before the product is.
//!
//! Rounded once on every processor: one without the instruction takes longer and gives the same bits.

use wide::f64x2;

use crate::lanes::Lanes;

/// a b + c.
#[inline(always)]
pub(crate) fn fused(a: f64, b: f64, c: f64) -> f64 {
    a.mul_add(b, c)
}

/// The same of two numbers side by side.
#[inline(always)]
pub(crate) fn fused_pair(a: f64x2, b: f64x2, c: f64x2) -> f64x2 {
    let ([a_1, a_2], [b_1, b_2], [c_1, c_2]) = (a.to_array(), b.to_array(), c.to_array());
    f64x2::new([fused(a_1, b_1, c_1), fused(a_2, b_2, c_2)])
}

/// The same of the lanes of several walls.
#[inline(always)]
pub(crate) fn fused_lanes<F: Lanes>(a: F, b: F, c: F) -> F {
    a.mul_add_precise(b, c)
}

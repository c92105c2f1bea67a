//! Numbers of several walls side by side, in the lanes of vector registers and in memory.

use fearless_simd::{Select, Simd, SimdFrom, f64x4, mask64x4};

/// Walls side by side. Eight were tried. In registers of AVX2 they took 1.1 times as long: two of five instructions went to
/// the stack and back. In those of AVX-512, of a processor that does them half by half, they took 0.94 of the time on sharp edges, but
/// 1.1 times as long on beds and 1.2 times as long alone.
pub(crate) const LANES: usize = 4;

/// One number of every wall of a row, in memory.
pub(crate) type Numbers = [f64; LANES];

/// One number of every lane.
#[inline(always)]
pub(crate) fn lanes<S: Simd>(simd: S, of: impl Fn(usize) -> f64) -> f64x4<S> {
    f64x4::simd_from(simd, std::array::from_fn::<f64, LANES, _>(of))
}

/// Numbers of a row in a register.
#[inline(always)]
pub(crate) fn from_row<S: Simd>(simd: S, numbers: &Numbers) -> f64x4<S> {
    f64x4::simd_from(simd, *numbers)
}

/// Exchanges the numbers of some lanes.
#[inline(always)]
pub(crate) fn exchange<S: Simd>(simd: S, which: mask64x4<S>, here: &mut Numbers, there: &mut Numbers) {
    let (first, second) = (from_row(simd, here), from_row(simd, there));
    (*here, *there) = (which.select(second, first).into(), which.select(first, second).into());
}

//! Which vector instructions are worth compiling for.
//!
//! On x86-64 there are three: AVX-512, AVX2, which comes with products and sums rounded once, and the least that every
//! processor has. What lies between lacks such products, which are then most of the time. By AVX-512 eight walls go side by side, by
//! others four; a run alone takes four lanes by either.
//! All give the same bits, and each takes the compiler its time.

use fearless_simd::Level;

/// Whether walls step side by side. Where products and sums that are rounded once are calls of a library, number by
/// number, lanes have little to save.
pub(crate) fn lanes_pay(level: Level) -> bool {
    #[cfg(target_arch = "x86_64")]
    let pay = level.as_avx2().is_some();
    #[cfg(not(target_arch = "x86_64"))]
    let pay = !level.is_fallback();
    pay
}

/// Does an operation by the vector instructions of a token.
#[cfg(target_arch = "x86_64")]
macro_rules! vectorized {
    ($instructions:expr, $simd:pat => $operation:expr) => {{
        let $simd = $instructions;
        fearless_simd::Simd::vectorize(
            $instructions,
            #[inline(always)]
            || $operation,
        )
    }};
}

/// Does an operation by the best of these instructions that the processor has.
macro_rules! dispatch {
    ($level:expr, $simd:pat => $operation:expr) => {{
        #[cfg(target_arch = "x86_64")]
        let done = if let Some(avx512) = fearless_simd::Level::as_avx512($level) {
            crate::instructions::vectorized!(avx512, $simd => $operation)
        } else if let Some(avx2) = fearless_simd::Level::as_avx2($level) {
            crate::instructions::vectorized!(avx2, $simd => $operation)
        } else if let Some(sse2) = fearless_simd::Level::as_sse2($level) {
            crate::instructions::vectorized!(sse2, $simd => $operation)
        } else {
            unreachable!("every x86-64 has SSE2")
        };
        #[cfg(not(target_arch = "x86_64"))]
        let done = fearless_simd::dispatch!($level, $simd => $operation);
        done
    }};
}

/// The same where only lanes that pay are asked for. `$lanes` are the numbers side by side: the widest where registers are as wide,
/// four elsewhere.
macro_rules! dispatch_lanes {
    ($level:expr, $lanes:ident of $widest:ident, $simd:pat => $operation:expr) => {{
        #[cfg(target_arch = "x86_64")]
        let done = if let Some(avx512) = fearless_simd::Level::as_avx512($level) {
            use fearless_simd::$widest as $lanes;
            crate::instructions::vectorized!(avx512, $simd => $operation)
        } else if let Some(avx2) = fearless_simd::Level::as_avx2($level) {
            use fearless_simd::f64x4 as $lanes;
            crate::instructions::vectorized!(avx2, $simd => $operation)
        } else {
            unreachable!("walls go one after another where lanes do not pay")
        };
        #[cfg(not(target_arch = "x86_64"))]
        let done = {
            use fearless_simd::f64x4 as $lanes;
            fearless_simd::dispatch!($level, $simd => $operation)
        };
        done
    }};
}

#[cfg(target_arch = "x86_64")]
pub(crate) use vectorized;
pub(crate) use {dispatch, dispatch_lanes};

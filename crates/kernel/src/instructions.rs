//! Which vector instructions are worth compiling for.
//!
//! On x86-64 there are two: AVX2, which comes with products and sums rounded once, and the least that every processor
//! has. What lies between lacks such products, which are then most of the time; AVX-512 would have eight lanes, which do not pay.
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

/// Does an operation by the best of these instructions that the processor has.
macro_rules! dispatch {
    ($level:expr, $simd:pat => $operation:expr) => {{
        #[cfg(target_arch = "x86_64")]
        let done = match fearless_simd::Level::as_avx2($level) {
            Some(avx2) => {
                let $simd = avx2;
                fearless_simd::Simd::vectorize(
                    avx2,
                    #[inline(always)]
                    || $operation,
                )
            }
            None => {
                let Some(sse2) = fearless_simd::Level::as_sse2($level) else {
                    unreachable!("every x86-64 has SSE2")
                };
                let $simd = sse2;
                fearless_simd::Simd::vectorize(
                    sse2,
                    #[inline(always)]
                    || $operation,
                )
            }
        };
        #[cfg(not(target_arch = "x86_64"))]
        let done = fearless_simd::dispatch!($level, $simd => $operation);
        done
    }};
}

/// The same where only lanes that pay are asked for.
macro_rules! dispatch_lanes {
    ($level:expr, $simd:pat => $operation:expr) => {{
        #[cfg(target_arch = "x86_64")]
        let done = {
            let Some(avx2) = fearless_simd::Level::as_avx2($level) else {
                unreachable!("walls go one after another where lanes do not pay")
            };
            let $simd = avx2;
            fearless_simd::Simd::vectorize(
                avx2,
                #[inline(always)]
                || $operation,
            )
        };
        #[cfg(not(target_arch = "x86_64"))]
        let done = fearless_simd::dispatch!($level, $simd => $operation);
        done
    }};
}

pub(crate) use {dispatch, dispatch_lanes};

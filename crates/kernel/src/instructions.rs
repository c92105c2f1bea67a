//! Which vector instructions are worth compiling for.
//!
//! On x86-64 there are two: AVX2, which comes with products and sums rounded once, and the least that every
//! processor has. SSE4.2 lacks such products, and they are the time it would save. AVX-512 would do the same four lanes.
//! All give the same bits; each takes the compiler its time.

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

pub(crate) use dispatch;

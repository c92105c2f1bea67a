//! Numbers of several walls side by side, in the lanes of vector registers and in memory.

use std::ops::{Deref, DerefMut};

use fearless_simd::{ExtractToken, Select};
pub(crate) use mrbd_formula::Lanes;

use crate::model::number::Number;

/// Walls side by side at most. Processors with registers for eight numbers take eight, others four: eight in two registers each
/// took 1.1 times as long, for two of five instructions went to the stack and back. Where units are as wide as these registers eight
/// take 0.78 to 0.95 of the time of four; one that does them half by half took 0.94 on sharp edges, and 1.1 times as long on beds.
pub(crate) const LANES: usize = mrbd_formula::MOST_LANES;

/// One number of every wall of a row, in memory; the first few where fewer go side by side. Where registers are as long as what the
/// processor fetches at once, numbers that began elsewhere would be fetched twice.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(64))]
pub(crate) struct Numbers(pub [f64; LANES]);

impl Deref for Numbers {
    type Target = [f64; LANES];

    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for Numbers {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// Numbers of walls side by side that laws calculate with, and that rows of them keep in memory.
pub(crate) trait Wide: Lanes + Number {
    /// Numbers of a row in a register.
    #[inline(always)]
    fn of_row(simd: Self::Token, numbers: &Numbers) -> Self {
        Self::from_slice(simd, &numbers[..Self::LEN])
    }

    /// Puts numbers in a row.
    #[inline(always)]
    fn put(self, numbers: &mut Numbers) {
        self.store_slice(&mut numbers[..Self::LEN]);
    }

    /// The numbers in memory.
    #[inline(always)]
    fn numbers(self) -> Numbers {
        let mut numbers = Numbers::default();
        self.put(&mut numbers);
        numbers
    }
}

impl<F: Lanes + Number> Wide for F {}

/// Exchanges the numbers of some lanes.
#[inline(always)]
pub(crate) fn exchange<F: Wide>(which: F::Mask, here: &mut Numbers, there: &mut Numbers) {
    let simd = which.token();
    let (first, second) = (F::of_row(simd, here), F::of_row(simd, there));
    which.select(second, first).put(here);
    which.select(first, second).put(there);
}

//! One number to be found.

use super::WallNumber;

/// Where the value of an unknown goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Slot {
    /// A number of the wall.
    Number(&'static WallNumber),
    /// C_l by its index from 0.
    Coefficient(usize),
    /// Addition by its index, parameter by its index.
    Added(usize, usize),
}

/// One number to be found.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Key, of the wall file or of the effect.
    pub key: String,
    /// Unit.
    pub unit: &'static str,
    /// Where the search starts: the wall file's value, or the value that does nothing.
    pub start: f64,
    /// A size that matters.
    pub scale: f64,
    /// Least value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
    /// Standard deviation known beforehand, about the start.
    pub prior_sd: Option<f64>,
    /// Where its value goes.
    pub(super) slot: Slot,
}

impl Unknown {
    /// Whether it is a number of the addition with this index.
    pub fn belongs_to(&self, index: usize) -> bool {
        matches!(self.slot, Slot::Added(i, _) if i == index)
    }

    /// A value with a share of its distance from the start.
    pub fn with_share(&self, share: f64, value: f64) -> f64 {
        (self.start + share * (value - self.start)).clamp(self.lower, self.upper)
    }
}

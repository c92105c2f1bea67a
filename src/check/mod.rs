//! Regression checks: the medians of a study against those that were accepted before.
//!
//! A baseline is a small CSV file: the medians of a study's first variant, how far each may move, where that comes
//! from, and why these medians were accepted, once a line for every time they were.

mod baseline;
mod compare;
mod tolerance;

pub use baseline::{Baseline, Entry};
pub use compare::{Change, compare};
pub use tolerance::{FLOOR, TIMES};

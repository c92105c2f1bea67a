//! Regression checks: the medians of a study against those that were accepted before.
//!
//! A baseline is a small CSV file: the medians of a study's first variant, how far each may move, where that comes
//! from, and why these medians were accepted, once a line for every time they were.

mod again;
mod baseline;
mod compare;
mod conditioning;
mod figures;
mod tolerance;

pub use again::run_again;
pub use baseline::{Baseline, Entry};
pub use compare::{Change, compare};
pub use conditioning::{Again, Conditioning, conditioning, sampled};
pub use figures::{figures_of_drawn, figures_of_sweep};
pub use tolerance::{FLOOR, TIMES};

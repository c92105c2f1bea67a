//! Regression checks: the medians of a study against those that were accepted before.
//!
//! A baseline is a small CSV file: the medians of a study's first variant, how far each may move, where that comes
//! from, and why these medians were accepted, once a line for every time they were.

mod baseline;
mod compare;
mod conditioning;
mod tolerance;

pub use baseline::{Baseline, Entry, figures_of_drawn, figures_of_sweep};
pub use compare::{Change, compare};
pub use conditioning::{Again, Conditioning, conditioning, run_again, sampled};
pub use tolerance::{FLOOR, TIMES};

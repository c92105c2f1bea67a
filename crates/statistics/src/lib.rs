//! Statistics that more than one part of the project needs: order statistics, the normal distribution where its tails matter,
//! correlations.

pub mod normal;
mod order;

pub use order::{censored_quantile, correlation, median, quantile};

//! Statistics that more than one part of the project needs: order statistics, the normal distribution where its tails matter,
//! Student's t, correlations, and which share of a variance each input has.
//!
//! ```
//! use mrbd_statistics::{median, normal, quantile};
//!
//! let rotations = [0.02, 0.05, 0.01, 0.09];
//! // Of an even number of values the middle between the two in the middle.
//! assert_eq!(median(&rotations), Some(0.035));
//! assert_eq!(quantile(&rotations, 0.5), median(&rotations));
//! assert!((normal::cdf(normal::quantile(0.84)) - 0.84).abs() < 1e-14);
//! ```

pub mod normal;
mod order;
mod pick_freeze;
pub mod student;

pub use order::{censored_quantile, correlation, median, quantile};
pub use pick_freeze::{Index, Indices, PickFreeze};

//! Ground motion: accelerograms, the files they come in, and the suites that list them.

mod accelerogram;

pub use accelerogram::{Accelerogram, InvalidAccelerogram};

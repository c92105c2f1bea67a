//! A study becomes a list of runs that can be printed and tested before anything runs.
//!
//! The list is computed, not stored: run `i` follows from `i`, so a plan of a million runs costs nothing to hold
//! and any run can be repeated alone.

mod facade;
mod id;
mod level;
mod run;
mod sweep;

pub use facade::{Facade, ImpossibleFacade};
pub use level::{Level, coefficients, facade};
pub use run::{Motions, RecordHash, Run};
pub use sweep::Plan;

//! How sure an answer is: intervals of its numbers, errors over whole runs, what could hardly be told apart, and which test
//! would tell.

mod confused;
mod ensemble;
mod interval;
mod next_tests;

pub use confused::{Confused, confused};
pub use ensemble::ensemble;
pub use interval::intervals;
pub use next_tests::{NextPull, NextShaking, NextTests, next_tests};

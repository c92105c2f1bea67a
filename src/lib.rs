//! Multi-rocking-body dynamics of unreinforced masonry walls.

pub mod aggregate;
pub mod batch;
pub mod calibrate;
pub mod cli;
pub mod error;
pub mod findings;
pub mod ground;
pub mod input;
pub mod model;
pub mod plan;
pub mod simulate;
pub mod solver;
pub mod store;

pub use error::{Error, InputError, Result};

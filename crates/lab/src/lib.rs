//! The laboratory: measured walls.

pub mod calibrate;
pub mod diagnose;
pub mod experiment_file;
mod progress;

pub use progress::Progress;

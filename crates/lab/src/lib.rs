//! The laboratory: measured walls.

pub mod calibrate;
pub mod diagnose;
pub mod experiment;
mod progress;

pub use experiment::file as experiment_file;
pub use progress::Progress;

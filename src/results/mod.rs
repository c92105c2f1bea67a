//! Results as they leave the program: of a run, and the folders of the laboratory, written whole or not at all.

pub mod calibration;
pub mod diagnosis;
mod folder;
mod run;

pub use run::RunResults;

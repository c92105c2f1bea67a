//! Results as they leave the program: of a run, and the folders of the laboratory, written whole or not at all.

pub mod calibration;
pub mod diagnosis;
mod folder;
mod moments;
mod parts;
mod run;

pub use parts::{PartPeaks, PartResults, joined, part_results};
pub use run::RunResults;

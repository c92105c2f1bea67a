//! Result folders of the laboratory: what a calibration and a diagnosis found, written whole or not at all.

pub mod calibration;
pub mod diagnosis;
mod folder;

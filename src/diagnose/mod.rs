//! Diagnosis: where model and measurement disagree, which effect would make them agree, and whether it does.
//!
//! In the order of the flow: an [`Experiment`] is read and its data checked ([`mod@check_data`]); tests are cut into short
//! [`windows`] that start where the measured [`pattern`] is beyond doubt; each window is simulated from a fitted state
//! ([`replay`], [`window_fit`]), so that neither the past nor noisy derivatives enter; a [`hypothesis`], the wall with
//! what is uncertain of it and what is added to it, is fitted to all windows together ([`fit`]) and judged on tests held
//! out ([`search`], [`score`]); the catalogue is tried ([`trials`]), patterns are read again if a sensor turns out to read a
//! gain ([`read_again`]), what may stand for the best is tried from where it would ([`imitate`]), and a [`verdict`] is
//! reached ([`flow`]); what is found is written ([`output`]).

pub mod amplitude;
pub mod candidates;
pub mod check_data;
pub mod confused;
pub mod ensemble;
#[cfg(test)]
mod example;
pub mod experiment;
mod finishing;
pub mod fit;
pub mod flow;
pub mod force;
mod friction;
pub mod hypothesis;
pub mod imitate;
pub mod interval;
pub mod linear;
mod manifest;
mod memory;
pub mod next_tests;
pub mod noise;
pub mod offset;
pub mod other_law;
pub mod output;
pub mod pattern;
mod place;
pub mod read_again;
pub mod replay;
pub mod robust;
pub mod scale;
pub mod score;
pub mod search;
pub mod second;
pub mod settle;
pub mod smooth;
pub mod tables;
pub mod test_data;
pub mod trials;
pub mod updated_wall;
pub mod verdict;
pub mod wall_number;
pub mod window_fit;
pub mod windows;

pub use check_data::check_data;
pub use experiment::Experiment;
pub use flow::{Diagnosis, diagnose};
pub use output::{KIND, OutputNames, write_results};
pub use trials::Progress;
pub use verdict::Verdict;

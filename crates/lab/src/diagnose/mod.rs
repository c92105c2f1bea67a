//! Diagnosis: where model and measurement disagree, which effect would make them agree, and whether it does.
//!
//! In the order of the flow ([`mod@flow`]):
//!
//! | module | idea |
//! | --- | --- |
//! | [`Experiment`], [`mod@check_data`] | what was measured and known beforehand, and what laboratories get wrong in files |
//! | [`measured`] | tests cut into short windows that start where the measured pattern is beyond doubt |
//! | [`hypothesis`] | the wall, with what is uncertain of it and what is added to it |
//! | [`fit`] | each window simulated from a fitted state, so that neither the past nor noisy derivatives enter; a hypothesis fitted to all windows together |
//! | [`trials`] | the catalogue tried, and judged on tests held out |
//! | [`verdict`] | nothing missing, the wall's own numbers, one effect or two by name, or a place |
//! | [`certainty`] | how well its numbers are known, what could not be told from it, which test would tell |
//! | [`force`] | the missing force, measured: no hypothesis enters |
//! | [`mod@crate::limits`] | every number that decides |
//! | [`answer`] | all of it worked out: what `diagnosis.json` and the tables hold |

pub mod answer;
pub mod certainty;
pub mod check_data;
pub mod experiment;
pub mod fit;
pub mod flow;
pub mod force;
pub mod hypothesis;
pub mod measured;
pub mod trials;
pub mod verdict;

pub use answer::Diagnosis;
pub use check_data::{check_data, check_tests};
pub use experiment::Experiment;
pub use flow::diagnose;
pub use verdict::Verdict;

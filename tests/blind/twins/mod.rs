//! Twins for `mrbd calibrate`: walls whose coefficients are known, calibrated, and their intervals held against the truth
//! (`make blind-calibrations`).
//!
//! | part | what |
//! | --- | --- |
//! | [`draw`] | a set and a number become a twin: law, simulator, wall, coefficients, tests, noise |
//! | [`folder`] | the twin as files; the truth kept beside them |
//! | [`row`] | a calibrated twin: what was true and what was said of every number |
//! | [`targets`] | how often intervals hold the truth, and how far values are off |

pub mod draw;
pub mod folder;
pub mod row;
pub mod targets;

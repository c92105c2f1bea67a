//! Measured tests: one room under calibration and diagnosis.
//!
//! | module | idea |
//! | --- | --- |
//! | [`mod@file`] | the experiment file: wall, what was known of it, how to calibrate |
//! | `test_table` | a test of it: how the wall was shaken, what was measured, what counts |
//! | [`channel_table`], `channels`, `bodies` | transducers at heights, and the rotations that they tell |
//! | [`measured`] | measured rotations as laboratories have them |
//! | [`alignment`] | clocks of record and measurement brought together |
//! | `shaking` | the ground motion of a test |
//! | `release` | a release by hand: from when on it counts, and the state there |
//! | [`mod@test`] | one test: how the wall was shaken, what was measured, and a simulation held against it |
//! | [`misfit`] | the weighted mean error over a whole run: the paper's Eq. 8 |
//! | [`rotations`] | rotations of a run at the times of a measurement |
//! | [`noise`] | white noise of a channel, and its offset at rest |
//! | `local` | a channel about a time, however it was sampled |
//! | [`pattern`] | contact patterns beyond doubt, and what is free in them |
//! | [`test_data`], [`mod@windows`] | a test with noise and offsets, cut into the short windows of a diagnosis |
//! | `segments` | a test that starts anew from the measured motion, for a search by Eq. 8 |

pub mod alignment;
mod bodies;
mod carried;
pub mod channel_table;
mod channels;
pub mod file;
mod local;
pub mod measured;
pub mod misfit;
pub mod noise;
pub mod pattern;
mod release;
pub mod rotations;
mod segments;
mod shaking;
pub mod test;
pub mod test_data;
mod test_table;
pub mod windows;

pub use alignment::Alignment;
pub(crate) use carried::{carried_along, top_path};
pub use file::{ExperimentFile, Purpose};
pub use measured::Measured;
pub use misfit::Target;
pub use noise::rest_offset_rad;
pub use pattern::{Freedom, held_state, measured_state};
pub use rotations::Sampled;
pub use test::{Simulated, Test, load_tests};
pub use test_data::{Manner, TestData};
pub use windows::{Window, is_readable, windows};

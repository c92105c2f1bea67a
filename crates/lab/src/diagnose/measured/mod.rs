//! What was measured, as the diagnosis sees it: tests with their noise, patterns beyond doubt, and the short windows in which
//! hypotheses are judged.

mod noise;
mod offset;
mod pattern;
mod smooth;
mod test_data;
mod windows;

pub use offset::rest_offset_rad;
pub use pattern::{Freedom, measured_state};
pub use test_data::TestData;
pub use windows::{Window, is_readable, windows};

//! What was measured, as the diagnosis sees it: [`crate::experiment`].

pub use crate::experiment::{
    Freedom, TestData, Window, is_readable, measured_state, rest_offset_rad, windows,
};

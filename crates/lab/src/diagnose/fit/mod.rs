//! Fits a hypothesis to windows: its numbers, and the state at the start of every window, together.
//!
//! Multiple shooting: the states are eliminated window by window (an orthogonal projection of residuals and
//! sensitivities), which leaves normal equations in the few numbers of the hypothesis; after each step the states follow.

mod descent;
mod linear;
mod memory;
mod problem;
mod replay;
mod robust;
mod score;
mod window_fit;

pub use linear::WindowSlopes;
pub use memory::SpringMemory;
pub use problem::{Fit, Problem};
pub use replay::{Replay, shaken};
pub use robust::Loss;
pub use score::{more_poor_held_out_sd, nats, poor_share, windowed_error};
pub use window_fit::{WindowFit, fit_windows};

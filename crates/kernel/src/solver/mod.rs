//! Integration of second-order motion between events, and where inside a step an event lies.
//!
//! Knows no masonry: two coordinates, their velocities, an acceleration, two quadratures. A step carries
//! positions, velocities and accelerations at both ends. Events, maxima and histories are read from the
//! [`Quintic`] through them, which is as accurate as the step itself.

mod bernstein;
mod bernstein_lanes;
mod beside;
mod controller;
mod nystrom;
mod quintic;

pub use bernstein::Bernstein;
pub(crate) use bernstein_lanes::{only_roots, turn_negative_once};
pub(crate) use beside::Beside;
pub(crate) use controller::ErrorRow;
pub use controller::{Controller, ErrorScale};
pub use nystrom::{Field, Nystrom, Rate, STAGES, Step, Stride, Values};
pub use quintic::{Point, Quintic, hermite};

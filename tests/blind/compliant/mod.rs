//! A wall whose corners are stiff springs: a second simulator, of another formulation, that shares no code with the library.
//!
//! The library's model has one or two angles, switches between nine sets of equations and makes impacts instantaneous.
//! Here two rigid bodies have three degrees of freedom each, always the same ones. Each joint has two corners; a corner
//! under pressure is a stiff spring with a damper, pushes but does not pull, and does not slide. Rocking, impacts and
//! sticking are what comes of it: nothing here knows of patterns, but for the coefficients of impact ([`scaling`]).
//!
//! Where it parts from the library by itself: a joint turns by some 1e-6 rad before it opens, so that a crack open by less
//! than that counts as closed when an impact comes. Under Table 2 such an impact has another coefficient (C_6, not C_3).
//!
//! | part | what |
//! | --- | --- |
//! | [`wall`] | geometry, masses, everything that acts on the wall |
//! | [`corner`] | normal and tangential force of one corner |
//! | [`top`] | laws of the force between the top and the floor, with and without memory |
//! | [`bodies`] | accelerations of both bodies |
//! | [`rosenbrock`] | one step of an L-stable method, which stiff springs do not hold back |
//! | [`scaling`] | the coefficients C_l under the law `contact` |
//! | [`run`] | a wall under a record, sampled |

pub mod bodies;
pub mod corner;
pub mod rosenbrock;
pub mod run;
pub mod scaling;
pub mod top;
pub mod wall;

pub use run::{GroundMotion, run};
pub use top::TopLaw;
pub use wall::CompliantWall;

/// Coordinates: (x, y, θ) of the lower body, of the upper body, and x of a loose mass at the top; m and rad, from rest.
pub type Coordinates = nalgebra::SVector<f64, 7>;

/// Acceleration of gravity, m/s².
pub const G_M_S2: f64 = 9.81;

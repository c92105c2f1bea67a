//! Façades for Monte Carlo campaigns: the survey's distributions, spread over the unit cube by a design.
//!
//! | step | module |
//! | --- | --- |
//! | a point of the unit cube: plain, Latin hypercube, scrambled Sobol | [`Design`] |
//! | rank correlations by a Gaussian copula | `correlation` |
//! | log-normal, truncated or constant values | [`Marginal`] |
//! | the variables of a façade | [`FacadeSampler`] |
//!
//! Every number depends on the seed, the index of the draw and the variable alone: any draw can be repeated by itself,
//! threads and shards change nothing, and a sampler of 10⁶ draws takes no more memory than one of ten.

mod correlation;
mod design;
mod facade;
mod marginal;
mod permutation;
mod random;
mod refused;
mod sobol;
mod spec;
mod variable;

pub use design::{Design, MOST_STRATA};
pub use facade::FacadeSampler;
pub use marginal::{Marginal, Truncation};
pub use refused::Refused;
pub use spec::{HIGHEST_CRACK, Sampling};
pub use variable::Variable;

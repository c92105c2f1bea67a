//! One integration binary, because linking is slow.
//!
//! Test names carry their kind: `analytic_` (a closed form or an invariant), `published_` (a figure from the literature),
//! `verified_` (an independent program), `regress_` (our own earlier result), `rejects_` (bad input).

mod convergence;
mod energy;
mod impacts;
mod limits;
mod matrix_form;
mod matrix_model;
mod published;
mod shared;
mod symmetry;
mod traps;
mod verification;
mod walls;

//! One integration binary, because linking is slow.
//!
//! Test names carry their kind: `analytic_` (a closed form or an invariant), `published_` (a figure from the literature),
//! `verified_` (an independent program), `regress_` (our own earlier result), `rejects_` (bad input).

mod shared;
mod verification;

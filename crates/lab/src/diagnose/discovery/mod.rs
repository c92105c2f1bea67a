//! A law that no catalogue has, found from what the measured motion lacks.
//!
//! | module | idea |
//! | --- | --- |
//! | `points` | the missing force as equations, with what is uncertain of the wall |
//! | `shape`, `law` | what a law may look like |
//! | `search` | all laws of one atom and of two, weighed by evidence over points |

mod law;
mod points;
mod search;
mod shape;
#[cfg(test)]
mod twin;

pub use law::{Atom, Law};
pub use points::Points;
pub use search::{Candidate, Searched, search};
pub use shape::{Meaning, Shape, ShapeNumber, Side};

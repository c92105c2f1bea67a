//! Façades: what the survey found of them, what it leaves open, and draws from it.

mod assumptions;
mod facade;
pub mod sampling;
mod survey_file;

pub use assumptions::Assumptions;
pub(crate) use assumptions::Changes;
pub use facade::{Facade, ImpossibleFacade};
pub use survey_file::*;

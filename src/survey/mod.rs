//! Façades: what the survey found of them, what it leaves open, and draws from it.

mod bed;
mod facade;
pub mod sampling;
mod survey_file;

pub use bed::Bed;
pub use facade::Assumptions;
pub(crate) use facade::Changes;
pub use facade::{Facade, ImpossibleFacade};
pub use survey_file::*;

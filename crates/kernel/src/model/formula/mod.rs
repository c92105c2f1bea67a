//! Laws of a wall written as formulas: where they act, what they may see, which branch they are in.
//!
//! The catalogue of effects has laws with a name. A formula has none: it is a force at the top, or a moment
//! at a joint, as arithmetic of what moves there ([`mrbd_formula`]). Its branches are frozen between switches,
//! at which runs stop as at the kinks of other laws. What it takes from the motion is counted as lost, what it
//! gives as gained: a spring written as a formula returns what it took.
//!
//! A jump against the motion at rest is friction. It holds the top as Coulomb's does, within the two sides of
//! the jump.
//!
//! At impacts a formula is no force: it is a factor on a coefficient, of the speed at which a joint closes.

mod at_impacts;
mod carried;
mod check;
mod lanes;
mod law;
mod laws;
mod switches;

pub(crate) use at_impacts::ImpactFactors;
pub use carried::{CarriedStates, MOST_CARRIED, TopMove};
pub(in crate::model) use check::checked;
pub(crate) use lanes::FormulaRow;
pub(in crate::model) use lanes::{FormulaLanes, angles};
pub(crate) use law::FormulaLaw;
pub(crate) use laws::{FormulaLaws, Slopes};
pub(crate) use switches::{Path, TopSides, Turn};

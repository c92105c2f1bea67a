//! Blind cases for laws that no catalogue has: drawn by kind, told as formulas, scored by the functions that they are.
//!
//! | part | what |
//! | --- | --- |
//! | [`atom`] | a law: what it is worth, how wall files write it |
//! | [`draw`] | a number becomes a case |
//! | [`excited`] | where the tests went, and the force that was there |
//! | [`found`] | the formulas of an answer, held against the truth |
//! | [`refused`] | what each guard keeps out |
//! | [`visible`] | what a law that was missed shows at all |
//! | [`row`], [`targets`] | one row a case, and what was reached |

pub mod atom;
pub mod draw;
pub mod excited;
pub mod found;
pub mod refused;
pub mod row;
pub mod targets;
pub mod visible;

pub use row::LawRow;

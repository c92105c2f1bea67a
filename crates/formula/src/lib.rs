//! Laws of force written as formulas: `-k*x - c*abs(v)**p*sign(v)`.
//!
//! A formula is arithmetic and nothing else. What Python reads, it reads the same way. Every subexpression has
//! its dimension, depth and length are bounded, and nothing can be written that does not end.
//!
//! # From text to force
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | `parse` | text | an [`Expression`], or where it is none |
//! | `dimension` | an expression, the units of its parameters | the dimension of each subexpression |
//! | `compile`, `program` | an expression, the values of its parameters | a tape that is run, and its switches |
//! | `lanes`, `power` | a tape, states of several walls | the values of all of them at once |
//! | `carried` | the rates of carried states | intervals that the states never leave |
//! | `range` | an expression, a range of states | whether it is finite everywhere there |
//! | `jump` | a program, a range of states | where the force jumps, and whether that can be followed |
//!
//! A [`Switch`] is where `abs`, `sign`, `max`, `min` or a comparison changes its branch. Between switches the
//! branches are frozen ([`Branches`]) and the force is smooth: who steps a motion stops at each of them.
//!
//! ```
//! use mrbd_formula::{Formula, Parameter, Place};
//!
//! let parameters = [Parameter::new("k", 37e3, "N/m"), Parameter::new("c", 200.0, "N*(s/m)**1.7")];
//! let law = Formula::parse("-k*x - c*abs(v)**1.7*sign(v)", Place::Top, &parameters)?;
//! assert_eq!(law.value([0.01, 0.0, 0.0]), -370.0);
//! assert_eq!(law.to_string(), "-k*x - c*abs(v)**1.7*sign(v)");
//! let wrong = Formula::parse("-k*x - c*v", Place::Top, &parameters).expect_err("c is of another law");
//! assert!(wrong.to_string().contains("c*v"), "{wrong}");
//! # Ok::<(), mrbd_formula::FormulaError>(())
//! ```

mod carried;
mod compile;
mod dimension;
mod error;
mod expression;
mod formula;
mod interval;
mod jump;
mod lanes;
mod number;
mod parse;
mod power;
mod program;
mod range;
mod sloped;
mod switch;
mod unit;
mod written;

pub use carried::CarriedState;
pub use dimension::Dimension;
pub use error::FormulaError;
pub use expression::{Expression, Function, Operator};
pub use formula::{Formula, Parameter, Place};
pub use jump::Jump;
pub use lanes::{LaneBranches, Lanes, MOST_LANES};
pub use program::{MOST_STATES, MOST_SWITCHES, Program, State, VARIABLES, state};
pub use range::Range;
pub use switch::{Branch, Branches, Switch, SwitchAt};

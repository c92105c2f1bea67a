//! A law that no catalogue has, found from what the measured motion lacks.
//!
//! | module | idea |
//! | --- | --- |
//! | `points` | the missing force as equations, with what is uncertain of the wall |
//! | `search` | all laws of one atom and of two, weighed by evidence over points |
//! | `asked` | the gap that a law is to close, and what it must do |
//! | `by_few` | laws chosen by few windows, where points are too noisy to choose |
//! | `by_windows` | the best of them fitted to windows with their impacts, which alone judge |
//! | `elsewhere` | the best of one atom of the top at the ground, or the other way |
//! | `fitted` | where laws start in windows, and their fits |
//! | `beside_best` | second atoms beside the best law of one, as windows ask for them |
//! | `beyond` | the same where only the larger motion of tests held out reaches them |
//! | `alone` | a law of two atoms beside each of them alone |
//! | `guards` | what refuses a law that fits |
//! | `left_open` | numbers of a law that the tests fitted leave open, where those held out ask for others |
//! | `brief` | joints that open too briefly for points |
//! | `kin` | a name whose exponent, set free, does clearly better |
//! | `relatives` | what laws do in the place of the effects of a name |
//! | `kin_of_two` | a power of velocity that does clearly better than friction and a damper |
//! | [`Guard`] | the same by name, with the laws that each refused |
//! | [`freed`] | laws told with round exponents, with these set free |
//! | `curve`, `curve_in_windows` | a force without a formula |
//! | `equals` | laws that the tests cannot tell apart |
//! | [`Stability`] | how sure the form of a law is |

mod alone;
mod asked;
mod beside_best;
mod beyond;
mod brief;
mod by_few;
mod by_windows;
mod curve;
mod curve_in_windows;
mod elsewhere;
mod equals;
mod fitted;
mod freed;
mod guards;
mod kin;
mod kin_of_two;
mod left_open;
mod points;
mod refused;
mod relatives;
mod search;
mod stability;
#[cfg(test)]
pub(in crate::diagnose) mod twin;

pub use asked::{AskedOfLaws, OpenGap, Scope};
pub use by_windows::Discovered;
pub use equals::law_of;
pub use freed::freed;
pub use kin::{Kin, exponent_of, is_of_catalogue};
pub use points::Points;
pub use refused::{Guard, Refused};
pub use relatives::Relatives;
pub use search::{Candidate, Searched, search};
pub use stability::{Stability, UnseenGain};

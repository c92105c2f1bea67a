//! What results depend on: the suite of records, the intensity measure that they are told by, and every input that is uncertain.
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`suites`] | sweeps | conclusions under several suites, and how many records decide them |
//! | [`measures`] | drawn façades | which intensity measure foretells their response |
//! | [`variance`] | points of a pick-freeze design | which share of the variance each input has |

pub mod measures;
pub mod suites;
pub mod variance;

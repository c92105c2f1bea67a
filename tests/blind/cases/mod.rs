//! Blind cases: an experiment whose answer is known, made by one of two simulators.
//!
//! A case depends on the name of its set and its number alone: a set can be made longer, split, or made again.
//!
//! | part | what |
//! | --- | --- |
//! | [`kind`] | what may be hidden, and how often |
//! | [`draw`] | a number becomes a case: kind, simulator, wall, noise, prior, size, tests |
//! | [`beds`] | the same of walls whose joints give |
//! | [`nulls`] | the same with nothing hidden, of every formulation |
//! | [`corners`] | the same of free bodies on stiff corners, with what was once missed there |
//! | [`impacts`] | the same of impacts that keep the less the faster they are |
//! | [`walls`] | the walls of the cases |
//! | [`hidden`] | the effects with their sizes |
//! | [`compliant_wall`], [`own_wall`] | the true wall for each simulator |
//! | [`tests`] | ground motions, scaled so that the wall rocks and stands; what is measured |
//! | [`folder`] | the experiment as files |

pub mod beds;
pub mod compliant_wall;
pub mod corners;
pub mod draw;
pub mod folder;
pub mod hidden;
pub mod impacts;
pub mod kind;
pub mod nulls;
pub mod own_wall;
pub mod tests;
pub mod walls;

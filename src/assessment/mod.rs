//! The engineer's assessment: what the code and the dynamics say of a wall, how far it is from falling, and how often that happens.
//!
//! | module | what |
//! | --- | --- |
//! | [`push`] | force against displacement as a wall is pushed slowly |
//! | [`margin`] | the factor on each record that overturns a wall, and its fragility |
//! | [`wall`] | the code's check of a wall at a site and the dynamics beside it, as a folder keeps them |
//! | [`governing`] | the run with the largest displacement, sample by sample |
//! | [`portfolio`] | the same of the façades of a survey |
//! | [`risk`] | annual rates of limit states: fragilities under a hazard curve |

pub mod governing;
pub mod margin;
pub mod portfolio;
pub mod push;
pub mod risk;
pub mod wall;

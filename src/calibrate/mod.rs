//! Calibration: coefficients and other numbers of a wall from measured rotations (the paper's section 3).
//!
//! In the order of the flow: an [`Experiment`] is read; for each test the paper's differential evolution ([`PaperDe`])
//! minimises the WME ([`misfit`]); cosine similarity ([`most_similar`]) picks the one vector for all tests.
//! Beside it stand an adaptive differential evolution ([`AdaptiveDe`]) on each test and on all tests jointly,
//! with as many simulations. Then comes what the tests can tell: counts of transitions, bootstrap intervals,
//! correlations, and the dependence on the capture velocity.

mod adaptive_de;
mod archive;
mod bootstrap;
mod candidates;
mod capture;
mod cma_es;
mod draws;
mod experiment;
mod flow;
mod generations;
mod identifiability;
mod manifest;
mod measured;
pub mod misfit;
mod objective;
mod output;
mod paper_de;
mod parameter;
mod reading;
mod report;
mod result;
mod search;
mod similarity;
mod staged;
mod trial;

pub use adaptive_de::AdaptiveDe;
pub use archive::{Address, Archive, Row};
pub use bootstrap::{correlation, quantile};
pub use cma_es::CmaEs;
pub use draws::Draws;
pub use experiment::Experiment;
pub use flow::calibrate;
pub use manifest::KIND;
pub use measured::Measured;
pub use objective::{Objective, prior_factor, simulate};
pub use output::{OutputNames, write_results};
pub use paper_de::{F, PaperDe, first_generation};
pub use parameter::{Parameter, ParameterSpace, Target};
pub use reading::{lower_rotation_rad, upper_rotation_rad};
pub use report::{print_parameters, summary};
pub use result::{
    Calibration, CaptureRow, Estimate, Identifiability, MethodResult, ProfilePoint, TestResult, Vector,
};
pub use search::{Bounds, Evaluate, Found, Member};
pub use similarity::{MostSimilar, most_similar, sim};
pub use staged::Staged;
pub use trial::{Simulated, Test};

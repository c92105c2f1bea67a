//! Calibration: coefficients and other numbers of a wall from measured rotations (the paper's section 3).
//!
//! In the order of the flow: an [`Experiment`] is read; for each test the paper's differential evolution ([`PaperDe`])
//! minimises the WME ([`crate::experiment::misfit`]); cosine similarity ([`most_similar`]) picks the one vector for all tests.
//! Beside it stands a stronger search ([`Staged`]) in each test and in all tests jointly, with no more simulations:
//! Gauss-Newton in windows that begin anew from the measured motion, then from rest over ever more of it, then
//! [`CmaEs`] on the WME itself. Then comes what the tests can tell: counts of transitions, bootstrap intervals, correlations, and the
//! dependence on the capture velocity.

mod agreement;
mod archive;
mod assembly;
mod axes;
mod bootstrap;
mod capture;
mod cma_constants;
mod cma_es;
mod draws;
mod experiment;
mod flow;
mod following;
mod gauss_newton;
mod identifiability;
mod journal;
mod least_sizes;
mod leaving;
mod objective;
mod paper_de;
mod parameter;
mod prior;
mod progress;
mod report;
mod resolver;
mod result;
mod search;
mod similarity;
mod slopes;
mod space;
mod staged;
mod stages;

pub use agreement::disagreement;
pub use archive::{Address, Archive, Row};
pub use cma_es::CmaEs;
pub use draws::Draws;
pub use experiment::Experiment;
pub use flow::{calibrate, method_names};
pub use objective::{Objective, simulate};
pub use paper_de::{F, PaperDe, first_generation};
pub use parameter::{Parameter, Target};
pub use prior::prior_factor;
pub use report::{print_parameters, summary};
pub use result::{
    Calibration, CaptureRow, Estimate, Identifiability, MethodResult, ProfilePoint, TestResult, Vector,
};
pub use search::{Bounds, Evaluate, Found, Member};
pub use similarity::{MostSimilar, most_similar, sim};
pub use space::ParameterSpace;
pub use staged::Staged;

//! Calibration: coefficients and other numbers of a wall from measured rotations (the paper's section 3).
//!
//! In the order of the flow, an [`Experiment`] is read. For each test the paper's differential evolution
//! ([`PaperDe`]) minimises the WME ([`crate::experiment::misfit`]). Cosine similarity ([`most_similar`]) picks the
//! one vector for all tests. Beside it stands a stronger search ([`StagedSearch`]), in each test and in all tests
//! jointly, with no more simulations. It is Gauss-Newton in windows that begin anew from the measured motion, then
//! from rest over ever more of it. [`CmaEs`] on the WME itself comes last. From what they found the numbers are fitted
//! by likelihood ([`ByLikelihood`]), which says whether intervals can be believed. Then comes what the tests can tell: counts
//! of transitions, bootstrap intervals, correlations, and the dependence on the capture velocity.

mod archive;
mod bootstrap;
mod cma_es;
mod continuation;
mod doubt;
mod evaluation;
mod flow;
mod gauss_newton;
mod identifiability;
mod interval;
mod least_absolute;
mod likelihood;
mod objective;
mod paper;
mod parameters;
mod report;
mod result;
mod search;
mod slopes;
mod staged_search;

pub use archive::{Address, Archive, Origin, Row};
pub use cma_es::CmaEs;
pub use flow::{Experiment, calibrate, method_names};
pub use likelihood::{ByLikelihood, Over};
pub use objective::{Objective, prior_factor, simulate};
pub use paper::{F, MostSimilar, PaperDe, first_generation, most_similar, sim};
pub use parameters::{Parameter, ParameterSpace, Target};
pub use report::{disagreement, likelihood, print_parameters, summary};
pub use result::{
    Calibration, CaptureRow, Estimate, Identifiability, MethodResult, ProfilePoint, TestResult, Vector,
};
pub use search::{Bounds, Draws, Evaluate, Found, Member};
pub use staged_search::StagedSearch;

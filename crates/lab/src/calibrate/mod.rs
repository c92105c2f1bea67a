//! Calibration: coefficients and other numbers of a wall from measured rotations (the paper's section 3).
//!
//! In the order of the flow: an [`Experiment`] is read; for each test the paper's differential evolution ([`PaperDe`])
//! minimises the WME ([`misfit`]); cosine similarity ([`most_similar`]) picks the one vector for all tests.
//! Beside it stands a stronger search ([`Staged`]) in each test and in all tests jointly, with no more simulations:
//! Gauss-Newton in windows that begin anew from the measured motion, then from rest over ever more of it, then
//! [`CmaEs`] on the WME itself. Then comes what the tests can tell: counts of transitions, bootstrap intervals, correlations, and the
//! dependence on the capture velocity.

mod agreement;
mod alignment;
mod archive;
mod assembly;
mod axes;
mod bootstrap;
mod capture;
mod cma_constants;
mod cma_es;
mod comparison;
mod draws;
mod experiment;
mod flow;
mod following;
mod gauss_newton;
mod identifiability;
mod journal;
mod least_sizes;
mod leaving;
mod measured;
pub mod misfit;
mod objective;
mod paper_de;
mod parameter;
mod prior;
mod progress;
mod reading;
mod report;
mod resolver;
mod result;
mod search;
mod shaking;
mod similarity;
mod slopes;
mod space;
mod staged;
mod stages;
mod start_state;
mod stretches;
mod trial;
mod windows;

pub use agreement::disagreement;
pub use alignment::Alignment;
pub use archive::{Address, Archive, Row};
pub use cma_es::CmaEs;
pub use draws::Draws;
pub use experiment::Experiment;
pub use experiment::files as experiment_files;
pub use flow::{calibrate, method_names};
pub use measured::Measured;
pub(crate) use measured::median_step;
pub use objective::{Objective, simulate};
pub use paper_de::{F, PaperDe, first_generation};
pub use parameter::{Parameter, Target};
pub use prior::prior_factor;
pub use reading::{lower_rotation_rad, upper_rotation_rad};
pub use report::{print_parameters, summary};
pub use result::{
    Calibration, CaptureRow, Estimate, Identifiability, MethodResult, ProfilePoint, TestResult, Vector,
};
pub use search::{Bounds, Evaluate, Found, Member};
pub use similarity::{MostSimilar, most_similar, sim};
pub use space::ParameterSpace;
pub use staged::Staged;
pub use trial::{Simulated, Test};

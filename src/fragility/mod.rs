//! Fragility: the probability that a wall fails, as a function of the intensity of the ground motion.
//!
//! | module | idea |
//! | --- | --- |
//! | [`Sample`] | observations: intensity, failures, trials, demand, clusters |
//! | [`Method`] | outcomes and stripes (maximum likelihood), incremental analyses, clouds |
//! | [`Unknown`] | why data tell no fragility; it takes the place of a number |
//! | [`Bootstrap`], [`Replicates`] | intervals over records, façades or both |
//! | [`profile_intervals`] | intervals of independent outcomes |
//! | [`goodness`], [`outcome_shares`], [`components`] | how well, and scatter from what |

mod binomial;
mod bootstrap;
mod cloud;
mod components;
mod goodness;
mod incremental;
mod interval;
mod lognormal;
mod method;
mod normal;
mod outcomes;
mod profile;
mod sample;
mod shares;
mod unknown;

pub use binomial::{Counts, Line, Link};
pub use bootstrap::{Bootstrap, left_out};
pub use cloud::{CloudFit, fit_cloud};
pub use components::{Components, components};
pub use goodness::{Bin, BinnedCheck, Goodness, area_under_roc, goodness};
pub use incremental::{fit_incremental, fit_moments};
pub use interval::{Interval, Replicates};
pub use lognormal::LogNormal;
pub use method::{Fitted, Method};
pub use outcomes::{OutcomeFit, fit_curve, fit_outcomes};
pub use profile::profile_intervals;
pub use sample::{Clusters, ImpossibleObservation, Observation, Sample};
pub use shares::{Share, outcome_shares};
pub use unknown::Unknown;

//! Fragility: the probability that a wall fails, as a function of the intensity of the ground motion.
//!
//! | module | idea |
//! | --- | --- |
//! | [`Sample`] | observations: intensity, failures, trials, demand, clusters |
//! | [`Method`] | outcomes and stripes (maximum likelihood), incremental analyses, clouds |
//! | [`Unknown`] | why data tell no fragility; it takes the place of a number |
//! | [`Bootstrap`], [`Replicates`] | intervals over records, façades or both |
//! | [`profile_intervals`] | intervals of independent outcomes |
//! | [`read_groups`], [`Expression`] | from a table to samples |
//! | [`analyse`] | all of the above for one sample |
//! | [`report`], [`nrml_document`] | tables, JSON, curves, OpenQuake's format |
//! | [`goodness`], [`outcome_shares`], [`components`] | how well, and scatter from what |

mod analysis;
mod binomial;
mod bootstrap;
mod cloud;
mod components;
mod expression;
mod goodness;
mod groups;
mod incremental;
mod interval;
mod method;
mod nrml;
mod outcomes;
mod profile;
pub mod report;
mod sample;
mod shares;
mod table;

pub use analysis::{Analysis, BootstrapResult, Bounds, Known, Settings, analyse};
pub use binomial::{Counts, Line, Link};
pub use bootstrap::{Bootstrap, REPLICATES, left_out};
pub use cloud::{CloudFit, fit_cloud};
pub use components::{Components, components};
pub use expression::{ALLOWED as EXPRESSION_ALLOWED, Expression, NotAnExpression};
pub use goodness::{Bin, BinnedCheck, Goodness, area_under_roc, goodness};
pub use groups::{Columns, Group, Outcomes, read_groups};
pub use incremental::{fit_incremental, fit_moments};
pub use interval::{Interval, Replicates};
pub use method::{Fitted, LogNormal, Method, Unknown};
pub use nrml::{IntensityMeasure, NotAMeasure, document as nrml_document};
pub use outcomes::{OutcomeFit, fit_curve, fit_outcomes};
pub use profile::profile_intervals;
pub use sample::{Clusters, ImpossibleObservation, Observation, Sample};
pub use shares::{Share, outcome_shares};
pub use table::{Cells, Table};

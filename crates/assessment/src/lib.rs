//! The Italian code's check of a local mechanism, and what the dynamics of the same wall say of it.
//!
//! Circolare 21 gennaio 2019, n. 7 (to NTC 2018): C8.7.1.2.1 for mechanisms, C7.2.3 for floors. Equation numbers that begin
//! with C are its.
//!
//! | module | from | to |
//! | --- | --- | --- |
//! | [`SiteFile`] | what an engineer writes of site and building | values that are valid |
//! | [`Capacity`] | a wall | mechanism, α_0, e*, α(d), d_0 |
//! | [`Place`] | site and floor | what the code asks, and the a_g at which it asks what the wall has |
//! | [`StaticCheck`] | capacity and place | a_0, T_SLV, a_g,SLV, ζ; the linear check; the line of 2009 |
//! | [`SiteRecords`] | records of the site | what their own spectra ask of the wall |
//! | [`Shaken`], [`Dynamic`] | the wall under records | how many go beyond d_0, the mean of the largest displacements |
//! | [`Assessment`] | all of them | both side by side |
//! | [`Hazard`], [`annual_rate`] | fragility and hazard curve | annual rates of limit states |
//!
//! What holds the top enters like this. m_d is a weight carried: it lifts and pushes (P_k). m_dp pushes only (Q_k). A
//! spring at the top has no force before it moves, so it is not in α_0 of a single mechanism. It is in the capacity curve.
//! Where the spring is as good as rigid the mechanism is vertical bending between supports, and the masses at the top are
//! the support's. Between a free top and a rigid support the wall follows its equilibrium on the springs, and α_0 is the
//! largest multiplier that it bears.

mod assessment;
mod capacity;
mod check;
mod demand;
mod dynamic;
mod hazard;
mod site_file;
mod site_records;

pub use assessment::{Agreement, Assessment, EdgeName, EdgeRow, MechanismRow};
pub use capacity::{
    Capacity, Control, CurvePoint, Governing, LIMIT_STATES, NoMechanism, least_crack, mechanisms,
};
pub use check::{DAMPING, Earlier, Linear, StaticCheck};
pub use demand::Place;
pub use dynamic::{Dynamic, RecordRun, Shaken, TAIL_S, Unfinished, motions};
pub use hazard::{Hazard, HazardPoint, NoHazard, Rate, Uncertainty, annual_rate, rate_quantiles};
pub use site_file::{Assumed, SiteFile};
pub use site_records::SiteRecords;

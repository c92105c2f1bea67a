//! The source's conclusions, each with a criterion, checked against the medians of a study.
//!
//! A finding is a pure function of the medians of one variant. It answers `holds`, `does not` or `undecided`, always
//! with the numbers that decide; nothing is fitted to what comes out.

mod amplitude;
mod change;
mod diaphragm;
mod distributions;
mod geometry;
mod report;
mod sensitivity;
mod tables;
mod text;
mod variants;
mod verdict;
mod view;

pub use distributions::report_distributions;
pub use report::{report, write_findings};
pub use text::aligned;
pub use verdict::{Answer, Verdict, Vote};
pub use view::{Point, Slender, View};

/// A conclusion of the source and how it is checked.
pub struct Finding {
    /// Short name, unique.
    pub name: &'static str,
    /// What the source says.
    pub claim: &'static str,
    /// Where it says so.
    pub source: &'static str,
    /// When the claim holds.
    pub criterion: &'static str,
    /// The check.
    pub check: fn(&View) -> Answer,
}

/// All findings, in the order of the source.
pub const FINDINGS: [Finding; 14] = [
    amplitude::ONLY_SLENDER,
    amplitude::PARALLEL_MORE,
    amplitude::PARALLEL_FIVEFOLD,
    geometry::REVERSE_SCALE,
    geometry::REVERSE_SCALE_PARALLEL,
    geometry::HIGHER_CRACK,
    geometry::UPPER_BELOW_LOWER,
    geometry::STRENGTH_NEGLIGIBLE,
    diaphragm::STIFFER_LESS,
    diaphragm::PERPENDICULAR_MASS,
    diaphragm::PARALLEL_MASS,
    sensitivity::RECORD_SPREAD,
    sensitivity::COEFFICIENTS_LITTLE,
    sensitivity::COEFFICIENTS_SLENDER_PARALLEL,
];

//! The source's conclusions, each with a criterion, checked against the medians of a study.
//!
//! A finding is a pure function of the medians of one variant. It answers `holds`, `does not` or `undecided`, always
//! with the numbers that decide; nothing is fitted to what comes out. Of what a study does not vary it is not asked.

mod amplitude;
mod change;
mod conclusion;
mod diaphragm;
mod distributions;
mod geometry;
mod report;
mod sensitivity;
mod sequences;
mod tables;
mod view;
mod vote;

use conclusion::Needs;

pub use conclusion::{Conclusion, Conclusions, SURE, Sureness, conclusions, sure_rules, sureness};
pub use distributions::report_distributions;
pub use report::{report, write_findings};
pub use sequences::{AFTER_RULES, after_cells, report_sequences};
pub use view::{Point, Slender, View};
pub use vote::{Answer, FloorVotes, Verdict, Vote, rules};

/// A conclusion of the source and how it is checked.
pub struct Finding {
    /// Short name, unique.
    pub name: &'static str,
    /// What the source says, in the few words of a table.
    pub label: &'static str,
    /// What the source says.
    pub claim: &'static str,
    /// Where it says so.
    pub source: &'static str,
    /// When the claim holds.
    pub criterion: &'static str,
    needs: Needs,
    check: fn(&View) -> Answer,
}

impl Finding {
    /// What the medians of a variant say of it.
    pub fn answer(&self, view: &View) -> Answer {
        match self.needs.missing(view) {
            None => (self.check)(view),
            Some(missing) => Answer {
                verdict: Verdict::NotAsked,
                short: String::new(),
                numbers: format!("the study has no {missing}"),
            },
        }
    }
}

/// All findings, in the order of the source.
pub const FINDINGS: [Finding; 15] = [
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
    diaphragm::PERPENDICULAR_MASS_LITTLE,
    diaphragm::PARALLEL_MASS,
    sensitivity::RECORD_SPREAD,
    sensitivity::COEFFICIENTS_LITTLE,
    sensitivity::COEFFICIENTS_SLENDER_PARALLEL,
];

/// How many conclusions a study was asked, and how many of them hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Held {
    /// Those that hold.
    pub holds: usize,
    /// Those whose subject the study varies.
    pub asked: usize,
}

impl Held {
    /// Of the conclusions under one variant.
    pub fn among(conclusions: &[Conclusion]) -> Self {
        let count = |keep: fn(&Verdict) -> bool| {
            conclusions.iter().filter(|conclusion| keep(&conclusion.verdict())).count()
        };
        Self {
            holds: count(|verdict| *verdict == Verdict::Holds),
            asked: count(|verdict| *verdict != Verdict::NotAsked),
        }
    }

    /// Those that the study does not vary.
    pub fn not_asked(self) -> usize {
        FINDINGS.len() - self.asked
    }
}

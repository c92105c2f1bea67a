//! The runs of a case, and those of them that a draw takes.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::medians::{Case, Measure, Median, Middle};
use super::quantile::median;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ended {
    /// With these largest rotations, in the order of [`Measure::ALL`].
    Stood([f64; 4]),
    Collapsed,
    Failed,
}

/// The runs of a case: by record those that answer for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CaseRuns {
    pub case: Case,
    pub parameter_value: Option<f64>,
    pub by_record: Vec<Vec<Ended>>,
}

impl CaseRuns {
    /// The median of no run.
    pub fn nothing(&self, measure: Measure) -> Median {
        Median {
            case: self.case.clone(),
            parameter_value: self.parameter_value,
            measure,
            runs: 0,
            collapsed: 0,
            failed: 0,
            quantiles: [None; 7],
            interval: None,
        }
    }
}

/// The runs of a case that were drawn.
#[derive(Debug, Default)]
pub(super) struct Drawn {
    pub runs: u64,
    pub collapsed: u64,
    pub failed: u64,
    /// Rotations of those that stand, increasing, by [`Measure::ALL`].
    pub standing: [Vec<f64>; 4],
}

impl Drawn {
    /// Takes one member of each of these records.
    pub fn draw(&mut self, case: &CaseRuns, records: &[usize], rng: &mut ChaCha8Rng) {
        (self.runs, self.collapsed, self.failed) = (0, 0, 0);
        self.standing.iter_mut().for_each(Vec::clear);
        for members in records.iter().map(|&record| &case.by_record[record]).filter(|m| !m.is_empty()) {
            self.runs += 1;
            match members[rng.random_range(0..members.len())] {
                Ended::Stood(rotations) => {
                    self.standing.iter_mut().zip(rotations).for_each(|(of, rotation)| of.push(rotation));
                }
                Ended::Collapsed => self.collapsed += 1,
                Ended::Failed => self.failed += 1,
            }
        }
        self.standing.iter_mut().for_each(|of| of.sort_unstable_by(f64::total_cmp));
    }

    /// As [`Median::middle`], by measure.
    pub fn middles(&self) -> [Option<Middle>; 4] {
        let collapsed = (self.collapsed > 0).then_some(Middle::Collapsed);
        self.standing
            .each_ref()
            .map(|standing| median(standing, self.collapsed as usize).map(Middle::Rotation).or(collapsed))
    }
}

//! A test as the search sees it: how the wall was shaken, what was measured, and what a simulation costs.

use std::path::Path;

use super::measured::Measured;
use super::misfit::{Comparison, Errors, Target};
use crate::error::{InputError, Result};
use crate::ground::{Accelerogram, ReadOptions, read};
use crate::input::experiment::{Purpose, TestTable};
use crate::model::Wall;
use crate::simulate::{Accuracy, Outcome, Response, Shaking, simulate_observed};

/// One test of an experiment.
#[derive(Debug, Clone)]
pub struct Test {
    /// Name in results.
    pub name: String,
    /// Whether the search sees it.
    pub purpose: Purpose,
    /// The ground motion, up to the end of what counts.
    pub shaking: Shaking,
    /// What was measured.
    pub target: Target,
    /// When the measured wall collapsed, s.
    pub collapse_s: Option<f64>,
}

/// What one simulation of one test gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulated {
    /// Eq. 8; none where the run could not be finished.
    pub wme: Option<f64>,
    /// `stood`, `collapsed` or `failed`.
    pub outcome: &'static str,
    /// When the simulated wall collapsed, s.
    pub collapse_s: Option<f64>,
    /// Impacts that were changes of Table 2, C_1 … C_8 in order.
    pub transitions: [u64; 8],
    /// The errors by block.
    pub errors: Errors,
}

impl Test {
    /// Reads a test of an experiment; its paths are relative to `folder`.
    ///
    /// # Errors
    /// Input errors of the record or the measured file, or if nothing that was measured counts.
    pub fn load(folder: &Path, table: &TestTable, wall: &Wall) -> Result<Self> {
        let options = ReadOptions { step_s: table.record_step_s, ..ReadOptions::default() };
        let record = read(&folder.join(&table.record), &options)?.accelerogram.scaled(table.scale);
        let path = folder.join(&table.measured);
        let measured = Measured::load(&path, table, wall)?;
        let target = Target::new(&measured, &table.windows_s, wall).ok_or_else(|| {
            let allowed = "samples in the record's time, inside windows_s, before a collapse, \
                           not all parted by gaps";
            InputError::file(&path, format!("nothing that counts in test {:?}", table.name), allowed)
        })?;
        let shaking = shaking(&record, target.end_s());
        let collapse_s = measured.collapse_s;
        Ok(Self { name: table.name.clone(), purpose: table.purpose, shaking, target, collapse_s })
    }

    /// The same test up to the time by which a share of the measured motion has passed.
    #[must_use]
    pub fn shortened(&self, share: f64) -> Self {
        let target = self.target.shortened(share);
        let shaking = match &self.shaking.horizontal {
            Some(record) => shaking(record, target.end_s()),
            None => self.shaking.clone(),
        };
        Self { target, shaking, ..self.clone() }
    }

    /// Runs a wall through the test and compares.
    pub fn simulate(&self, wall: &Wall, accuracy: Accuracy) -> Simulated {
        let mut comparison = Comparison::new(&self.target).read_by(wall.reading());
        let response = simulate_observed(wall, &self.shaking, accuracy, &mut comparison);
        self.compared(&response, comparison.errors())
    }

    fn compared(&self, response: &Response, errors: Errors) -> Simulated {
        let wme = match response.outcome {
            Outcome::Failed { .. } => None,
            _ => Some(self.target.wme(&errors)).filter(|wme| wme.is_finite()),
        };
        let collapse_s = match response.outcome {
            Outcome::Collapsed { time_s } => Some(time_s),
            _ => None,
        };
        let transitions = response.impacts.table2;
        Simulated { wme, outcome: response.outcome.name(), collapse_s, transitions, errors }
    }
}

/// The record cut where nothing counts any more, or free motion added until there.
///
/// What comes after a time does not change what came before it, so the cut changes no result.
fn shaking(record: &Accelerogram, end_s: f64) -> Shaking {
    let step_s = record.step_s();
    let samples = record.acceleration_m_s2();
    let needed = (end_s / step_s).ceil() as usize + 2;
    let kept = if needed < samples.len() {
        // A part of a valid record, two samples at least, is valid.
        Accelerogram::new(step_s, samples[..needed].to_vec()).unwrap_or_else(|_| record.clone())
    } else {
        record.clone()
    };
    let tail_s = (end_s - kept.duration_s()).max(0.0);
    Shaking { horizontal: Some(kept), vertical: None, tail_s }
}

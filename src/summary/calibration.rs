//! A calibration, and its tests simulated again with the calibrated wall.

use std::path::Path;

use super::file::{Note, found_again, read_json};
use crate::error::Result;
use mrbd_kernel::model::Wall;
use mrbd_lab::calibrate::{Calibration, Experiment};
use mrbd_lab::experiment::Measured;
use mrbd_lab::release::Moments;

/// Rows of a simulated history, s.
const STEP_S: f64 = 0.01;

/// A calibration as its page shows it.
#[derive(Debug)]
pub struct Calibrated {
    /// What was found.
    pub stored: Calibration,
    /// Its manifest.
    pub note: Note,
    /// The tests in the order of the experiment; `None` where its files are gone or other ones now.
    pub tests: Option<Vec<TestRotations>>,
    /// What releases of a held strip say of its joints; `None` where there are none, or their files are gone.
    pub moments: Option<Moments>,
}

/// Rotations over slenderness angles by time, s; a value that is no number breaks the line.
pub type Rotations = Vec<(f64, f64)>;

/// Rotations in one test, body by body: two of a cracked wall, one of a whole one.
#[derive(Debug)]
pub struct TestRotations {
    /// As measured; empty for a channel that is lost.
    pub measured: Vec<Rotations>,
    /// Of the calibrated wall, from rest.
    pub simulated: Vec<Rotations>,
}

impl Calibrated {
    /// Reads the calibration in a folder.
    ///
    /// # Errors
    /// An input error for files that are none of a calibration.
    pub fn read(folder: &Path) -> Result<Self> {
        let stored: Calibration =
            read_json(&folder.join("calibration.json"), "results as `mrbd calibrate` writes them, finished")?;
        let note = Note::read(&folder.join("manifest.json"))?;
        let experiment = experiment(folder, &note, &stored);
        let tests = experiment.as_ref().and_then(|experiment| tests(experiment, &stored));
        let moments = experiment.as_ref().and_then(|experiment| experiment.moments().ok()?);
        Ok(Self { stored, note, tests, moments })
    }
}

/// The experiment as it was calibrated; `None` where its files are gone or other ones now.
fn experiment(folder: &Path, note: &Note, stored: &Calibration) -> Option<Experiment> {
    let path = found_again(folder, &note.inputs, "experiment")?;
    let experiment = Experiment::load(&path, Some(stored.seed)).ok()?;
    (experiment.request == stored.request_sha256).then_some(experiment)
}

fn tests(experiment: &Experiment, stored: &Calibration) -> Option<Vec<TestRotations>> {
    let wall = experiment.space.wall(&stored.joint.values).ok()?;
    Some((0..experiment.tests.len()).map(|index| rotations(experiment, &wall, index)).collect())
}

fn rotations(experiment: &Experiment, wall: &Wall, index: usize) -> TestRotations {
    let test = &experiment.tests[index];
    let history = test.history(wall, experiment.accuracy(), STEP_S);
    let alpha_rad = wall.alpha_i_rad();
    let bodies = if wall.is_cracked() { 0..2 } else { 0..1 };
    let simulated = |body: usize| {
        history.rows.iter().map(|row| (row.time_s, row.theta_rad[body] / alpha_rad[body])).collect()
    };
    TestRotations {
        measured: bodies.clone().map(|body| measured(&test.measured, body, alpha_rad[body])).collect(),
        simulated: bodies.map(simulated).collect(),
    }
}

/// Measured samples, broken where samples are missing.
fn measured(measured: &Measured, body: usize, alpha_rad: f64) -> Rotations {
    let Some(theta) = &measured.theta_rad[body] else { return Vec::new() };
    let mut line = Rotations::new();
    for (&time_s, theta) in measured.time_s.iter().zip(theta) {
        if line.last().is_some_and(|last| time_s - last.0 > measured.gap_s) {
            line.push((time_s, f64::NAN));
        }
        line.push((time_s, theta / alpha_rad));
    }
    line
}

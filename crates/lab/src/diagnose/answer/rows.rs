//! Rows of the tables of a diagnosis.

use crate::diagnose::force::{Against, ForcePoint, Jump};
use crate::experiment::Purpose;
use mrbd_kernel::model::{Contact, Pair};
use mrbd_kernel::simulate::Impacts;

/// The data behind the figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Tables {
    /// Every sample of every test.
    pub samples: Vec<Sample>,
    /// Every window, in the order of tests and times.
    pub windows: Vec<WindowRow>,
    /// The missing force, stretch by stretch.
    pub force: Vec<ForceRow>,
    /// Velocities after impacts, under the wall as given and then as updated.
    pub jumps: Vec<JumpRow>,
    /// Curves of the laws of the best hypotheses.
    pub laws: Vec<LawPoint>,
    /// Every added number of every hypothesis, the best first.
    pub rivals: Vec<RivalRow>,
}

/// One sample of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// Time in the record, s.
    pub time_s: f64,
    /// θ_1 and θ_2 as read, rad; NaN where missing.
    pub measured_rad: Pair,
    /// Contact state, where the measurement leaves no doubt.
    pub measured_contact: Option<Contact>,
    /// Rotations, rad, and contact of whole runs from rest, before and after; `None` beyond a collapse.
    pub simulated: [Option<(Pair, Contact)>; 2],
    /// Measured less simulated over the noise, in windows, before and after.
    pub residual: [Option<Pair>; 2],
}

/// One window.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowRow {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// First sample, s.
    pub from_s: f64,
    /// Last sample, s.
    pub to_s: f64,
    /// Contact state at its start, as fitted.
    pub contact: Contact,
    /// Impacts of the updated wall in it.
    pub impacts: Impacts,
    /// Root mean square error over the noise: before, recalibrated, after.
    pub error: [Option<f64>; 3],
}

/// The missing force in one stretch.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceRow {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// What is missing in the wall as given.
    pub point: ForcePoint,
    /// The force that the updated wall leaves there, N.
    pub after_n: Option<f64>,
}

/// One change of pattern, under one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct JumpRow {
    /// The test.
    pub test: String,
    /// `given` or `updated`.
    pub wall: &'static str,
    /// The change.
    pub jump: Jump,
}

/// One point of the law of a hypothesis.
#[derive(Debug, Clone, PartialEq)]
pub struct LawPoint {
    /// The hypothesis.
    pub name: String,
    /// The quantity that x is.
    pub against: Against,
    /// Displacement, velocity or absolute acceleration of the top, SI units.
    pub x: f64,
    /// Force that the hypothesis adds at the top, N.
    pub force_n: f64,
}

/// One added number of one hypothesis.
#[derive(Debug, Clone, PartialEq)]
pub struct RivalRow {
    /// Place of the hypothesis in the order, from 1.
    pub rank: u64,
    /// What is added to the wall.
    pub name: String,
    /// Where the first addition acts.
    pub place: &'static str,
    /// Whether it is an effect, and no number of the wall or placebo.
    pub is_answer: bool,
    /// Key of the number.
    pub parameter: String,
    /// Its unit.
    pub unit: &'static str,
    /// As fitted.
    pub value: f64,
    /// Standard deviation by the curvature of the fit; `None` where it leaves no trace.
    pub sd: Option<f64>,
    /// Windowed error over the noise: tests to fit, tests held out.
    pub error: [Option<f64>; 2],
    /// What speaks against it, in natural logarithms of likelihood.
    pub against: f64,
}

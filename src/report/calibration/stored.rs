//! `calibration.json` and the manifest beside it, as far as the page tells of them.

use std::path::Path;

use serde::Deserialize;

use super::super::provenance::read_json;
use crate::error::Result;

/// What a calibration found; a misfit that is not finite is none.
#[derive(Debug, Deserialize)]
pub struct Stored {
    pub request_sha256: String,
    pub seed: u64,
    pub law: String,
    pub capture_velocity_rad_s: f64,
    pub tolerance: f64,
    pub bounds_source: String,
    pub methods: Vec<StoredMethod>,
    pub joint: StoredVector,
    pub joint_from: String,
    pub parameters: Vec<StoredParameter>,
    pub tests: Vec<StoredTest>,
    pub capture_study: Vec<StoredCapture>,
    pub simulations: u64,
}

#[derive(Debug, Deserialize)]
pub struct StoredVector {
    pub values: Vec<f64>,
    pub mean_wme: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredMethod {
    pub method: String,
    pub test: Option<String>,
    pub best: StoredVector,
    pub simulations: u64,
    pub best_costs: Vec<Option<f64>>,
}

#[derive(Debug, Deserialize)]
pub struct StoredParameter {
    pub name: String,
    pub lower_bound: f64,
    pub upper_bound: f64,
    pub value: f64,
    pub identifiability: String,
    pub interval_95: Option<[f64; 2]>,
    pub on_bound: bool,
    pub by_test: Vec<Option<f64>>,
    pub profile: Vec<StoredProfile>,
}

#[derive(Debug, Deserialize)]
pub struct StoredProfile {
    pub from: f64,
    pub to: f64,
    pub mean_wme: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredTest {
    pub name: String,
    pub purpose: String,
    pub wme_before: Option<f64>,
    pub wme_joint: Option<f64>,
    pub wme_alone: Option<f64>,
    pub transitions: [u64; 8],
    pub measured_collapse_s: Option<f64>,
    pub simulated_collapse_s: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub struct StoredCapture {
    pub law: String,
    pub capture_velocity_rad_s: f64,
    pub wme_of_joint: Option<f64>,
    pub wme_of_best: Option<f64>,
}

impl Stored {
    /// Reads `calibration.json`.
    ///
    /// # Errors
    /// An input error for a file that is not there or none of a calibration.
    pub fn read(path: &Path) -> Result<Self> {
        read_json(path, "results as `mrbd calibrate` writes them, finished")
    }
}

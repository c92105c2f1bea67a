//! What the response of a façade is sure to vary with: shares of the variance by record, façade, coefficients, assumptions, and
//! by what no input decides.
//!
//! Sobol' indices ([`mrbd_statistics::PickFreeze`]) of a study of kind `variance`. The record is one of the suite's, each as
//! likely as another; the façade is drawn from the survey, coefficients from their bounds, assumptions from the levels
//! and ranges of the pipeline, and the member of the ensemble ("chaos") evenly: ground motions of a member differ
//! by up to a millionth. Intervals are of a bootstrap over the points (Efron 1979).

mod outputs;
mod runs;
mod shares;
mod table;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use crate::study::pipeline::Kind;
use crate::study::runs::{Completeness, Manifest};
use crate::survey::Configuration;
pub use outputs::{CLIP, Output};
use runs::Runs;
pub use table::{print_csv, print_tables, write_table};

/// What a manifest says such results are.
pub const KIND: &str = "shares_of_variance";

/// What is written beside the page.
pub const FILES: [&str; 4] = ["manifest.json", "variance.json", "indices.parquet", "indices.csv"];

/// Name of the record among the inputs.
pub const RECORD: &str = "record";

/// The inputs that together are all there are, in the order in which they are told.
pub const MAIN: [&str; 5] = [RECORD, "facade", "coefficients", "assumptions", "chaos"];

/// The shares of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Name of the study.
    pub study: String,
    /// Name of the suite.
    pub suite: String,
    /// Whether it is generated rather than measured.
    pub generated: bool,
    /// Its records.
    pub records: usize,
    /// Runs of the study: points × matrices × records × floors.
    pub runs: u64,
    /// One a floor.
    pub floors: Vec<OfFloor>,
}

/// The shares under a floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OfFloor {
    /// How the floor runs.
    pub configuration: Configuration,
    /// Points that are told of.
    pub points: usize,
    /// Points left out, as one of their runs failed in some matrix or under some record.
    pub left_out: usize,
    /// One for each of [`Output::ALL`].
    pub outputs: Vec<OfOutput>,
}

/// The shares of an output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OfOutput {
    /// What varies.
    pub output: Output,
    /// Its mean.
    pub mean: f64,
    /// Its variance; 0 where it does not vary, and there are no shares.
    pub variance: f64,
    /// One an input or group of inputs: [`MAIN`] first, then the others.
    pub shares: Vec<Share>,
}

/// Sobol' indices of an input, or of a group of inputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Its name.
    pub input: String,
    /// Whether it is a group of others.
    pub is_group: bool,
    /// Share of the variance that would go if it were known, on average.
    pub first: f64,
    /// Its 90 % interval.
    pub first_interval: [f64; 2],
    /// Share of the variance that would be left if all others were known, on average.
    pub total: f64,
    /// Its 90 % interval.
    pub total_interval: [f64; 2],
}

impl OfFloor {
    /// Share of the runs of A and B in which the wall fell.
    pub fn fallen(&self) -> f64 {
        self.outputs.iter().find(|of| of.output == Output::Collapse).map_or(f64::NAN, |of| of.mean)
    }
}

impl Share {
    /// "0.31 (0.28 to 0.34)" of the first-order and of the total index.
    pub fn told(&self) -> [String; 2] {
        // A share that rounds to nothing has no sign.
        let two = |value: f64| format!("{:.2}", if value.abs() < 0.005 { 0.0 } else { value });
        let told =
            |value: f64, [low, high]: [f64; 2]| format!("{} ({} to {})", two(value), two(low), two(high));
        [told(self.first, self.first_interval), told(self.total, self.total_interval)]
    }
}

impl OfOutput {
    /// The share of an input.
    pub fn share(&self, input: &str) -> Option<&Share> {
        self.shares.iter().find(|share| share.input == input)
    }
}

/// The shares of the study in a folder.
///
/// # Errors
/// Input errors for a folder without a whole study of this kind; [`crate::Error::Table`] for files that cannot be read.
pub fn of_folder(folder: &Path) -> Result<Shares> {
    let path = folder.join("manifest.json");
    let manifest =
        Manifest::read(&path)?.filter(|manifest| manifest.kind == Kind::Variance).ok_or_else(|| {
            InputError::file(
                &path,
                "no manifest of such a study",
                "the folder of a study of kind variance by `mrbd run`",
            )
        })?;
    if let Some(note) = Completeness::of(folder)?.and_then(|study| study.note()) {
        let allowed = "a whole study: `mrbd run … --resume` does the rest";
        return Err(InputError::file(folder, note, allowed).into());
    }
    let runs = Runs::read(folder)?;
    Ok(Shares {
        study: manifest.plan.clone(),
        suite: manifest.suite.name.clone(),
        generated: manifest.suite.generated,
        records: manifest.suite.records.len(),
        runs: manifest.runs,
        floors: runs.iter().map(Runs::shares).collect(),
    })
}

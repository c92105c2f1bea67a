//! The data behind the figures of a diagnosis, in Parquet beside `diagnosis.json`.
//!
//! ```text
//! histories.parquet     every sample: measured, simulated before and after, patterns, errors over windows
//! windows.parquet       every window: its error under the wall as given, recalibrated and updated, and its impacts
//! force.parquet         the missing force at the top, stretch by stretch, and what the updated wall leaves of it
//! jumps.parquet         velocities after impacts over those of the model
//! laws.parquet          laws of the best hypotheses, to be drawn through the force
//! rivals.parquet        every hypothesis that was tried, a row a number
//! ```

mod force;
mod histories;
mod jumps;
mod laws;
mod rivals;
mod windows;

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::Result;
use mrbd_kernel::model::{Contact, Pivot, RockingWall};
use mrbd_lab::diagnose::experiment::Experiment;
use mrbd_lab::diagnose::flow::Diagnosis;
use mrbd_lab::diagnose::force::{
    Against, ForcePoint, LawCurve, explained_by, force_points, jumps, law_curves, median_share_off_top,
};
use mrbd_lab::diagnose::hypothesis::Physics;
use mrbd_lab::diagnose::trials::Tried;
use serde_json::{Value, json};

/// Names of the tables.
pub const TABLES: [&str; 6] = [
    "histories.parquet",
    "windows.parquet",
    "force.parquet",
    "jumps.parquet",
    "laws.parquet",
    "rivals.parquet",
];

/// Both joints open: the arms of a force at the top are the heights of the crack and of the upper body.
const UPRIGHT: Contact = Contact { ground: Pivot::Right, crack: Pivot::Right };

/// A diagnosis with what its tables are made of.
#[derive(Debug)]
pub struct Tables<'a> {
    experiment: &'a Experiment,
    diagnosis: &'a Diagnosis,
    /// The wall as given, and the wall of the answer: as given where there is none.
    physics: [Physics; 2],
    force: [Vec<ForcePoint>; 2],
    laws: Vec<LawCurve>,
}

impl<'a> Tables<'a> {
    /// Works out what the tables hold; none if a wall of the diagnosis is none, which is a defect.
    pub fn new(experiment: &'a Experiment, diagnosis: &'a Diagnosis) -> Option<Self> {
        let physics = |tried: &Tried| tried.hypothesis.physics(&tried.fit.values);
        let physics = [physics(&diagnosis.found.before)?, physics(diagnosis.found.kept())?];
        let force = [0, 1].map(|i| force_points(&experiment.tests, &physics[i]));
        let laws = law_curves(&experiment.wall, &diagnosis.found.tried, &force[0]);
        Some(Self { experiment, diagnosis, physics, force, laws })
    }

    /// Writes all of them.
    ///
    /// # Errors
    /// [`crate::Error::Table`] or [`crate::Error::Io`] if the disk refuses.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let [histories, windows, force, jumps, laws, rivals] = TABLES.map(|name| folder.join(name));
        self.write_histories(&histories)?;
        self.write_windows(&windows)?;
        self.write_force(&force)?;
        self.write_jumps(&jumps)?;
        self.write_laws(&laws)?;
        self.write_rivals(&rivals)
    }

    /// What the missing force comes to, for `diagnosis.json`.
    pub fn summary(&self) -> Value {
        let size = |points: &[ForcePoint]| {
            let squares = points.iter().map(|p| p.force_n * p.force_n).sum::<f64>();
            let noise = points.iter().map(|p| p.force_sd_n * p.force_sd_n).sum::<f64>();
            let count = (points.len() as f64).max(1.0);
            json!({"rms_n": (squares / count).sqrt(), "noise_rms_n": (noise / count).sqrt()})
        };
        let off = median_share_off_top(&self.force[0]);
        let explained = Against::ALL.map(|against| (against.name(), explained_by(&self.force[0], against)));
        let explained = BTreeMap::from(explained);
        json!({
            "points": self.force[0].len(),
            "before": size(&self.force[0]),
            "after": size(&self.force[1]),
            "median_share_off_top": off.map(|o| o.0),
            "explained_by": explained,
            "points_with_direction": off.map_or(0, |o| o.1),
            "arms_of_top_m": RockingWall::new(&self.physics[0].wall).top_arms_m(UPRIGHT, [0.0; 2]),
        })
    }

    fn test_name(&self, index: usize) -> &str {
        &self.experiment.tests[index].name
    }

    fn jumps_of(&self, which: usize) -> Vec<mrbd_lab::diagnose::force::Jump> {
        jumps(&self.experiment.tests, &self.physics[which])
    }
}

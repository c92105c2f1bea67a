//! One run: a wall under a ground motion, from the first sample to the end of free motion.

mod alone;
mod bed_events;
mod beyond_model;
mod ensemble;
mod events;
mod ground_path;
mod history;
mod lane_accounts;
mod lane_beds;
mod lane_closings;
mod lane_impacts;
mod lane_kinks;
mod lane_paths;
mod lane_steps;
mod lane_values;
mod response;
mod rest;
mod row;
mod run;
mod sequence;
mod side_by_side;
mod simulator;
mod switches;
mod totals;

pub use beyond_model::{BeyondModel, beyond_model, floor_period_s};
pub use ensemble::{
    Change, Ensemble, MEMBERS, MEMBERS_IN_CHAOS, Verdict, simulate_ensemble, simulate_members,
};
pub use ground_path::FREE_RELEASE_STEP_S;
pub use history::{History, HistoryRow, Observer};
pub use response::{EnergyLedger, Impacts, JointDemand, Openings, Outcome, Peak, Response, Work};
pub use sequence::{following, simulate_sequence};
pub use side_by_side::{
    Prepared, simulate_side_by_side, simulate_side_by_side_at, simulate_watched_side_by_side,
};
pub use simulator::{Simulator, Start};

use crate::accelerogram::Accelerogram;
use crate::model::Wall;

/// What shakes the wall: a horizontal record, perhaps a vertical one, and the free motion after them.
#[derive(Debug, Clone, Default)]
pub struct Shaking {
    /// Horizontal ground acceleration; `None`: a free release.
    pub horizontal: Option<Accelerogram>,
    /// Vertical ground acceleration, at the same step; zero after its end.
    pub vertical: Option<Accelerogram>,
    /// Free motion after the last sample, s.
    pub tail_s: f64,
}

impl Shaking {
    /// Whether another shaking is this one, its samples shared; decided without looking at them.
    pub fn shares_samples_with(&self, other: &Self) -> bool {
        let same = |a: &Option<Accelerogram>, b: &Option<Accelerogram>| match (a, b) {
            (Some(a), Some(b)) => a.shares_samples_with(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        same(&self.horizontal, &other.horizontal)
            && same(&self.vertical, &other.vertical)
            && self.tail_s == other.tail_s
    }
}

/// How accurately to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Error allowed in rotations relative to α_i, over a well-conditioned run.
    pub tolerance: f64,
}

impl Accuracy {
    /// Tolerances that make sense, of every command and file. Below, rounding and not the step makes the error.
    pub const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-13..=1e-2;
    /// [`Accuracy::TOLERANCES`] in words.
    pub const ALLOWED: &'static str = "1e-13 to 1e-2";
}

impl Default for Accuracy {
    fn default() -> Self {
        Self { tolerance: 1e-6 }
    }
}

/// Runs one wall; pure: the same inputs give the same bits on any thread.
pub fn simulate(wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Response {
    Simulator::new(wall, shaking, accuracy).prepared().run_alone()
}

/// Runs one wall and gives an observer every stretch of it; the response has the same bits as without.
pub fn simulate_observed(
    wall: &Wall,
    shaking: &Shaking,
    accuracy: Accuracy,
    observer: &mut dyn Observer,
) -> Response {
    Simulator::new(wall, shaking, accuracy).run(observer)
}

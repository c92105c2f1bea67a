//! The response of a run: maxima, patterns, events, energy.

use serde::{Deserialize, Serialize};

use super::simulator::Start;
use crate::model::Table2Change;

/// A largest value over a run: size, sign and when.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Peak {
    /// The value with its sign; its magnitude is the largest of the run.
    pub value: f64,
    /// When it was reached, s.
    pub time_s: f64,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Outcome {
    /// The wall stood until the end, or until its observer had seen enough.
    Stood,
    /// A body passed its collapse rotation.
    Collapsed {
        /// When, s.
        time_s: f64,
    },
    /// The run could not be finished.
    Failed {
        /// When, s.
        time_s: f64,
        /// Why.
        reason: String,
    },
}

impl Outcome {
    /// `stood`, `collapsed` or `failed`.
    pub fn name(&self) -> &'static str {
        match self {
            Outcome::Stood => "stood",
            Outcome::Collapsed { .. } => "collapsed",
            Outcome::Failed { .. } => "failed",
        }
    }
}

/// How often joints opened, by the change of state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Openings {
    /// From rest into pattern 3: the whole wall starts to rock.
    pub rest_to_3: u64,
    /// From rest into pattern 4: the upper body starts alone.
    pub rest_to_4: u64,
    /// From rest into pattern 1 or 2: both joints at once.
    pub rest_to_both: u64,
    /// From pattern 3: the crack opens.
    pub crack: u64,
    /// From pattern 4: the ground opens.
    pub ground: u64,
}

impl Openings {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.rest_to_3 + self.rest_to_4 + self.rest_to_both + self.crack + self.ground
    }
}

/// How often joints closed on an impact, by the change of state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Impacts {
    /// The changes of Table 2, C_1 … C_8 in order, mirrored changes included.
    pub table2: [u64; 8],
    /// Changes not in Table 2.
    pub other: u64,
    /// Impacts in which a joint was captured, whatever the change.
    pub captured: u64,
}

impl Impacts {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.table2.iter().sum::<u64>() + self.other
    }

    /// Counts one impact.
    pub fn count(&mut self, change: Option<Table2Change>, captured: bool) {
        self.add(change, 1);
        self.captured += u64::from(captured);
    }

    /// Adds impacts of one change, none of them captured.
    pub(crate) fn add(&mut self, change: Option<Table2Change>, count: u64) {
        match change {
            Some(change) => self.table2[change.index()] += count,
            None => self.other += count,
        }
    }
}

/// Where the energy went, J.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyLedger {
    /// Kinetic, gravity and spring energy at the start.
    pub initial_j: f64,
    /// The same at the end.
    pub final_j: f64,
    /// Work of the ground motion on the wall.
    pub ground_work_j: f64,
    /// Lost at impacts; negative where coefficients above 1 add energy.
    pub impact_loss_j: f64,
    /// Lost in dampers and other effects.
    pub effect_loss_j: f64,
    /// Energy that passed through: |work| and |losses| added up step by step, and the initial energy.
    pub passed_through_j: f64,
}

impl EnergyLedger {
    /// What the ledger fails to account for, relative to the energy passed through; 0 where nothing moved.
    pub fn residual(&self) -> f64 {
        if self.passed_through_j == 0.0 {
            return 0.0;
        }
        let expected = self.initial_j + self.ground_work_j - self.impact_loss_j - self.effect_loss_j;
        (self.final_j - expected).abs() / self.passed_through_j
    }
}

/// What the model forbids, and how near the run came to it, at one joint.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct JointDemand {
    /// Largest |H|/N while the joint is in compression: the friction coefficient the wall needs.
    pub friction: f64,
    /// How often the pivot came under tension: the wall would have flown.
    pub tensions: u64,
    /// Largest compression at the ends of the steps of a wall that moved, N; 0 of one that did not. Impulses are not in it.
    #[serde(default)]
    pub compression_n: f64,
}

/// The work of the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Steps kept.
    pub steps: u64,
    /// Steps tried again at a smaller size.
    pub rejected_steps: u64,
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
    /// Steps that the tolerance made end before the next sample of the record. None: a coarser tolerance gives the
    /// same bits.
    pub tolerance_steps: u64,
}

/// Maxima, patterns, events, energy and effort of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Response {
    /// How the run ended.
    pub outcome: Outcome,
    /// End of the run, s.
    pub end_time_s: f64,
    /// Largest rotations of the bodies, rad; true maxima, between samples too.
    pub theta_max_rad: [Peak; 2],
    /// Slenderness angles α_1, α_2 the rotations are compared with, rad.
    pub alpha_i_rad: [f64; 2],
    /// Slenderness angle α of the uncracked wall, rad.
    pub alpha_rad: f64,
    /// Largest horizontal displacement of the top, relative to the ground, m.
    pub top_displacement_m: Peak,
    /// Largest horizontal displacement of the middle of the crack (of the top, uncracked), relative to the ground, m.
    pub crack_displacement_m: Peak,
    /// Time spent in each contact state, s, by `Contact::index`.
    pub pattern_time_s: [f64; 9],
    /// Impacts by change of state.
    pub impacts: Impacts,
    /// Openings by change of state.
    pub openings: Openings,
    /// Energy.
    pub energy: EnergyLedger,
    /// Friction and tension at the ground and at the crack.
    pub demand: [JointDemand; 2],
    /// Effort.
    pub work: Work,
    /// Where the run left the wall: what a next one starts from, see [`super::following`]. It is not written.
    #[serde(skip)]
    pub left: Start,
}

impl Response {
    /// Largest rotations over the slenderness angle of their body, without sign.
    pub fn theta_max_over_alpha_i(&self) -> [f64; 2] {
        [0, 1].map(|i| self.theta_max_rad[i].value.abs() / self.alpha_i_rad[i])
    }

    /// The larger of the two.
    pub fn theta_max_over_own_alpha(&self) -> f64 {
        let [lower, upper] = self.theta_max_over_alpha_i();
        lower.max(upper)
    }

    /// Largest rotations over the slenderness angle of the uncracked wall, without sign.
    pub fn theta_max_over_alpha(&self) -> [f64; 2] {
        self.theta_max_rad.map(|peak| peak.value.abs() / self.alpha_rad)
    }

    /// Whether a body passed its collapse rotation.
    pub fn collapsed(&self) -> bool {
        matches!(self.outcome, Outcome::Collapsed { .. })
    }
}

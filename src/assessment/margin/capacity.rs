//! The smallest factor on a record at which a wall exceeds a limit, and how sure that is.

use std::borrow::Cow;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::store::{Column, Read};
use crate::study::ladder::{Ladder, Search};
use crate::study::pipeline::Limit;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{
    Accuracy, BeyondModel, Ensemble, Outcome, Response, Shaking, beyond_model, simulate, simulate_ensemble,
};
use mrbd_records::SuiteRecord;

/// Members of the ensemble at the factor found: four times the lanes, for a share in steps of a sixteenth.
pub const MEMBERS: usize = 16;

/// What is searched.
#[derive(Debug, Clone)]
pub struct Question {
    /// The wall.
    pub wall: Wall,
    /// What it may reach at most.
    pub limit: Limit,
    /// Factors on the records.
    pub ladder: Ladder,
    /// Accuracy of the runs.
    pub accuracy: Accuracy,
    /// Free motion after a record, s.
    pub tail_s: f64,
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The limit is exceeded at a factor, and not at one a little smaller.
    Exceeded,
    /// The limit is not exceeded up to the last factor.
    Stood,
    /// The limit is exceeded at however small a factor.
    Always,
    /// A run could not be finished.
    Failed,
}

impl Status {
    /// Name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Status::Exceeded => "exceeded",
            Status::Stood => "stood",
            Status::Always => "always",
            Status::Failed => "failed",
        }
    }
}

/// What was found under a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Capacity {
    /// Name of the record.
    pub record: String,
    /// How the search ended.
    pub status: Status,
    /// Lowest factor found to exceed the limit.
    pub scale: Option<f64>,
    /// Highest factor below it that did not; where none did, the last one.
    pub stood_scale: Option<f64>,
    /// PGA at `scale`, or else at `stood_scale`, g.
    pub pga_g: Option<f64>,
    /// PGV there, m/s.
    pub pgv_m_s: Option<f64>,
    /// Share of the members of the ensemble at `scale` that exceed the limit.
    pub exceeding_share: Option<f64>,
    /// Why the model does not apply to the run at `scale`; empty where it does.
    pub beyond_model: Vec<String>,
    /// Runs of the search, the ensemble left out.
    pub runs: u64,
}

/// A run that could not be finished ends the search.
struct Unfinished;

/// Searches every record of a suite on the threads of the current pool; results in their order. `told` hears of each run
/// that begins (0) and of each record that is done (1).
pub fn capacities(
    question: &Question,
    records: &[SuiteRecord],
    told: impl Fn(usize) + Sync,
) -> Vec<Capacity> {
    records.par_iter().map(|record| question.capacity(record, &told)).inspect(|_| told(1)).collect()
}

impl Question {
    fn shaking(&self, record: &SuiteRecord, scale: f64) -> Shaking {
        let horizontal = Some(record.horizontal.scaled(scale));
        Shaking { horizontal, vertical: None, tail_s: self.tail_s }
    }

    fn capacity(&self, record: &SuiteRecord, told: &impl Fn(usize)) -> Capacity {
        let mut runs = 0;
        let mut at = |scale: f64| {
            told(0);
            runs += 1;
            let response = simulate(&self.wall, &self.shaking(record, scale), self.accuracy);
            match response.outcome {
                Outcome::Failed { .. } => Err(Unfinished),
                _ => Ok((self.limit.exceeded_by(&response), ())),
            }
        };
        let search = self.ladder.first_exceeding(&mut at);
        let (status, scale, stood_scale) = match search {
            Ok(Search::Exceeded { below, above, .. }) => (Status::Exceeded, Some(above), Some(below)),
            Ok(Search::Stood { at, .. }) => (Status::Stood, None, Some(at)),
            Ok(Search::Always { .. }) => (Status::Always, None, None),
            Err(Unfinished) => (Status::Failed, None, None),
        };
        let intensity = scale.or(stood_scale).map(|factor| record.intensity.scaled(factor));
        let (exceeding_share, beyond_model) =
            scale.map_or((None, Vec::new()), |scale| self.certainty(record, scale));
        Capacity {
            record: record.name.clone(),
            status,
            scale,
            stood_scale,
            pga_g: intensity.map(|measures| measures.pga_g),
            pgv_m_s: intensity.map(|measures| measures.pgv_m_s),
            exceeding_share,
            beyond_model,
            runs,
        }
    }

    /// The share of an ensemble that exceeds the limit at a factor, and why the model does not apply to the run there.
    fn certainty(&self, record: &SuiteRecord, scale: f64) -> (Option<f64>, Vec<String>) {
        let shaking = self.shaking(record, scale);
        let ensemble = simulate_ensemble(&self.wall, &shaking, self.accuracy, MEMBERS);
        let reasons = beyond_model(&self.wall, Some(record.horizontal.step_s()), &ensemble.run);
        let reasons = reasons.iter().map(BeyondModel::to_string).collect();
        (share_exceeding(&ensemble, self.limit), reasons)
    }
}

fn share_exceeding(ensemble: &Ensemble, limit: Limit) -> Option<f64> {
    let ended: Vec<&Response> =
        ensemble.members().filter(|member| !matches!(member.outcome, Outcome::Failed { .. })).collect();
    let exceeding = ended.iter().filter(|member| limit.exceeded_by(member)).count();
    (!ended.is_empty()).then(|| exceeding as f64 / ended.len() as f64)
}

/// The columns of `margin.parquet` and of the table on stdout.
pub static COLUMNS: [Column<Capacity>; 9] = [
    Column::input("record", "", "name of the record", Read::Text(|c| Some(Cow::Borrowed(c.record.as_str())))),
    Column::result(
        "status",
        "",
        "how the search ended",
        Read::Text(|c| Some(Cow::Borrowed(c.status.name()))),
    ),
    Column::result("scale", "", "lowest factor found to exceed the limit", Read::Number(|c| c.scale)),
    Column::result(
        "stood_scale",
        "",
        "highest factor below it that did not; where none did, the last one",
        Read::Number(|c| c.stood_scale),
    ),
    Column::result("pga_g", "g", "PGA at scale, or else at stood_scale", Read::Number(|c| c.pga_g)),
    Column::result("pgv_m_s", "m/s", "PGV at scale, or else at stood_scale", Read::Number(|c| c.pgv_m_s)),
    Column::result(
        "exceeding_share",
        "",
        "share of the members of the ensemble at scale that exceed the limit",
        Read::Number(|c| c.exceeding_share),
    ),
    Column::result(
        "beyond_model",
        "",
        "why the model does not apply to the run at scale",
        Read::Text(|c| (!c.beyond_model.is_empty()).then(|| Cow::Owned(c.beyond_model.join("; ")))),
    ),
    Column::result("runs", "", "runs of the search, the ensemble left out", Read::Count(|c| Some(c.runs))),
];

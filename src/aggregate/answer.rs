//! What came of a run, as far as one compares it with the same run under other circumstances.

use crate::store::Read;
use crate::study::batch::Finished;
use crate::study::pipeline::Kind;
use crate::study::runs::COLUMNS;

/// What of a run is compared: numbers, and the column that says whether they exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// How the run ended.
    pub outcome: &'static str,
    /// Its value where the numbers exist.
    pub usable: &'static str,
    /// Its value where they lie above all numbers.
    pub beyond: &'static str,
    /// The numbers.
    pub numbers: &'static [&'static str],
}

impl Compared {
    /// What is compared in a study of this kind.
    pub fn of(kind: Kind) -> Self {
        match kind {
            Kind::Incremental => {
                Self { outcome: "limit_exceeded", usable: "true", beyond: "false", numbers: &["intensity"] }
            }
            _ => Self {
                outcome: "outcome",
                usable: "stood",
                beyond: "collapsed",
                numbers: &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
            },
        }
    }

    /// The same of a run that was done again.
    pub fn answer(&self, finished: &Finished) -> Answer {
        let column = |name: &str| COLUMNS.iter().find(|column| column.name == name);
        let number = |name: &&'static str| match column(name).map(|column| &column.read) {
            Some(Read::Number(read)) => read(finished),
            _ => None,
        };
        Answer {
            outcome: column(self.outcome).map(|column| column.text(finished)).unwrap_or_default(),
            numbers: self.numbers.iter().map(number).collect(),
        }
    }
}

/// What came of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// How it ended; empty where it has none.
    pub outcome: String,
    /// The numbers; none where they do not exist.
    pub numbers: Vec<Option<f64>>,
}

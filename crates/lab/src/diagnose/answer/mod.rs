//! What a diagnosis returns: everything, worked out; nothing is computed while it is written or drawn.
//!
//! | module | idea |
//! | --- | --- |
//! | [`summary`] | the types of `diagnosis.json`, written, read and scored as one struct |
//! | [`rows`] | the rows of the tables beside it |
//! | `findings` | fitted hypotheses and the windows they were fitted to, before anything is told of them |
//! | `conclusion`, `whole_runs`, `missing_force`, `replays`, `updated_wall` | how the former follow from the latter |

mod conclusion;
mod findings;
mod missing_force;
mod replays;
pub mod rows;
pub mod summary;
mod updated_wall;
mod whole_runs;

pub use findings::Findings;
pub use rows::Tables;
pub use summary::{
    Against, BeforeAfter, CouldHide, ExplainedBy, FitHeldOut, FittedNumber, ForceSize, FoundEffect, KIND,
    MissingForce, Rival, Stages, Summary, TestErrors, WallFit, WindowCounts,
};

use crate::diagnose::trials::Tried;
use missing_force::ForceBeforeAfter;
use mrbd_files::error::{InputError, Result};

/// A diagnosis: the verdict with everything it rests on.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// What `diagnosis.json` holds.
    pub summary: Summary,
    /// What the tables hold.
    pub tables: Tables,
    /// The wall file with what was found (TOML); with the wall as given where nothing was.
    pub updated_wall_toml: String,
}

impl Diagnosis {
    /// Works out everything that is told of findings.
    ///
    /// # Errors
    /// An input error of the wall file if its fitted numbers make no wall, or cannot be written.
    pub fn new(findings: &Findings) -> Result<Self> {
        let physics = |tried: &Tried| tried.hypothesis.physics(&tried.fit.values);
        let [before, after] = findings.before_and_kept().map(physics);
        let no_wall = || {
            let path = &findings.experiment.wall_path;
            InputError::file(path, "fitted numbers that make no wall", "numbers within their bounds")
        };
        let physics = [before.ok_or_else(no_wall)?, after.ok_or_else(no_wall)?];
        let force = ForceBeforeAfter::new(&findings.tests, &physics);
        Ok(Self {
            summary: findings.summary(&physics, &force),
            tables: Tables {
                samples: findings.samples(&physics),
                windows: findings.window_rows(&physics),
                force: force.rows(&findings.tests),
                jumps: findings.jump_rows(&physics),
                laws: findings.law_points(&force),
                rivals: findings.rival_rows(),
            },
            updated_wall_toml: findings.updated_wall_toml()?,
        })
    }
}

//! What a diagnosis returns: everything, worked out; nothing is computed while it is written or drawn.
//!
//! | module | idea |
//! | --- | --- |
//! | [`Findings`] | fitted hypotheses and the windows they were fitted to, before anything is said of them |
//! | [`summary`] | the types of `diagnosis.json`, written, read and scored as one struct |
//! | [`rows`] | the rows of the tables beside it, and how they follow from the findings |
//! | `conclusion`, `named`, `own`, `formulas`, `round`, `refused`, `updated_wall` | how the summary and the updated wall file follow from the findings |

mod conclusion;
mod formulas;
mod named;
mod own;
mod refused;
mod round;
pub mod rows;
pub mod summary;
mod updated_wall;

use std::collections::BTreeMap;

use super::experiment::Experiment;
use super::trials::{Data, FittedHypothesis};
use super::verdict::Found;
use crate::experiment::{TestData, Window};
use mrbd_files::error::{InputError, Result};
use rows::ForceBeforeAfter;
pub use rows::Tables;
pub use summary::{
    Against, BeforeAfter, CouldHide, ExplainedBy, FitHeldOut, FittedNumber, FittedToAll, ForceCurve,
    ForceSize, FoundEffect, FoundState, KIND, MissingForce, OwnHypothesis, RefusedLaw, Rival, RoundExponents,
    SharedHeldOut, Stages, Summary, TestErrors, WallFit, WindowCounts,
};

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
        let physics = |tried: &FittedHypothesis| tried.hypothesis.physics(&tried.fit.values);
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

/// What the search of a diagnosis leaves.
#[derive(Debug)]
pub struct Findings<'e> {
    /// The experiment, as it was given.
    pub experiment: &'e Experiment,
    /// Its tests, read without the gains that were found.
    pub tests: Vec<TestData>,
    /// Windows to fit and held out; some of tests held out may be among the former.
    pub windows: [Vec<Window>; 2],
    /// The answer, and every hypothesis that was fitted.
    pub found: Found,
    /// Laws that are told, or effects that are named, each with its round exponents free where it has such.
    pub freed: Vec<Option<FittedHypothesis>>,
    /// Laws of the user's own, in the order of the experiment.
    pub own: Vec<Option<FittedHypothesis>>,
    /// Of which hypotheses how many fits ended because they had worked as much as they may.
    pub unfinished: BTreeMap<String, usize>,
}

impl Findings<'_> {
    /// The windows as data of fits.
    pub fn data(&self) -> Data<'_> {
        Data::new(&self.tests, &self.windows)
    }

    /// The wall as given, and the wall of the answer: as given where there is none.
    pub fn before_and_kept(&self) -> [&FittedHypothesis; 2] {
        [&self.found.before, self.found.kept()]
    }

    /// Windows to fit and held out, each with its fitted state under a hypothesis.
    pub fn windows_of<'t>(
        &'t self,
        tried: &'t FittedHypothesis,
    ) -> impl Iterator<Item = (&'t Window, &'t [f64])> {
        let sides = self.windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
        sides.flat_map(|(windows, fits)| windows.iter().zip(fits.iter().map(|fit| &fit.x[..])))
    }
}

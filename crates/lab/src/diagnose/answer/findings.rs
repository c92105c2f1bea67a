//! Fitted hypotheses, and the tests and windows that they were fitted to.

use crate::diagnose::experiment::Experiment;
use crate::diagnose::measured::{TestData, Window};
use crate::diagnose::trials::{Data, Tried};
use crate::diagnose::verdict::Found;

/// What the search of a diagnosis leaves.
#[derive(Debug)]
pub struct Findings<'e> {
    /// The experiment, as it was given.
    pub experiment: &'e Experiment,
    /// Its tests, read without the gains that were found.
    pub tests: Vec<TestData>,
    /// Windows to fit and held out.
    pub windows: [Vec<Window>; 2],
    /// The answer, and every hypothesis that was fitted.
    pub found: Found,
}

impl Findings<'_> {
    /// The windows as data of fits.
    pub fn data(&self) -> Data<'_> {
        Data::new(&self.tests, &self.windows)
    }

    /// The wall as given, and the wall of the answer: as given where there is none.
    pub fn before_and_kept(&self) -> [&Tried; 2] {
        [&self.found.before, self.found.kept()]
    }

    /// Windows to fit and held out, each with its fitted state under a hypothesis.
    pub fn windows_of<'t>(&'t self, tried: &'t Tried) -> impl Iterator<Item = (&'t Window, &'t [f64])> {
        let sides = self.windows.iter().zip([&tried.fit.windows, &tried.held_out.windows]);
        sides.flat_map(|(windows, fits)| windows.iter().zip(fits.iter().map(|fit| &fit.x[..])))
    }
}

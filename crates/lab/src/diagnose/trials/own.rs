//! Laws of the user's own: fitted as those of the catalogue are, and judged by the same figures.
//!
//! They never are the verdict. What the catalogue says stays as it is without them.

use rayon::prelude::*;

use super::search::try_hypothesis;
use super::{FittedHypothesis, Trials};
use crate::Progress;
use crate::diagnose::hypothesis::Hypothesis;
use crate::experiment::file::HypothesisTable;
use crate::limits::LEAST_MOVING;

impl<P: Progress> Trials<'_, P> {
    /// Every law of the user's own, in their order; `None` where no fit makes a wall, or too little moves.
    pub fn own_hypotheses(&self, before: &FittedHypothesis) -> Vec<Option<FittedHypothesis>> {
        let own = &self.experiment.hypotheses;
        if own.is_empty() {
            return Vec::new();
        }
        self.progress.begin("hypotheses of your own", own.len());
        let wall = self.experiment.wall.parameters();
        let fitted = |own: &HypothesisTable| {
            let (scales, nuisances) = (&self.experiment.scales, &self.experiment.nuisances);
            let hypothesis = Hypothesis::of_formula(wall, scales, nuisances, &own.formula);
            let moves = self.data.fit.windows.len() >= LEAST_MOVING;
            let fitted = moves.then(|| try_hypothesis(&self.data, hypothesis, before)).flatten();
            self.progress.advance(1);
            fitted
        };
        own.par_iter().map(fitted).collect()
    }
}

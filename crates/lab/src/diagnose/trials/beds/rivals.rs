//! Single effects on sharp edges, as rivals of joints that give.
//!
//! They lie far above what joints that give leave: few windows tell which come nearest, and a coarse fit to all how near.

use crate::Progress;
use crate::diagnose::hypothesis::{Addition, Hypothesis, candidates};
use crate::diagnose::trials::search::{judged, promise, states_of, try_coarsely};
use crate::diagnose::trials::{Data, Few, FittedHypothesis, Trials};
use crate::limits::{BED_RIVALS, BED_RIVALS_IN_FEW, BEDS_WINDOWS};
use rayon::prelude::*;

impl<P: Progress> Trials<'_, P> {
    /// The single effects that follow few windows best, fitted coarsely to all, best first.
    pub fn rivals_of_beds(&self, from: &FittedHypothesis) -> Vec<FittedHypothesis> {
        self.rivals_in_all_windows(from, &self.rivals_in_few_windows(from))
    }

    /// The first of such effects fitted coarsely to all windows, best first.
    pub fn rivals_in_all_windows(
        &self,
        from: &FittedHypothesis,
        in_few: &[FittedHypothesis],
    ) -> Vec<FittedHypothesis> {
        let first = in_few.par_iter().take(BED_RIVALS);
        self.ordered(first.filter_map(|tried| self.in_all_windows(tried, from)).collect())
    }

    /// Single effects fitted coarsely to few windows, what follows them best first.
    pub fn rivals_in_few_windows(&self, from: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let few = Few::new(self.data.fit, BEDS_WINDOWS, 1.0);
        let data = few.data();
        let start = few.of(from);
        let promising = self.promising_in(&data, &start);
        self.progress.begin("single effects on sharp edges", promising.len());
        let one = |h: Hypothesis| {
            let tried = try_coarsely(&data, h, &[&start]);
            self.progress.advance(1);
            tried
        };
        let mut tried = promising.into_par_iter().filter_map(one).collect::<Vec<_>>();
        tried.sort_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
        tried
    }

    /// Single effects that promise most at a glance, and those that only a fit can judge.
    fn promising_in(&self, data: &Data, start: &FittedHypothesis) -> Vec<Hypothesis> {
        let additions = candidates(self.experiment.wall.parameters());
        let look = |addition: &Addition| {
            let h = self.hypothesis(&self.experiment.nuisances, &[*addition]);
            (promise(data, &h, start).unwrap_or(f64::NEG_INFINITY), h)
        };
        let mut all = additions.par_iter().map(look).collect::<Vec<_>>();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.into_iter().take(BED_RIVALS_IN_FEW).map(|(_, h)| h).collect()
    }

    /// Fits coarsely to all windows what was fitted to few, from the states of another hypothesis.
    fn in_all_windows(&self, tried: &FittedHypothesis, from: &FittedHypothesis) -> Option<FittedHypothesis> {
        let h = &tried.hypothesis;
        let start = self.data.fit.states(h, &tried.fit.values, &states_of(&from.fit), 1, false)?;
        let fit = self.data.fit.fit_coarsely(h, start)?;
        judged(&self.data, h.clone(), fit, from, false)
    }
}

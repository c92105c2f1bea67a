//! The stronger search: windows, tracks that follow the measured motion, then CMA-ES about where they arrived.
//!
//! A free-running impact system forgets its coefficients behind chaos: over a long record the WME has many local
//! minima. So the search begins in windows, which begin anew from the measured motion before each impact
//! ([`crate::experiment::Test::in_windows`]). There every coefficient acts in every part of every test, and the
//! misfit is nearly smooth. Tracks ([`Track`]) begin where windows lead from several vectors on, and at vectors that
//! windows hardly tell from these. A track is led to follow the measured motion from rest ever farther, up to the
//! free-running tests, whose WME is Eq. 8. CMA-ES goes on about the best of them.

use super::archive::Archive;
use super::cma_es::CmaEs;
use super::continuation::{Followed, Track};
use super::flow::Experiment;
use super::gauss_newton::GaussNewton;
use super::objective::Objective;
use super::parameters::ParameterSpace;
use super::search::{Draws, Found};
use crate::experiment::Test;
use mrbd_files::error::Result;

/// The most of the budget that windows and tracks take, and what a track that is let go takes; CMA-ES has the rest.
const TRACKS_SHARE: f64 = 0.6;
const LET_GO_SHARE: f64 = 0.2;
/// The most of the budget that the windows take, and vectors: some ten iterations with eight variables.
const WINDOWS_SHARE: f64 = 0.25;
const WINDOWS_VECTORS: usize = 250;

/// Width of the cloud at which it has told what it can, as a share of the bounds: hundred times below the accuracy sought.
const LEAST_WIDTH: f64 = 1e-4;
/// Vectors of a generation per variable: thrice the least of the tutorial, because the valley is rough.
const VECTORS_PER_VARIABLE: usize = 3;
/// Least vectors of a generation: with few variables a small cloud shrinks before it has gone down a rough valley.
const LEAST_VECTORS: usize = 12;

/// A staged search in some tests of an experiment.
#[derive(Debug, Clone, Copy)]
pub struct StagedSearch<'a> {
    /// The experiment.
    pub experiment: &'a Experiment,
    /// What makes a wall of a vector; the experiment's own, or under another law.
    pub space: &'a ParameterSpace,
    /// Tests that count.
    pub chosen: &'a [usize],
    /// Where simulations are kept.
    pub archive: &'a Archive,
    /// Name of the search.
    pub method: &'a str,
    /// Vectors to evaluate in all.
    pub budget: usize,
}

impl StagedSearch<'_> {
    /// Searches from a vector on until the budget is spent or nothing is left to find. The result is the best over
    /// free-running tests, with all evaluations counted.
    ///
    /// # Errors
    /// [`mrbd_files::Error::Io`] if a simulation cannot be kept.
    pub fn minimise(&self, from: Vec<f64>, draws: &Draws) -> Result<Found> {
        let mut windows = GaussNewton::new(from);
        let (mut spent, mut best) = (0, None);
        for number in 0..MOST_TRACKS {
            let left = self.share(TRACKS_SHARE).saturating_sub(spent);
            let over = left < Track::least_vectors(self.space.parameters.len());
            if best.as_ref().is_some_and(|best: &Followed| over || best.is_perfect()) {
                break;
            }
            let anew = number.is_multiple_of(2) && left >= 2 * WINDOWS_VECTORS;
            if number > 0 && anew {
                windows = GaussNewton::new(self.drawn(number, draws));
            }
            let begins_there = number == 0 || anew;
            let in_windows = if begins_there { self.in_windows(number, &mut windows)? } else { 0 };
            let track = self.track(number, &windows, begins_there, draws);
            let followed = track.follow(number, self, left.saturating_sub(in_windows))?;
            spent += in_windows + followed.vectors;
            best = Some(followed.or(best));
        }
        let Some(mut best) = best else { unreachable!("there is a first track") };
        if !best.arrived {
            let track = Track { values: best.best.values.clone(), axes: best.axes.clone() };
            let let_go = track.let_go(MOST_TRACKS, self, self.share(LET_GO_SHARE))?;
            spent += let_go.vectors;
            best = let_go.or(Some(best));
        }
        let alone = || Found::start(vec![best.best.clone()]);
        let left = self.budget.saturating_sub(spent);
        let mut found = self.cloud(&best, left, draws)?.unwrap_or_else(alone);
        found.evaluations += spent;
        found.vectors.iter_mut().for_each(|vectors| *vectors += spent);
        Ok(found)
    }

    fn share(&self, share: f64) -> usize {
        (share * self.budget as f64) as usize
    }

    /// A vector anywhere between the bounds.
    fn drawn(&self, number: usize, draws: &Draws) -> Vec<f64> {
        let draws = draws.part("beginnings");
        let bounds = self.space.bounds();
        bounds.iter().enumerate().map(|(v, b)| b.at(draws.uniform(number as u32, 0, v as u32))).collect()
    }

    /// A track that begins where windows lead, or somewhere in the valley there.
    fn track(&self, number: usize, windows: &GaussNewton, there: bool, draws: &Draws) -> Track {
        let near_by = || windows.near_by(number as u32, &self.space.bounds(), &draws.part("tracks"));
        let elsewhere = || near_by().unwrap_or_else(|| self.drawn(number, draws));
        let values = if there { windows.values.clone() } else { elsewhere() };
        match &windows.cloud {
            Some(axes) => Track { values, axes: axes.clone() },
            None => Track::unknown(values),
        }
    }

    /// Gauss-Newton in windows that begin anew from the measured motion. Gives the vectors it took; none where
    /// windows would reach over the whole of every test.
    fn in_windows(&self, number: usize, at: &mut GaussNewton) -> Result<usize> {
        let Ok(wall) = self.space.wall(&at.values) else { return Ok(0) };
        let mut tests = self.experiment.tests.clone();
        for &k in self.chosen {
            // Between impacts the wall moves as the vector makes it, the best known.
            tests[k] = tests[k].in_windows(&wall, self.experiment.accuracy());
        }
        if self.chosen.iter().all(|&k| tests[k].segment_count() == 1) {
            return Ok(0);
        }
        let name = Stage::Windows(number).name(self.method);
        let mut objective = self.objective(&name, &tests);
        let budget = self.share(WINDOWS_SHARE).min(WINDOWS_VECTORS);
        Ok(at.minimise(&self.space.bounds(), budget, &mut objective)?.evaluations)
    }

    /// CMA-ES about the best; `None` where nothing is left to find, or to find it with.
    fn cloud(&self, about: &Followed, budget: usize, draws: &Draws) -> Result<Option<Found>> {
        let bounds = self.space.bounds();
        let lambda = (VECTORS_PER_VARIABLE * bounds.len()).max(LEAST_VECTORS);
        if about.is_perfect() || budget <= lambda {
            return Ok(None);
        }
        let mut objective = self.objective(self.method, &self.experiment.tests);
        let mut cloud = CmaEs::new(&about.best.values, &bounds, 1.0, lambda).shaped(&about.axes);
        cloud.minimise(&bounds, budget, LEAST_WIDTH, draws, &mut objective).map(Some)
    }

    pub(super) fn objective<'o>(&'o self, method: &'o str, tests: &'o [Test]) -> Objective<'o> {
        Objective {
            space: self.space,
            tests,
            chosen: self.chosen,
            accuracy: self.experiment.accuracy(),
            archive: self.archive,
            method,
        }
    }
}

/// Tracks at most.
pub(super) const MOST_TRACKS: usize = 12;

/// Where a stage's vectors are simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// In windows from each stretch without impacts, before the `number`-th track.
    Windows(usize),
    /// From rest up to where the `number`-th track leaves the measurement.
    Parts(usize),
    /// In the free-running tests, by the `number`-th track.
    Whole(usize),
}

impl Stage {
    /// The name under which its simulations are kept.
    pub fn name(self, method: &str) -> String {
        match self {
            Stage::Windows(number) => format!("{method} {} windows", number + 1),
            Stage::Parts(number) => format!("{method} {} parts", number + 1),
            Stage::Whole(number) => format!("{method} {} whole", number + 1),
        }
    }
}

/// The stages of a search, in their order; the last, CMA-ES over the free-running tests, has the search's own name.
pub(super) fn stage_names(method: &str) -> Vec<String> {
    // The last track is the one that is let go.
    let of_track = |number: usize| [Stage::Windows(number), Stage::Parts(number), Stage::Whole(number)];
    let stages = (0..=MOST_TRACKS).flat_map(of_track);
    stages.map(|stage| stage.name(method)).chain([method.to_owned()]).collect()
}

/// The names of those whose simulations are of the whole tests.
pub(super) fn whole_names(method: &str) -> Vec<String> {
    let tracks = (0..=MOST_TRACKS).map(|number| Stage::Whole(number).name(method));
    tracks.chain([method.to_owned()]).collect()
}

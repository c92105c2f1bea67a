//! Joints that give, looked for where windows ask for them.
//!
//! A wall on beds takes long to simulate, so it is tried in steps, each of which may be the last. Windows are short, and
//! begin from measured states: there is no chaos in them, and few of them tell the stiffness by decades.
//!
//! | step | windows | what moves |
//! | --- | --- | --- |
//! | probe | few | stiffness by decades, at the ground, at the crack and at both |
//! | begin | few | stiffness and damping |
//! | fit | all | these and the wall's own numbers |
//!
//! What no law follows to its noise is fitted under the widest loss: it feels every window in the measure of what the
//! model leaves, as if that were the noise.

use rayon::prelude::*;

use super::search::{judged_from_measured, states_of};
use super::{FittedHypothesis, Trials, joint_error};
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem, WindowFit, windowed_error};
use crate::diagnose::hypothesis::{Addition, Hypothesis, Measure, beds};
use crate::experiment::{TestData, Window};
use crate::limits::{
    BED_DAMPING, BED_DECADES, BED_HALF_DECADES, BEDS_ASKED_FOR, BEDS_GAP, BEDS_NEAR_BEST, BEDS_WINDOWS,
    HELD_DAMPING,
};

/// Squared error of windows above that of noise.
pub fn excess(windows: &[WindowFit]) -> f64 {
    windowed_error(windows).map_or(f64::INFINITY, |error| error * error - 1.0)
}

/// Error that a hypothesis leaves in all windows, in standard deviations of the noise; at least the noise itself.
pub fn own_error(tried: &FittedHypothesis) -> f64 {
    joint_error(tried).unwrap_or(1.0).max(1.0)
}

/// Tests whose noise is so many times as large: with a model's own error in its place.
pub fn widened(tests: &[TestData], factor: f64) -> Vec<TestData> {
    let wider = |test: &TestData| TestData { noise_rad: test.noise_rad.map(|n| factor * n), ..test.clone() };
    tests.iter().map(wider).collect()
}

/// Times that a fit of beds is begun again under the loss that it has come to.
const ROUNDS: usize = 3;
/// Share of the error that is worth another.
const WORTH_A_ROUND: f64 = 0.02;

/// A bed looked at in few windows.
struct Probed {
    bed: Addition,
    stiffness_pa_per_m: f64,
    damping_s: f64,
    /// Squared error above noise.
    excess: f64,
}

/// Few of the windows to fit, spread over all of them.
struct Probe<'t, P> {
    trials: &'t Trials<'t, P>,
    windows: Vec<Window>,
}

impl<P: Progress> Trials<'_, P> {
    /// Joints that give, the best first; none where the windows do not ask for them, or the wall has beds of its own.
    pub fn beds(&self, recalibrated: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let far = joint_error(recalibrated).is_some_and(|error| error > BEDS_GAP);
        if !far || self.experiment.wall.gives() {
            return Vec::new();
        }
        let asked = spread_over(self.data.fit.windows.len(), BEDS_WINDOWS);
        let without = asked.iter().map(|k| recalibrated.fit.windows[*k].clone()).collect::<Vec<_>>();
        let windows = asked.iter().map(|k| self.data.fit.windows[*k].clone()).collect();
        let probe = Probe { trials: self, windows };
        let Some(probed) = probe.asks(excess(&without)) else { return Vec::new() };
        let mut begun = probe.begun(probed);
        begun.sort_by(|a, b| excess(&a.1.windows).total_cmp(&excess(&b.1.windows)));
        let Some(best) = begun.first().map(|(_, fit)| excess(&fit.windows)) else { return Vec::new() };
        // A bed may follow within the noise: then another must come near that.
        begun.retain(|(_, fit)| excess(&fit.windows) < BEDS_NEAR_BEST * best.max(1.0));
        self.progress.begin("joints that give", begun.len());
        let fit = |(bed, begun): &(Addition, Fit)| {
            let fitted = self.bed(*bed, begun);
            self.progress.advance(1);
            fitted
        };
        let mut fitted = begun.par_iter().filter_map(fit).collect::<Vec<_>>();
        fitted.sort_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
        if let Some(best) = fitted.first_mut()
            && let Some(finished) = self.finished_beside_own_error(best)
        {
            *best = finished;
        }
        fitted
    }

    /// A hypothesis fitted to the end with the model's own error, what it leaves in all windows, in the place of noise.
    ///
    /// So what was known of the wall counts as much as it should, and a deviation is that of a model with such errors.
    fn finished_beside_own_error(&self, coarse: &FittedHypothesis) -> Option<FittedHypothesis> {
        let h = &coarse.hypothesis;
        let tests = widened(self.data.fit.tests, own_error(coarse));
        let wide = Problem { tests: &tests, ..self.data.fit };
        let start = wide.states(h, &coarse.fit.values, &states_of(&coarse.fit), 1, false)?;
        let found = wide.fit_finely(h, start)?;
        let fit = self.data.fit.states(h, &found.values, &states_of(&found), 1, false)?;
        let fit = Fit { covariance: found.covariance, ..fit };
        judged_from_measured(&self.data, h.clone(), fit)
    }

    /// A bed fitted to all windows with the wall's own numbers, from where it was begun.
    fn bed(&self, bed: Addition, begun: &Fit) -> Option<FittedHypothesis> {
        let h = self.hypothesis(&self.experiment.nuisances, &[bed]);
        let mut values = h.start();
        values.splice(h.nuisances.., begun.values.iter().copied());
        let start = self.data.fit.states(&h, &values, &self.data.fit.measured_states(), 2, false)?;
        let fit = in_rounds(&self.data.fit, &h, start)?;
        judged_from_measured(&self.data, h, fit)
    }
}

impl<P: Progress> Probe<'_, P> {
    /// Damping times with which beds are looked at.
    fn dampings(&self) -> &'static [f64] {
        if self.trials.is_held() { &[BED_DAMPING, HELD_DAMPING] } else { &[BED_DAMPING] }
    }

    fn problem(&self) -> Problem<'_> {
        Problem { tests: self.trials.data.fit.tests, windows: &self.windows }
    }

    /// Beds by decades, where the best of them takes away a share of what is left without.
    fn asks(&self, without: f64) -> Option<Vec<Probed>> {
        let beds = beds();
        let asked = beds
            .iter()
            .flat_map(|bed| self.dampings().iter().flat_map(move |z| BED_DECADES.map(|k| (*bed, k, *z))));
        let probed = self.probed(asked.collect());
        let least = probed.iter().map(|p| p.excess).fold(f64::INFINITY, f64::min);
        (least < (1.0 - BEDS_ASKED_FOR) * without).then_some(probed)
    }

    /// Of each bed the best stiffness, fitted to the few windows with its damping.
    fn begun(&self, mut probed: Vec<Probed>) -> Vec<(Addition, Fit)> {
        let beds = beds();
        let asked = beds.iter().flat_map(|bed| {
            self.dampings().iter().flat_map(move |z| BED_HALF_DECADES.map(|k| (*bed, k, *z)))
        });
        probed.extend(self.probed(asked.collect()));
        let best = |bed: &Addition| {
            probed.iter().filter(|p| p.bed == *bed).min_by(|a, b| a.excess.total_cmp(&b.excess))
        };
        let chosen = beds.iter().filter_map(best).collect::<Vec<_>>();
        let fit = |p: &&Probed| {
            let (h, start) = self.states(p.bed, p.stiffness_pa_per_m, p.damping_s)?;
            Some((p.bed, in_rounds(&self.problem(), &h, start)?))
        };
        chosen.par_iter().filter_map(fit).collect()
    }

    fn probed(&self, asked: Vec<(Addition, f64, f64)>) -> Vec<Probed> {
        let one = |(bed, stiffness_pa_per_m, damping_s): (Addition, f64, f64)| {
            let (_, fit) = self.states(bed, stiffness_pa_per_m, damping_s)?;
            Some(Probed { bed, stiffness_pa_per_m, damping_s, excess: excess(&fit.windows) })
        };
        asked.into_par_iter().filter_map(one).collect()
    }

    /// The wall as given on a bed, from states near the measured ones; `None` if it would fall off.
    fn states(&self, bed: Addition, stiffness_pa_per_m: f64, damping_s: f64) -> Option<(Hypothesis, Fit)> {
        let h = self.trials.hypothesis(&[], &[bed]);
        let of = |measure| if measure == Measure::Softness { stiffness_pa_per_m } else { damping_s };
        let values =
            h.unknowns.iter().map(|u| u.within(u.measure.value_of(of(u.measure)))).collect::<Vec<_>>();
        let problem = self.problem();
        let fit = problem.states(&h, &values, &problem.measured_states(), 1, false)?;
        Some((h, fit))
    }
}

/// Fits numbers and states under the widest loss, again while that follows the windows better.
pub(super) fn in_rounds(problem: &Problem, h: &Hypothesis, start: Fit) -> Option<Fit> {
    let mut best = start;
    for _ in 0..ROUNDS {
        let next = problem.fit_coarsely(h, best.clone())?;
        let [before, after] = [&best, &next].map(|fit| excess(&fit.windows));
        if after < before || best.covariance.is_none() {
            best = next;
        }
        if after > (1.0 - WORTH_A_ROUND) * before {
            break;
        }
    }
    Some(best)
}

/// At most `most` of `count` places, spread evenly.
fn spread_over(count: usize, most: usize) -> Vec<usize> {
    let chosen = count.min(most);
    (0..chosen).map(|i| i * count / chosen).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_few_windows_are_spread_over_all() {
        assert_eq!(spread_over(9, 3), [0, 3, 6]);
        assert_eq!(spread_over(2, 3), [0, 1]);
        assert!(spread_over(0, 3).is_empty());
    }
}

//! Beds looked at in few windows: whether these ask for one, and where its fit begins.

use super::{by_excess, excess, in_rounds};
use crate::Progress;
use crate::diagnose::fit::{Fit, WindowFit};
use crate::diagnose::hypothesis::{Addition, Hypothesis, Measure, beds};
use crate::diagnose::trials::{Few, FittedHypothesis, Trials};
use crate::limits::{
    BED_DAMPING, BED_HALF_DECADES, BED_OTHER_DAMPINGS, BEDS_ASKED_FOR, BEDS_WINDOWS, HELD_DAMPING,
};
use rayon::prelude::*;

/// A bed looked at in few windows.
#[derive(Clone, Copy)]
struct Probed {
    bed: Addition,
    stiffness_pa_per_m: f64,
    damping_s: f64,
    /// Squared error above noise.
    excess: f64,
}

/// Few of the windows to fit, spread over all of them, and the wall that may stand on a bed: as it was given, with its numbers
/// fitted, or with an effect.
pub struct Probe<'t, P> {
    trials: &'t Trials<'t, P>,
    few: Few,
    wall: &'t FittedHypothesis,
    beds: Vec<Probed>,
}

impl<'t, P: Progress> Probe<'t, P> {
    /// Beds by half decades under a wall, where the best of them takes away a share of what is left `without`; `None`: where they are
    /// fitted anyhow.
    pub fn new(
        trials: &'t Trials<'t, P>,
        wall: &'t FittedHypothesis,
        without: Option<&FittedHypothesis>,
    ) -> Option<Self> {
        let few = Few::new(trials.data.fit, BEDS_WINDOWS, 1.0);
        let left = without.map(|without| few.left(&without.fit));
        let probe = Self::of(trials, wall, few);
        let most = left.map_or(f64::INFINITY, |left| (1.0 - BEDS_ASKED_FOR) * excess(&left));
        (probe.least() < most).then_some(probe)
    }

    /// Beds by half decades beside an effect, in windows half of which are those that another follows worst.
    pub fn beside(
        trials: &'t Trials<'t, P>,
        effect: &'t FittedHypothesis,
        worst_by: &FittedHypothesis,
    ) -> Self {
        Self::of(trials, effect, Few::followed_worst(trials.data.fit, BEDS_WINDOWS, &worst_by.fit))
    }

    fn of(trials: &'t Trials<'t, P>, wall: &'t FittedHypothesis, few: Few) -> Self {
        let mut probe = Self { trials, few, wall, beds: Vec::new() };
        probe.beds = probe.probed(&BED_HALF_DECADES);
        probe
    }

    /// What the wall leaves in the few windows without a bed.
    pub fn left_without(&self) -> Vec<WindowFit> {
        self.few.left(&self.wall.fit)
    }

    /// Least squared error above noise that a bed leaves.
    pub fn least(&self) -> f64 {
        self.beds.iter().map(|p| p.excess).fold(f64::INFINITY, f64::min)
    }

    /// Of each bed the best stiffness, fitted to the few windows with its damping and with what is uncertain of the wall.
    pub fn begun(self) -> Vec<(Hypothesis, Fit)> {
        let chosen = self.looked_at_by_damping();
        let fit = |p: &Probed| {
            let (h, start) = self.states(p.bed, p.stiffness_pa_per_m, p.damping_s)?;
            let fit = in_rounds(&self.few.problem(), &h, start)?;
            Some((h, fit))
        };
        let mut begun = chosen.par_iter().filter_map(fit).collect::<Vec<_>>();
        by_excess(&mut begun);
        begun
    }

    /// Of each bed what follows best, once its best stiffness and those beside it were looked at with other dampings.
    ///
    /// What a window leaves may jump with the damping, at which a bounce more or less passes through contact: a fit that begins on
    /// the wrong side of it ends there.
    fn looked_at_by_damping(&self) -> Vec<Probed> {
        let best = |of: &[Probed], bed: Addition| {
            let own = of.iter().filter(|p| p.bed == bed);
            own.min_by(|a, b| a.excess.total_cmp(&b.excess)).copied()
        };
        let first = beds().into_iter().filter_map(|bed| best(&self.beds, bed)).collect::<Vec<_>>();
        let asked = first.iter().flat_map(|p| stiffness_near(p.stiffness_pa_per_m).map(|k| (p.bed, k)));
        let asked = asked.flat_map(|(bed, k)| BED_OTHER_DAMPINGS.map(|zeta| (bed, (k, zeta)))).collect();
        let all = [first, self.look_at(asked)].concat();
        beds().into_iter().filter_map(|bed| best(&all, bed)).collect()
    }

    /// Damping times with which beds are looked at.
    fn dampings(&self) -> &'static [f64] {
        if self.trials.is_held() { &[BED_DAMPING, HELD_DAMPING] } else { &[BED_DAMPING] }
    }

    fn probed(&self, stiffness_pa_per_m: &[f64]) -> Vec<Probed> {
        let numbers = self.dampings().iter().flat_map(|zeta| stiffness_pa_per_m.iter().map(|k| (*k, *zeta)));
        let numbers = numbers.collect::<Vec<_>>();
        let asked = beds().into_iter().flat_map(|bed| numbers.iter().map(move |of| (bed, *of)));
        self.look_at(asked.collect())
    }

    /// Beds of a stiffness and a damping in the few windows.
    fn look_at(&self, asked: Vec<(Addition, (f64, f64))>) -> Vec<Probed> {
        let one = |(bed, (stiffness_pa_per_m, damping_s)): (Addition, (f64, f64))| {
            let (_, fit) = self.states(bed, stiffness_pa_per_m, damping_s)?;
            let excess = excess(&fit.windows);
            Some(Probed { bed, stiffness_pa_per_m, damping_s, excess })
        };
        asked.into_par_iter().filter_map(one).collect()
    }

    /// The wall on a bed, from states near the measured ones; `None` if it would fall off.
    fn states(&self, bed: Addition, stiffness_pa_per_m: f64, damping_s: f64) -> Option<(Hypothesis, Fit)> {
        let FittedHypothesis { hypothesis: wall, fit, .. } = self.wall;
        let nuisances = if wall.nuisances > 0 { &self.trials.experiment.nuisances[..] } else { &[] };
        let additions = std::iter::once(bed).chain(wall.additions.iter().copied()).collect::<Vec<_>>();
        let h = self.trials.hypothesis(nuisances, &additions);
        let mut values = h.values_from(wall, &fit.values);
        set_bed(&h, &mut values, stiffness_pa_per_m, damping_s);
        let problem = self.few.problem();
        let fit = problem.states(&h, &values, &problem.measured_states(), 1, false)?;
        Some((h, fit))
    }
}

/// Sets the numbers of the bed that a hypothesis adds first.
pub fn set_bed(h: &Hypothesis, values: &mut [f64], stiffness_pa_per_m: f64, damping_s: f64) {
    for (value, unknown) in values.iter_mut().zip(&h.unknowns).filter(|(_, u)| u.belongs_to(0)) {
        let number = if unknown.measure == Measure::Softness { stiffness_pa_per_m } else { damping_s };
        *value = unknown.within(unknown.measure.value_of(number));
    }
}

/// Of the stiffnesses that are looked at, this one and those half a decade beside it.
fn stiffness_near(stiffness_pa_per_m: f64) -> impl Iterator<Item = f64> {
    // Between one half decade and two.
    let is_near = move |k: &f64| (k / stiffness_pa_per_m).log10().abs() < 0.75;
    BED_HALF_DECADES.into_iter().filter(is_near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_stiffness_is_looked_at_half_a_decade_to_either_side() {
        assert!(stiffness_near(1e9).eq([3e8, 1e9, 3e9]));
        assert!(stiffness_near(3e7).eq([3e7, 1e8]));
        assert!(stiffness_near(3e10).eq([1e10, 3e10]));
    }
}

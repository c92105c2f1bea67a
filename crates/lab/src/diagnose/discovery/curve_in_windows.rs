//! A force without a formula, fitted to windows with their impacts: an answer where these say that it is one.

use super::asked::OpenGap;
use super::curve::curve_of;
use super::fitted::beside;
use super::search::Searched;
use crate::Progress;
use crate::diagnose::certainty::covariance;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::fit::{WindowFit, nats, windowed_error};
use crate::diagnose::formula::BOTH;
use crate::diagnose::hypothesis::Hypothesis;
use crate::diagnose::trials::{Data, FittedHypothesis, Trials, refit};
use crate::experiment::Window;
use crate::limits::{CURVE_SHRINKS, WORTH_A_NAME};
use mrbd_kernel::model::Wall;

impl<P: Progress> Trials<'_, P> {
    /// A force without a formula, with the numbers of the wall that points give it, where windows say that it is one: more
    /// than the nearest of the catalogue, and than the best law, though that was refused. A memory is no curve, but looks like
    /// one.
    pub(super) fn curve(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        law: Option<&FittedHypothesis>,
    ) -> Option<FittedHypothesis> {
        let (curve, steps) = curve_of(&searched.equations)?;
        self.progress.begin("a force without a formula", 1);
        let Experiment { wall, scales, nuisances, .. } = self.experiment;
        let hypothesis = Hypothesis::of_curve(wall.parameters(), scales, nuisances, curve);
        let forces = curve.knots().map(|(p, k)| curve.parts[p].force_n[k]);
        let values = beside(&hypothesis, &steps).chain(forces).collect::<Vec<_>>();
        let within = values.iter().zip(&hypothesis.unknowns).map(|(value, u)| u.within(*value));
        let values = within.collect::<Vec<_>>();
        let numbers = values.len();
        let fit = |data: &Data| refit(data, hypothesis, gap.nearest, &values);
        let found = self.within_budget("a force without a formula", numbers, fit);
        self.progress.advance(1);
        let found = found.filter(|found| {
            let against = |tried: &FittedHypothesis| against_inside(&self.data, wall, found, tried);
            let best = law.map_or(f64::INFINITY, against);
            let gain = against(gap.nearest).min(best) - against(found);
            gain >= WORTH_A_NAME && shrinks(&self.data, wall, gap.recalibrated, found)
        });
        found.and_then(|found| told(&self.data, found))
    }
}

/// A fitted curve with its forces and their standard deviations; `None` where one of these cannot be told: a force that may be anything
/// at a knot is no answer.
fn told(data: &Data, found: FittedHypothesis) -> Option<FittedHypothesis> {
    let h = &found.hypothesis;
    let covariance = covariance(data, &found)?;
    let sd_n = (h.nuisances..h.unknowns.len()).map(|i| covariance[(i, i)].sqrt()).collect::<Vec<_>>();
    if !sd_n.iter().all(|sd| sd.is_finite()) {
        return None;
    }
    let curve = h.curve.map(|curve| curve.with_forces(&found.fit.values[h.nuisances..], Some(&sd_n)));
    let mut told = found;
    told.hypothesis.curve = curve;
    Some(told)
}

/// Which windows held out stay where a curve is told: beyond its last knot nothing is known.
fn inside(data: &Data, wall: &Wall, curve: &FittedHypothesis) -> Vec<bool> {
    let p = wall.parameters();
    let crack_m = p.crack_height_m.unwrap_or(p.height_m);
    let reach = curve.hypothesis.curve.map_or(f64::INFINITY, |curve| curve.parts[0].at[BOTH - 1]);
    let stays = |window: &Window| {
        let theta = &data.held_out.tests[window.test].theta_rad[window.samples.clone()];
        theta.iter().all(|[one, two]| {
            let x = crack_m * one + (p.height_m - crack_m) * two;
            // What was not read goes nowhere.
            !x.is_finite() || x.abs() <= reach
        })
    };
    data.held_out.windows.iter().map(stays).collect()
}

/// The windows held out of a hypothesis that stay where a curve is told.
fn held_out_inside(
    data: &Data,
    wall: &Wall,
    curve: &FittedHypothesis,
    of: &FittedHypothesis,
) -> Vec<WindowFit> {
    let both = of.held_out.windows.iter().zip(inside(data, wall, curve));
    both.filter(|(_, inside)| *inside).map(|(window, _)| window.clone()).collect()
}

/// What speaks against a hypothesis in the windows fitted and in those held out in which a curve is told.
fn against_inside(data: &Data, wall: &Wall, curve: &FittedHypothesis, of: &FittedHypothesis) -> f64 {
    of.against(data)[0] + nats(&held_out_inside(data, wall, curve, of))
}

/// Whether a curve takes away most of the squared error above noise that the wall leaves, in the tests fitted and, where it is
/// told, in those held out.
fn shrinks(data: &Data, given: &Wall, wall: &FittedHypothesis, found: &FittedHypothesis) -> bool {
    let excess = |error: f64| (error * error - 1.0).max(0.0);
    let errors = |of: &FittedHypothesis| {
        [windowed_error(&of.fit.windows), windowed_error(&held_out_inside(data, given, found, of))]
    };
    errors(wall).into_iter().zip(errors(found)).all(|errors| match errors {
        (Some(before), Some(after)) => excess(after) <= (1.0 - CURVE_SHRINKS) * excess(before),
        (before, _) => before.is_none(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::asked::Scope;
    use super::super::points::Points;
    use super::super::search::search;
    use super::super::twin::{Twin, open_gap, wall_with};
    use super::*;
    use crate::diagnose::trials::joint_error;

    #[test]
    fn analytic_a_wave_of_displacement_is_told_by_windows_as_a_curve() {
        // A wave of straight lines: up to d, through nothing at 2 d.
        let wave = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\n\
                    force_n = \"-f*(max(min(x/d,1),-1) - max(x/d-1,0) - min(x/d+1,0))\"\n\
                    [effects.parameters]\nf = { value = 500.0, unit = \"N\" }\nd = { value = 0.02, unit = \"m\" }\n";
        let twin = Twin::new(&wall_with(wave), 3e-5);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows");
        let before = joint_error(&wall.before).expect("windows");
        let gap = open_gap(&wall, Scope::Curves);
        let h = trials.hypothesis(&trials.experiment.nuisances, &[]);
        let points = Points::new(trials.data.fit.tests, &h).expect("points");
        let found = trials.curve(&gap, &search(&points).expect("laws"), None).expect("a curve");
        let curve = found.hypothesis.curve.expect("a curve");
        let at = |x: f64| curve.parts[0].force_n(x)[0];
        let [at_d, at_2d] = [0.02, 0.04].map(at);
        // Straight pieces cut a kink by up to a half of it.
        assert!(at_d < -250.0 && at_2d > -150.0, "{at_d} N and {at_2d} N");
        assert!(!curve.parts[1].acts(), "{curve:?}");
        // Most of the gap is gone; pieces of a line leave more than noise at the kinks.
        let after = joint_error(&found).expect("windows");
        assert!(after < 0.3 * before, "{before} to {after}");
        // Without windows nothing tells how far a force may be off.
        let nothing = [Vec::new(), Vec::new()];
        let without = Data::new(&trials.experiment.tests, &nothing);
        let variances = covariance(&without, &found).expect("a covariance").diagonal();
        assert!(variances.iter().any(|variance| variance.is_infinite()), "{variances}");
        assert!(told(&without, found).is_none());
    }
}

//! Laws found over points, fitted to windows with their impacts: these alone judge.

use super::curve::curve_of;
use super::equals::{law_of, simplest_of_equals};
use super::guards::{holds_in_each_test, lies_inside};
use super::points::Points;
use super::search::{Candidate, Searched, search};
use super::stability::Stability;
use crate::Progress;
use crate::diagnose::certainty::covariance;
use crate::diagnose::experiment::Experiment;
use crate::diagnose::fit::{WindowFit, nats, windowed_error};
use crate::diagnose::formula::{BOTH, Law, Site, nearest_exact};
use crate::diagnose::hypothesis::{Addition, Hypothesis};
use crate::diagnose::trials::{
    Data, FittedHypothesis, Trials, against, closes, does_something, refit, shared_states,
};
use crate::experiment::Window;
use crate::limits::{
    CURVE_SHRINKS, LAWS_FITTED, LAWS_IN_WINDOWS, LAWS_TOLD, NEAR_BEST, WORTH_A_NAME, WORTH_WINDOWS,
};
use mrbd_kernel::model::Wall;
use nalgebra::DVector;
use rayon::prelude::*;

/// Laws outside the catalogue that were tried, and those that hold.
#[derive(Debug, Clone)]
pub struct Discovered {
    /// Laws that close the gap and that the tests cannot tell apart, the simplest first; none where no law holds.
    pub equals: Vec<FittedHypothesis>,
    /// The best laws that were fitted to windows, in order.
    pub tried: Vec<FittedHypothesis>,
    /// A force without a formula, where no law holds and it does.
    pub curve: Option<FittedHypothesis>,
    /// How sure the form of these is, over points.
    pub stability: Option<Stability>,
    /// By site: least and largest displacement and velocity that were excited.
    pub excited: [[[f64; 2]; 2]; 3],
}

impl Discovered {
    /// What was excited at a site: least and largest displacement and velocity.
    pub fn at(&self, site: Site) -> [[f64; 2]; 2] {
        self.excited[site as usize]
    }
}

/// A gap that the catalogue does not close.
#[derive(Debug, Clone, Copy)]
pub struct OpenGap<'t> {
    /// The wall with its uncertain numbers fitted.
    pub recalibrated: &'t FittedHypothesis,
    /// The hypothesis of the catalogue that follows best: the states of windows start from its own.
    pub nearest: &'t FittedHypothesis,
    /// Windowed error of the wall as given.
    pub error: f64,
    /// Whether laws of two atoms, and curves, are looked for too.
    pub in_full: bool,
    /// Laws that windows speak of already: they are tried whatever points say.
    pub kin: &'t [Law],
}

impl<P: Progress> Trials<'_, P> {
    /// Looks for a law outside the catalogue that closes a gap. `None` where points say nothing of one.
    ///
    /// A law of two atoms must be worth it beside the best of one: `worth_two` tells.
    pub fn discover(
        &self,
        gap: &OpenGap,
        worth_two: impl Fn(&FittedHypothesis, &FittedHypothesis) -> bool,
        holds: impl Fn(&FittedHypothesis) -> bool,
    ) -> Option<Discovered> {
        let wall = self.hypothesis(&self.experiment.nuisances, &[]);
        let points = Points::new(self.data.fit.tests, &wall)?;
        let searched = search(&points)?;
        let best = searched.singles.iter().chain(&searched.pairs).map(|c| c.evidence).fold(0.0, f64::max);
        if best < WORTH_WINDOWS && gap.kin.is_empty() {
            return None;
        }
        let mut tried = self.laws_in_windows(gap, &searched, gap.kin, &searched.singles, "laws of one atom");
        let may_be = |t: &&FittedHypothesis| self.may_be(gap, &searched, t);
        let one = tried.iter().filter(may_be).cloned().collect::<Vec<_>>();
        let mut closing = one;
        let single = searched.singles.first().map_or(0.0, |c| c.evidence);
        if gap.in_full
            && closing.is_empty()
            && searched.pairs.first().is_some_and(|pair| pair.evidence > single)
        {
            let simpler = tried.first().unwrap_or(gap.recalibrated).clone();
            let pairs = self.laws_in_windows(gap, &searched, &[], &searched.pairs, "laws of two atoms");
            closing = pairs.iter().filter(may_be).filter(|two| worth_two(&simpler, two)).cloned().collect();
            tried.extend(pairs);
        }
        let closing = closing.into_iter().filter(|t| holds(t)).collect();
        let equals = simplest_of_equals(&self.data, &points, self.ordered(closing));
        let mut tried = self.ordered(tried);
        let curve =
            if gap.in_full && equals.is_empty() { self.curve(gap, &searched, tried.first()) } else { None };
        tried.truncate(LAWS_TOLD);
        let laws = equals.iter().filter_map(law_of).collect::<Vec<_>>();
        let stability = Stability::of(&searched, &laws);
        Some(Discovered {
            equals,
            tried,
            curve,
            stability,
            excited: Site::ALL.map(|site| points.range(site)),
        })
    }

    /// A force without a formula, with the numbers of the wall that points give it, where windows say that it is one: more
    /// than the nearest of the catalogue, and than the best law, though that was refused. A memory is no curve, but looks like
    /// one.
    fn curve(
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
        let found = refit(&self.data, hypothesis, gap.nearest, &values);
        self.progress.advance(1);
        let found = found.filter(|found| {
            let against = |tried: &FittedHypothesis| against_inside(&self.data, wall, found, tried);
            let best = law.map_or(f64::INFINITY, against);
            let gain = against(gap.nearest).min(best) - against(found);
            gain >= WORTH_A_NAME && shrinks(&self.data, wall, gap.recalibrated, found)
        });
        found.map(|found| told(&self.data, found))
    }

    /// Whether a law that was fitted to windows closes the gap, with numbers that mean something.
    fn may_be(&self, gap: &OpenGap, searched: &Searched, tried: &FittedHypothesis) -> bool {
        let gain = against(&self.data, gap.recalibrated) - against(&self.data, tried);
        let laws = tried.hypothesis.laws(&tried.fit.values);
        let sound = |law: &Law| lies_inside(law) && holds_in_each_test(&searched.equations, law);
        closes(tried, gap.error) && does_something(tried) && gain >= WORTH_A_NAME && laws.iter().all(sound)
    }

    /// Laws that are known to be near and the best of those found over points, fitted to windows; the first of these with
    /// exact exponents too.
    fn laws_in_windows(
        &self,
        gap: &OpenGap,
        searched: &Searched,
        kin: &[Law],
        laws: &[Candidate],
        what: &str,
    ) -> Vec<FittedHypothesis> {
        let sound = |c: &&Candidate| {
            c.evidence > WORTH_WINDOWS
                && lies_inside(&c.law)
                && holds_in_each_test(&searched.equations, &c.law)
        };
        let found = laws.iter().filter(sound).take(LAWS_IN_WINDOWS).map(|c| c.law);
        let laws = kin.iter().copied().chain(found).collect::<Vec<_>>();
        self.progress.begin(&format!("{what}, a first look"), laws.len());
        let look = |law: &Law| {
            let start = self.start_in_windows(gap, searched, law);
            self.progress.advance(1);
            start
        };
        let mut starts = laws.par_iter().filter_map(look).collect::<Vec<_>>();
        starts.sort_by(|a, b| a.nats.total_cmp(&b.nats));
        starts.truncate(LAWS_FITTED);
        self.progress.begin(what, starts.len());
        let fit = |start: &Start| {
            let found = refit(&self.data, start.hypothesis.clone(), gap.nearest, &start.values);
            self.progress.advance(1);
            found
        };
        let free = self.ordered(starts.par_iter().filter_map(fit).collect());
        let exact = self.exactly(&free);
        self.ordered([free, exact].concat())
    }

    /// The best of fitted laws once more, with exact exponents where theirs are near.
    fn exactly(&self, free: &[FittedHypothesis]) -> Vec<FittedHypothesis> {
        let Some(best) = free.first().map(|best| against(&self.data, best)) else { return Vec::new() };
        let near = free.iter().filter(|t| against(&self.data, t) < best + NEAR_BEST);
        let exact = near.filter_map(|t| Some((t, exact_law(t)?))).collect::<Vec<_>>();
        self.progress.begin("laws with exact exponents", exact.len());
        let fit = |(from, law): &(&FittedHypothesis, Law)| {
            let h = self.hypothesis(&self.experiment.nuisances, &[Addition::Formula(*law)]);
            let own = from.fit.values.iter().take(h.nuisances).copied();
            let values = own.chain(law.values()).collect::<Vec<_>>();
            // Near impacts that the noise decides a fit may end in another valley than the one it set out from.
            let found = refit(&self.data, h, from, &values);
            let found = found.map(|found| shared_states(&self.data, &found, &[from]));
            self.progress.advance(1);
            found
        };
        exact.par_iter().filter_map(fit).collect()
    }

    /// A law with the numbers that points give it and the wall, and how well windows follow it so, their states fitted.
    fn start_in_windows(&self, gap: &OpenGap, searched: &Searched, law: &Law) -> Option<Start> {
        let hypothesis = self.hypothesis(&self.experiment.nuisances, &[Addition::Formula(*law)]);
        let steps = searched.equations.wall_steps(law)?;
        let values = beside(&hypothesis, &steps).chain(law.values()).zip(&hypothesis.unknowns);
        let values = values.map(|(value, unknown)| unknown.within(value)).collect::<Vec<_>>();
        let states = gap.nearest.fit.windows.iter().map(|w| w.x.clone()).collect::<Vec<_>>();
        let fit = self.data.fit.states(&hypothesis, &values, &states, LOOK_STEPS, false)?;
        Some(Start { nats: nats(&fit.windows), hypothesis, values })
    }
}

/// The wall's numbers after steps in standard deviations of what was known.
pub(super) fn beside<'h>(
    hypothesis: &'h Hypothesis,
    steps: &'h DVector<f64>,
) -> impl Iterator<Item = f64> + use<'h> {
    let own = hypothesis.unknowns.iter().take(hypothesis.nuisances).zip(steps.iter());
    own.map(|(unknown, step)| unknown.within(unknown.start + step * unknown.prior_sd.unwrap_or(0.0)))
}

/// A fitted curve with its forces and their standard deviations.
fn told(data: &Data, found: FittedHypothesis) -> FittedHypothesis {
    let h = &found.hypothesis;
    let covariance = covariance(data, &found);
    let sd = |i: usize| covariance.as_ref().map_or(f64::INFINITY, |c| c[(i, i)].sqrt());
    let sd_n = (h.nuisances..h.unknowns.len()).map(sd).collect::<Vec<_>>();
    let curve = h.curve.map(|curve| curve.with_forces(&found.fit.values[h.nuisances..], Some(&sd_n)));
    let mut told = found;
    told.hypothesis.curve = curve;
    told
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

/// Steps of the states of windows at a first look.
pub(super) const LOOK_STEPS: usize = 2;

/// A law at a first look.
pub(super) struct Start {
    /// The law beside the wall.
    pub hypothesis: Hypothesis,
    /// Its numbers.
    pub values: Vec<f64>,
    /// What windows say against it.
    pub nats: f64,
}

/// The law of a fitted hypothesis with exact exponents, where all of them are near such.
fn exact_law(tried: &FittedHypothesis) -> Option<Law> {
    let h = &tried.hypothesis;
    let sd = |i: usize| tried.fit.covariance.as_ref().map_or(0.0, |c| c[(i, i)].max(0.0).sqrt());
    let deviations = (h.nuisances..h.unknowns.len()).map(sd).collect::<Vec<_>>();
    nearest_exact(h.laws(&tried.fit.values).first()?, &deviations)
}

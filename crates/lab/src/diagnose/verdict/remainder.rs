//! A name that leaves more than noise.
//!
//! No model follows a real wall, or another formulation of the same law, to the noise of good sensors. What it leaves is
//! its own error: it shows in tests held out as in those fitted, and no rival takes it away. A name with a remainder
//! says how much of the gap the effect takes away, how much is left, and who comes next.

use serde::{Deserialize, Serialize};

use crate::diagnose::fit::WindowFit;
use crate::diagnose::trials::{Data, FittedHypothesis, does_something, excess, kinds};
use crate::experiment::Window;
use crate::limits::{
    LEFT_OUT, NARROW_GAP, NEARLY_NOISE, REMAINDER_BY_SWING, REMAINDER_GAP, REMAINDER_RIVAL, REMAINDER_TAKEN,
    STIFFEST_NAMED_PA_PER_M,
};
use mrbd_kernel::model::{EffectKind, Role};

/// What a named effect takes away of the gap, and what it leaves.
///
/// Shares are of the squared windowed error above noise that the wall with its own numbers fitted leaves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Remainder {
    /// Share taken away in the tests to fit.
    pub taken_fit: f64,
    /// Share taken away in the tests held out.
    pub taken_held_out: f64,
    /// Share taken away in the half of all windows with the smaller swings.
    pub taken_small_swings: f64,
    /// Share taken away in the half with the larger swings.
    pub taken_large_swings: f64,
    /// Windowed error that is left in the tests held out, in standard deviations of the noise.
    pub left_held_out: f64,
    /// The next best effect of another kind, and the share that it takes away in the tests held out.
    pub next_rival: Option<NextRival>,
}

/// The effect that comes nearest to the one named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextRival {
    /// Its name.
    pub name: String,
    /// Share of the gap that it takes away in the tests held out.
    pub taken_held_out: f64,
}

impl Remainder {
    /// What an effect takes away beside its rivals, if it may be named by that.
    pub fn of_name(
        data: &Data,
        without: &FittedHypothesis,
        named: &FittedHypothesis,
        rivals: &[FittedHypothesis],
    ) -> Option<Self> {
        let remainder = Self::new(data, without, named, rivals)?;
        let may = may_leave_something(without.errors(), named.errors());
        (may && is_soft(named) && does_something(named) && remainder.holds()).then_some(remainder)
    }

    /// What a hypothesis takes away; `None` without tests held out, or without an error above noise there.
    pub fn new(
        data: &Data,
        without: &FittedHypothesis,
        named: &FittedHypothesis,
        rivals: &[FittedHypothesis],
    ) -> Option<Self> {
        let [taken_fit, taken_held_out] = taken(without, named)?;
        let [taken_small_swings, taken_large_swings] = by_swing(data, without, named)?;
        let own = kinds(named);
        let others = rivals.iter().filter(|t| is_other(&own, kinds(t)));
        let of = |t: &FittedHypothesis| Some((taken(without, t)?[1], t.hypothesis.name()));
        let next = others.filter_map(of).max_by(|a, b| a.0.total_cmp(&b.0));
        let next_rival = next.map(|(taken_held_out, name)| NextRival { name, taken_held_out });
        let left_held_out = named.errors()[1]?;
        Some(Self {
            taken_fit,
            taken_held_out,
            taken_small_swings,
            taken_large_swings,
            left_held_out,
            next_rival,
        })
    }

    /// Whether it is a name: most of the gap goes in tests fitted and held out, in small swings and in large ones, and
    /// the next rival leaves several times as much.
    pub fn holds(&self) -> bool {
        let rival_leaves = self.next_rival.as_ref().map_or(1.0, |next| 1.0 - next.taken_held_out);
        self.taken_fit.min(self.taken_held_out) >= REMAINDER_TAKEN
            && self.taken_small_swings.min(self.taken_large_swings) >= REMAINDER_BY_SWING
            && rival_leaves >= REMAINDER_RIVAL * (1.0 - self.taken_held_out)
    }
}

/// Whether the errors in tests fitted and held out are those of a gap that a name may leave something of: a wide one, or one that it
/// nearly closes.
fn may_leave_something(without: [Option<f64>; 2], named: [Option<f64>; 2]) -> bool {
    let is_above = |least| without.iter().all(|error| error.is_some_and(|error| error > least));
    let is_nearly_noise = named.iter().all(|error| error.is_some_and(|error| error < NEARLY_NOISE));
    is_above(REMAINDER_GAP) || (is_above(NARROW_GAP) && is_nearly_noise)
}

/// Whether a hypothesis is another answer than one of these kinds, and no part of it: whether a part is enough alone, is asked apart.
fn is_other(own: &Option<Vec<EffectKind>>, kinds: Option<Vec<EffectKind>>) -> bool {
    kinds.is_some_and(|kinds| own.as_ref().is_none_or(|own| kinds.iter().any(|kind| !own.contains(kind))))
}

/// Whether a hypothesis has a bed, and every bed of it is so soft that no other way to model a contact stands for it.
pub fn is_soft(named: &FittedHypothesis) -> bool {
    let h = &named.hypothesis;
    let gives = h.additions.iter().any(|a| a.role() == Some(Role::Bed));
    gives && h.stiffness_pa_per_m(&named.fit.values).all(|k| k < STIFFEST_NAMED_PA_PER_M)
}

/// Shares of the squared error above noise taken away in the tests to fit and in those held out.
fn taken(without: &FittedHypothesis, with: &FittedHypothesis) -> Option<[f64; 2]> {
    let sides =
        [[&without.fit.windows, &with.fit.windows], [&without.held_out.windows, &with.held_out.windows]];
    let [fit, held_out] = sides.map(|[without, with]| share_taken(without, with));
    Some([fit?, held_out?])
}

/// Share of the squared error above noise that is taken away; `None` where there is none.
fn share_taken(without: &[WindowFit], with: &[WindowFit]) -> Option<f64> {
    let before = excess(without);
    (before.is_finite() && before > 0.0).then(|| 1.0 - excess(with) / before)
}

/// The shares in the halves of all windows with the smaller and the larger swings.
fn by_swing(data: &Data, without: &FittedHypothesis, with: &FittedHypothesis) -> Option<[f64; 2]> {
    let windows = data.fit.windows.iter().chain(data.held_out.windows);
    let of = |w: &Window| {
        let theta = data.fit.tests[w.test].theta_rad[w.samples.clone()].iter().flatten();
        theta.filter(|t| t.is_finite()).fold(0.0, |most: f64, t| most.max(t.abs()))
    };
    let fits = |t: &FittedHypothesis| [&t.fit.windows[..], &t.held_out.windows].concat();
    let both = fits(without).into_iter().zip(fits(with));
    let mut all = windows.map(of).zip(both).collect::<Vec<_>>();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = all.len() / 2;
    let share = |part: &[(f64, (WindowFit, WindowFit))]| {
        let (without, with): (Vec<_>, Vec<_>) = part.iter().map(|(_, both)| both.clone()).unzip();
        share_taken(&without, &with)
    };
    Some([share(&all[..half])?, share(&all[half..])?])
}

/// Error of a model over windows without that of the noise, rad; `None` where it is no more than noise.
///
/// Without the windows followed worst, as the windowed error.
pub fn model_error_rad(data: &Data, tried: &FittedHypothesis) -> Option<f64> {
    error_rad(fitted(data, tried))
}

/// The largest of these errors over the tests, each by itself; `None` where none is more than noise.
pub fn most_error_rad(data: &Data, tried: &FittedHypothesis) -> Option<f64> {
    let of_test = |test: usize| error_rad(fitted(data, tried).filter(|(window, ..)| window.test == test));
    (0..data.fit.tests.len()).filter_map(of_test).max_by(f64::total_cmp)
}

/// Windows of tests to fit and of those held out, each with how it is followed and the mean square of its noise, rad².
fn fitted<'t>(
    data: &'t Data,
    tried: &'t FittedHypothesis,
) -> impl Iterator<Item = (&'t Window, &'t WindowFit, f64)> {
    let noise_rad_2 = |window: &Window| {
        let [one, two] = data.fit.tests[window.test].noise_rad;
        0.5 * (one * one + two * two)
    };
    let windows = data.fit.windows.iter().chain(data.held_out.windows);
    let fits = tried.fit.windows.iter().chain(&tried.held_out.windows);
    windows.zip(fits).map(move |(window, fit)| (window, fit, noise_rad_2(window)))
}

fn error_rad<'t>(fitted: impl Iterator<Item = (&'t Window, &'t WindowFit, f64)>) -> Option<f64> {
    let left = |(_, fit, noise_rad_2): (_, &WindowFit, f64)| (fit.reduced() - 1.0) * noise_rad_2;
    let mut all = fitted.map(left).collect::<Vec<_>>();
    all.sort_by(f64::total_cmp);
    let kept = all.len() - (LEFT_OUT * all.len() as f64).floor() as usize;
    let mean = all[..kept].iter().sum::<f64>() / kept as f64;
    (mean > 0.0).then(|| mean.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn remainder(taken_held_out: f64, rival: f64) -> Remainder {
        Remainder {
            taken_fit: 0.97,
            taken_held_out,
            taken_small_swings: 0.9,
            taken_large_swings: 0.95,
            left_held_out: 4.0,
            next_rival: Some(NextRival { name: "corner_indentation.crack".into(), taken_held_out: rival }),
        }
    }

    #[test]
    fn analytic_a_name_with_a_remainder_takes_most_of_the_gap_and_has_no_rival() {
        assert!(remainder(0.95, 0.5).holds());
        assert!(!remainder(0.7, 0.0).holds(), "too much is left");
        assert!(!remainder(0.95, 0.93).holds(), "a rival comes near");
        assert!(
            !Remainder { taken_small_swings: 0.1, ..remainder(0.95, 0.5) }.holds(),
            "not in small swings"
        );
        assert!(!Remainder { taken_fit: 0.5, ..remainder(0.95, 0.5) }.holds());
        assert!(Remainder { next_rival: None, ..remainder(0.9, 0.0) }.holds());
    }

    #[test]
    fn analytic_a_name_leaves_something_of_a_wide_gap_or_nearly_nothing_of_a_narrow_one() {
        let may = |without: f64, [fit, held_out]: [f64; 2]| {
            may_leave_something([Some(without); 2], [Some(fit), Some(held_out)])
        };
        assert!(may(3.1, [2.0, 2.0]));
        assert!(may(1.4, [1.03, 1.05]));
        assert!(!may(1.4, [1.03, 1.2]), "not nearly closed in the tests held out");
        assert!(!may(1.2, [1.0, 1.0]), "hardly a gap");
        assert!(!may_leave_something([Some(4.0), None], [Some(1.0), None]), "nothing is held out");
    }

    #[test]
    fn analytic_shares_are_of_the_squared_error_above_noise() {
        let windows =
            |reduced: f64| vec![WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 }; 10];
        // From 10 noises to 4: 99 to 15.
        let share = share_taken(&windows(100.0), &windows(16.0)).expect("a gap");
        assert!((share - (1.0 - 15.0 / 99.0)).abs() < 1e-12, "{share}");
        assert_eq!(share_taken(&windows(0.9), &windows(0.9)), None);
        assert_eq!(share_taken(&[], &[]), None);
    }
}

//! How sure an answer is: intervals of its numbers, and what could hardly be told apart.
//!
//! Effects are told apart by their traces: how the windows change with a little of an effect. Another effect, what is
//! uncertain of the wall, and the states at the starts of the windows may imitate a share of a trace. The tests cannot
//! tell that share.

use super::fit::{Fit, Loss, Problem, WindowSlopes};
use super::hypothesis::{Addition, Hypothesis};
pub use super::next_tests::{NextPull, NextShaking, NextTests, next_tests};
use super::trials::{Data, FittedHypothesis, own_error, relieved, widened};
use crate::limits::{BED_MODEL_SD, DETECTED_SD, EQUIVALENT, IMITATED_SHARE};
use mrbd_kernel::model::Role;
use mrbd_statistics::normal::NINETY_PERCENT;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// 90 % intervals of the values of a fitted hypothesis; all that a number may be where the tests do not tell.
///
/// From the curvature of the loss at the fit, and from how far single tests move it (an infinitesimal jackknife over
/// tests). The curvature alone does not know that the windows of a test err together. Numbers of a bed may also be off by what
/// another way to model it would move them by, which noise may hide.
pub fn intervals(data: &Data, tried: &FittedHypothesis) -> Vec<[f64; 2]> {
    let covariance = covariance(data, tried);
    let interval = |(i, value): (usize, &f64)| {
        let half = NINETY_PERCENT * covariance.as_ref().map_or(f64::INFINITY, |c| c[(i, i)].sqrt());
        let unknown = &tried.hypothesis.unknowns[i];
        let own = [(value - half).max(unknown.lower), (value + half).min(unknown.upper)];
        if is_of_bed(&tried.hypothesis, i) { wider_by_model(own, *value) } else { own }
    };
    tried.fit.values.iter().enumerate().map(interval).collect()
}

/// The same for a model that does not follow to the noise, with what it leaves in the noise's place.
pub fn intervals_beside_own_error(data: &Data, tried: &FittedHypothesis) -> Vec<[f64; 2]> {
    let error = own_error(tried);
    let tests = widened(data.fit.tests, error);
    let mut wider = tried.clone();
    wider.fit.windows = relieved(&wider.fit.windows, error);
    let found = intervals(&Data { fit: Problem { tests: &tests, ..data.fit }, ..*data }, &wider);
    let h = &tried.hypothesis;
    let beside_bed = |i: usize| i >= h.nuisances && !is_of_bed(h, i);
    let all = found.into_iter().zip(&tried.fit.values).enumerate();
    all.map(|(i, (interval, value))| if beside_bed(i) { wider_by_model(interval, *value) } else { interval })
        .collect()
}

/// Whether a value is a number of a bed.
fn is_of_bed(h: &Hypothesis, value: usize) -> bool {
    let is_bed = |(_, addition): &(usize, &Addition)| addition.role() == Some(Role::Bed);
    let mut beds = h.additions.iter().enumerate().filter(is_bed);
    beds.any(|(index, _)| h.unknowns[value].belongs_to(index))
}

/// Whether what stands beside a bed differs from doing nothing by more than another way to model the bed would move it.
pub fn differs_beside_bed(tried: &FittedHypothesis) -> bool {
    let h = &tried.hypothesis;
    let differs = |i: usize| {
        let value = tried.fit.values[i];
        let [low, high] = wider_by_model([value; 2], value);
        !(low..=high).contains(&h.unknowns[i].start)
    };
    (h.nuisances..h.unknowns.len()).filter(|i| !is_of_bed(h, *i)).any(differs)
}

/// An interval about a number of a bed, or of what is beside it, with what another way to model the bed would move that number by.
///
/// A softness is 1/√k: its relative deviation is half that of k.
fn wider_by_model([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    let own = NINETY_PERCENT * 0.5 * BED_MODEL_SD * value.abs();
    [value - (value - low).hypot(own), value + (high - value).hypot(own)]
}

/// Covariance of the values of a fitted hypothesis; see [`intervals`]. `None` where the curvature cannot be told; variances
/// are infinite where a number leaves no trace.
pub fn covariance(data: &Data, tried: &FittedHypothesis) -> Option<DMatrix<f64>> {
    let Spread { covariance, scatter, .. } = spread(data, tried)?;
    Some(covariance + scatter)
}

/// How far the values of a fitted hypothesis may be off.
#[derive(Debug, Clone)]
pub struct Spread {
    /// From the curvature; infinite for numbers without a trace.
    pub covariance: DMatrix<f64>,
    /// Covariance over tests: how far single tests pull.
    pub scatter: DMatrix<f64>,
    /// How many windows tell each number: (Σ v)²/Σ v² of the shares v that they have in its variance. What was known before
    /// counts as one that errs with none: infinite where it tells a number alone.
    pub told_by: Vec<f64>,
}

/// How far the values of a fitted hypothesis may be off; `None` where the curvature cannot be told.
pub fn spread(data: &Data, tried: &FittedHypothesis) -> Option<Spread> {
    let count = tried.fit.values.len();
    if count == 0 {
        return Some(Spread {
            covariance: DMatrix::zeros(0, 0),
            scatter: DMatrix::zeros(0, 0),
            told_by: Vec::new(),
        });
    }
    let (slopes, _) = data.fit.slopes(&tried.hypothesis, &tried.fit, None)?;
    let mut curvature = DMatrix::zeros(count, count);
    let mut pulls: Vec<(usize, DVector<f64>)> = Vec::new();
    for ((window, state), WindowSlopes { residual, by_values, .. }) in
        data.fit.windows.iter().zip(&tried.fit.windows).zip(&slopes)
    {
        let weight = Loss::Likelihood.weight(state);
        curvature += by_values.transpose() * by_values * weight;
        let pull = by_values.transpose() * residual * weight;
        match pulls.iter_mut().find(|(test, _)| *test == window.test) {
            Some((_, sum)) => *sum += pull,
            None => pulls.push((window.test, pull)),
        }
    }
    tried.hypothesis.add_prior(&tried.fit.values, &mut curvature, &mut DVector::zeros(count));
    let pulls = pulls.into_iter().map(|(_, pull)| pull).collect::<Vec<_>>();
    let covariance = covariance_of(&curvature)?;
    let scatter = scatter(&covariance, &pulls);
    let weights = tried.fit.windows.iter().map(|state| Loss::Likelihood.weight(state)).collect::<Vec<_>>();
    let told_by = (0..count).map(|i| told_by(&covariance, i, &slopes, &weights)).collect();
    Some(Spread { covariance, scatter, told_by })
}

/// How many windows tell number i; none without a trace.
///
/// Of a linear estimate from independent clusters these are Satterthwaite's degrees of freedom, see Bell and McCaffrey,
/// "Bias reduction in standard errors for linear regression with multi-stage samples" (2002).
fn told_by(covariance: &DMatrix<f64>, i: usize, slopes: &[WindowSlopes], weights: &[f64]) -> f64 {
    let variance = covariance[(i, i)];
    if !variance.is_finite() {
        return 0.0;
    }
    let row = covariance.column(i).map(|c| if c.is_finite() { c } else { 0.0 });
    let share = |(window, weight): (&WindowSlopes, &f64)| weight * (&window.by_values * &row).norm_squared();
    let squares = slopes.iter().zip(weights).map(|of| share(of).powi(2)).sum::<f64>();
    variance * variance / squares
}

/// The covariance that a curvature means, infinite for numbers without a trace; `None` where two leave the same.
fn covariance_of(curvature: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let traced = (0..curvature.nrows()).filter(|i| curvature[(*i, *i)] > 0.0).collect::<Vec<_>>();
    // Numbers of different units: each by its own trace.
    let size = |k: usize| curvature[(traced[k], traced[k])].sqrt();
    let of = |k: usize, l: usize| curvature[(traced[k], traced[l])] / (size(k) * size(l));
    let inverse = DMatrix::from_fn(traced.len(), traced.len(), of).cholesky()?.inverse();
    let mut covariance = DMatrix::zeros(curvature.nrows(), curvature.nrows());
    covariance.fill_diagonal(f64::INFINITY);
    for k in 0..traced.len() {
        for l in 0..traced.len() {
            covariance[(traced[k], traced[l])] = inverse[(k, l)] / (size(k) * size(l));
        }
    }
    Some(covariance)
}

/// Covariance over tests: how far each would move the values by its own pull, beyond the mean of all; none of one test.
fn scatter(covariance: &DMatrix<f64>, pulls: &[DVector<f64>]) -> DMatrix<f64> {
    let (n, count) = (pulls.len() as f64, covariance.nrows());
    if pulls.len() < 2 {
        return DMatrix::zeros(count, count);
    }
    let mean = pulls.iter().fold(DVector::zeros(covariance.nrows()), |sum, pull| sum + pull) / n;
    // A number without a trace is not pulled.
    let known = covariance.map(|c| if c.is_finite() { c } else { 0.0 });
    let moves = pulls.iter().map(|pull| &known * (pull - &mean)).collect::<Vec<_>>();
    DMatrix::from_fn(count, count, |i, k| n / (n - 1.0) * moves.iter().map(|m| m[i] * m[k]).sum::<f64>())
}

/// Changes over which slopes are taken, in standard deviations of a number: well inside what the tests can tell.
const CHANGE_SD: f64 = 1.0;
/// Half of a number's change should make half of the window's change. A window where it differs by more than this
/// share is not linear there. An impact on one side of the change only is no trace of anything. Chosen.
const BENT: f64 = 0.25;

/// An effect that another imitates in these tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Confused {
    /// The effect.
    pub effect: String,
    /// What imitates it.
    pub imitated_by: String,
    /// Share of its trace that the other imitates, beyond what the wall's own uncertain numbers do.
    pub share: f64,
    /// Its number, with unit.
    pub parameter: String,
    /// Unit.
    pub unit: String,
    /// Smallest size told from nothing ...
    pub told_from_nothing: f64,
    /// ... and from the other.
    pub told_apart: f64,
    /// A size that matters.
    pub matters: f64,
    /// The measurement that tells the effect by itself.
    pub told_by: String,
}

/// How the windows change with the numbers of one addition.
struct Trace<'t> {
    tried: &'t FittedHypothesis,
    /// Of every window; `None` where it is not linear.
    windows: Vec<Option<WindowTrace>>,
}

/// How a window changes with them.
struct WindowTrace {
    by_values: DMatrix<f64>,
    /// Products of these columns with each other.
    products: DMatrix<f64>,
}

/// Every effect of one number with what imitates most of it, the best imitated first.
///
/// Linear about the wall with its own numbers fitted. Effects of several numbers are listed only as imitators. Those
/// that leave no trace when they are small are not listed, such as a spring that yields at once.
pub fn confused(data: &Data, recalibrated: &FittedHypothesis, tried: &[FittedHypothesis]) -> Vec<Confused> {
    let singles = tried.iter().filter(|t| t.hypothesis.additions.len() == 1);
    // A bed that hardly gives is a stiff one: what it does near nothing takes long to simulate and tells little.
    let left_out = |a: &Addition| *a == Addition::Placebo || a.role() == Some(Role::Bed);
    let real = singles.filter(|t| !left_out(&t.hypothesis.additions[0])).collect::<Vec<_>>();
    // All are looked at about the same wall in the same states.
    let Some(chords) = data.fit.chords(&recalibrated.hypothesis, &recalibrated.fit) else {
        return Vec::new();
    };
    let traces = real.par_iter().filter_map(|t| trace(data, recalibrated, &chords, t)).collect::<Vec<_>>();
    let one = |t: &&Trace| t.tried.hypothesis.unknowns.len() == t.tried.hypothesis.nuisances + 1;
    let effects = traces.par_iter().filter(|t| t.tried.hypothesis.additions[0].kind().is_some()).filter(one);
    let mut all = effects.filter_map(|effect| most_confused(effect, &traces)).collect::<Vec<_>>();
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}

fn trace<'t>(
    data: &Data,
    recalibrated: &FittedHypothesis,
    chords: &[DMatrix<f64>],
    tried: &'t FittedHypothesis,
) -> Option<Trace<'t>> {
    let h = &tried.hypothesis;
    // The wall's own numbers as they were fitted, and nothing added.
    let values = h.values_from(&recalibrated.hypothesis, &recalibrated.fit.values);
    let at = Fit { values, windows: recalibrated.fit.windows.clone(), cost: 0.0, covariance: None };
    let covariance = tried.fit.covariance.as_ref()?;
    let change = |i: usize| {
        let sd = covariance[(i, i)].max(0.0).sqrt();
        (sd.is_finite() && sd > 0.0).then_some((CHANGE_SD * sd).min(h.unknowns[i].scale))
    };
    let changes = (0..h.unknowns.len()).map(change).collect::<Option<Vec<_>>>()?;
    let half = changes.iter().map(|c| c / 2.0).collect::<Vec<_>>();
    let slopes = data.fit.slopes_over(h, &at, &changes, Some(chords))?;
    let near = data.fit.slopes_over(h, &at, &half, Some(chords))?;
    let linear = |(far, near): (WindowSlopes, WindowSlopes)| {
        is_linear(&far, &near)
            .then(|| WindowTrace { products: far.by_values.tr_mul(&far.by_values), by_values: far.by_values })
    };
    Some(Trace { tried, windows: slopes.into_iter().zip(near).map(linear).collect() })
}

/// Whether a window is linear over a change and over half of it, with the same slopes.
fn is_linear(far: &WindowSlopes, near: &WindowSlopes) -> bool {
    let columns = far.by_values.column_iter().zip(near.by_values.column_iter());
    let same = columns.into_iter().all(|(far, near)| (far - near).norm() <= BENT * near.norm());
    far.holds && near.holds && same
}

fn most_confused(effect: &Trace, all: &[Trace]) -> Option<Confused> {
    let alone = information(effect, effect, 0)?;
    let kind = |t: &Trace| t.tried.hypothesis.additions[0].kind();
    let others = all.iter().filter(|other| kind(other).is_none() || kind(other) != kind(effect));
    let shares = others.filter_map(|other| {
        let added = other.tried.hypothesis.unknowns.len() - other.tried.hypothesis.nuisances;
        let left = information(effect, other, added)?;
        Some((1.0 - left / information(effect, other, 0)?, left, other))
    });
    let (share, left, other) = shares.max_by(|a, b| a.0.total_cmp(&b.0))?;
    if share < IMITATED_SHARE {
        return None;
    }
    let h = &effect.tried.hypothesis;
    let Addition::Effect(variant) = h.additions[0] else { return None };
    let unknown = &h.unknowns[h.nuisances];
    Some(Confused {
        effect: h.additions[0].name(),
        imitated_by: other.tried.hypothesis.additions[0].name(),
        share,
        parameter: unknown.key.clone(),
        unit: unknown.unit.to_owned(),
        told_from_nothing: DETECTED_SD / alone.sqrt(),
        // Half the square of the size over its standard deviation is what speaks for one and against the other.
        told_apart: (2.0 * EQUIVALENT / left).sqrt(),
        matters: unknown.scale,
        told_by: variant.entry().told_by.to_owned(),
    })
}

/// Inverse variance of an effect's number in the windows in which both are linear. Beside it are free the wall's own
/// uncertain numbers and the first few of another addition. `None` where it leaves no trace.
fn information(effect: &Trace, other: &Trace, added: usize) -> Option<f64> {
    let h = &effect.tried.hypothesis;
    let (own, at) = (h.nuisances, h.nuisances);
    let size = own + 1 + added;
    let (mut a, from) = (DMatrix::zeros(size, size), other.tried.hypothesis.nuisances);
    for (mine, theirs) in effect.windows.iter().zip(&other.windows) {
        let (Some(mine), Some(theirs)) = (mine, theirs) else { continue };
        let mut own_block = a.view_mut((0, 0), (own + 1, own + 1));
        own_block += &mine.products;
        let shared = mine.by_values.tr_mul(&theirs.by_values.columns(from, added));
        let mut right = a.view_mut((0, own + 1), (own + 1, added));
        right += &shared;
        let mut below = a.view_mut((own + 1, 0), (added, own + 1));
        below += shared.transpose();
        let mut their_block = a.view_mut((own + 1, own + 1), (added, added));
        their_block += theirs.products.view((from, from), (added, added));
    }
    let scale = |k: usize| if a[(k, k)] > 0.0 { a[(k, k)].sqrt() } else { 1.0 };
    let scales = (0..size).map(scale).collect::<Vec<_>>();
    if a[(at, at)] <= 0.0 {
        return None;
    }
    // Columns of length one; a number without a trace, or one that is another's double, must not stop the inverse.
    let mut unit = DMatrix::from_fn(size, size, |i, j| a[(i, j)] / (scales[i] * scales[j]));
    for k in 0..size {
        unit[(k, k)] += 1e-9;
        if let Some(sd) = h.unknowns.get(k).filter(|_| k < own).and_then(|u| u.prior_sd) {
            unit[(k, k)] += 1.0 / (sd * scales[k]).powi(2);
        }
    }
    let inverse = unit.cholesky()?.inverse();
    Some(scales[at].powi(2) / inverse[(at, at)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::starter_with;

    #[test]
    fn analytic_tests_of_a_mean_scatter_as_their_means_do() {
        // The mean of four numbers known to 1, one a test: curvature 4, pulls are the residuals. Leaving one out moves the mean
        // by a third of its residual: (n - 1)/n of the sum of their squares is sum r²/(n (n - 1)).
        let residuals = [0.3, -1.1, 0.5, 0.3];
        let pulls = residuals.map(|r| DVector::from_element(1, r));
        let covariance = covariance_of(&DMatrix::from_element(1, 1, 4.0)).expect("a trace");
        let expected = residuals.iter().map(|r| r * r).sum::<f64>() / 12.0;
        assert!((covariance[(0, 0)] - 0.25).abs() < 1e-15);
        assert!((scatter(&covariance, &pulls)[(0, 0)] - expected).abs() < 1e-15);
    }

    #[test]
    fn analytic_a_gain_beside_a_bed_differs_from_one_by_more_than_another_bed_moves_it() {
        let hypothesis = starter_with(&["compliant_joint.both", "sensor_gain.lower"]);
        let differs = |gain: f64| {
            let fit =
                Fit { values: vec![3e-5, 1e-3, gain], windows: Vec::new(), cost: 0.0, covariance: None };
            differs_beside_bed(&FittedHypothesis {
                hypothesis: hypothesis.clone(),
                held_out: fit.clone(),
                fit,
            })
        };
        // 1.645 times half of three parts in a hundred: 2.5 %.
        assert!(!differs(0.99) && !differs(1.02));
        assert!(differs(0.97) && differs(1.03));
    }

    #[test]
    fn analytic_numbers_of_a_bed_are_known_no_better_than_the_model_of_it() {
        let h = starter_with(&["compliant_joint.ground", "viscous_damping"]);
        let of_bed = (0..h.unknowns.len()).map(|i| is_of_bed(&h, i)).collect::<Vec<_>>();
        assert_eq!(of_bed, [true, true, false]);
        // Half of three parts in a hundred of 2, by 1.645; then 3 and 4 such parts at right angles.
        let own = NINETY_PERCENT * 0.5 * BED_MODEL_SD * 2.0;
        let near =
            |found: [f64; 2], off: f64| (found[0] - (2.0 - off)).abs().max((found[1] - (2.0 + off)).abs());
        assert!(near(wider_by_model([2.0, 2.0], 2.0), own) < 1e-15);
        assert!(near(wider_by_model([2.0 - 0.75 * own, 2.0 + 0.75 * own], 2.0), 1.25 * own) < 1e-15);
    }

    #[test]
    fn analytic_a_number_is_told_by_as_many_windows_as_weigh_the_same() {
        let windows = |slopes: &[f64]| {
            let of = |slope: &f64| WindowSlopes {
                residual: DVector::zeros(1),
                by_values: DMatrix::from_row_slice(1, 2, &[*slope, 0.0]),
                holds: true,
            };
            slopes.iter().map(of).collect::<Vec<_>>()
        };
        let told = |slopes: &[f64]| {
            let curvature = slopes.iter().map(|slope| slope * slope).sum::<f64>();
            let covariance = covariance_of(&DMatrix::from_row_slice(2, 2, &[curvature, 0.0, 0.0, 0.0]));
            let covariance = covariance.expect("a trace");
            [0, 1].map(|i| told_by(&covariance, i, &windows(slopes), &vec![1.0; slopes.len()]))
        };
        // Roundings of a few products.
        assert!((told(&[2.0; 5])[0] - 5.0).abs() < 1e-14);
        // Shares of 100 and 1: 101²/(100² + 1).
        assert!((told(&[10.0, 1.0])[0] - 10201.0 / 10001.0).abs() < 1e-14);
        assert_eq!(told(&[2.0; 5])[1], 0.0);
    }

    #[test]
    fn analytic_a_number_without_a_trace_is_not_known_and_two_with_one_trace_are_not_told_apart() {
        let one = covariance_of(&DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0])).expect("a trace");
        assert!((one[(0, 0)] - 0.25).abs() < 1e-15 && one[(1, 1)] == f64::INFINITY);
        assert_eq!(
            scatter(&one, &[[1.0, 0.0], [-1.0, 0.0]].map(|p| DVector::from_column_slice(&p)))[(1, 1)],
            0.0
        );
        assert!(covariance_of(&DMatrix::from_element(2, 2, 1.0)).is_none());
    }
}

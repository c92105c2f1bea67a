//! Which effects these tests could hardly tell from each other, whatever is named.
//!
//! How the windows would change with a little of an effect is set against how they would change with any amount of another,
//! of what is uncertain of the wall, and of the state at the start of every window: the share of its trace that these
//! imitate is what the tests cannot tell.

use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::diagnose::fit::{Fit, WindowSlopes};
use crate::diagnose::hypothesis::Addition;
use crate::diagnose::trials::{Data, Tried};
use crate::limits::{DETECTED_SD, EQUIVALENT, IMITATED_SHARE};

/// Changes over which slopes are taken, in standard deviations of a number: well inside what the tests can tell.
const CHANGE_SD: f64 = 1.0;
/// A window whose change over half of that differs from half its change by more than this share is not linear there: an impact
/// that is met on one side of the change only is no trace of anything. Chosen.
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
    tried: &'t Tried,
    /// Of every window; `None` where it is not linear.
    slopes: Vec<Option<WindowSlopes>>,
}

/// Every effect of one number with what imitates most of it, the best imitated first.
///
/// Linear about the wall with its own numbers fitted. Effects of several numbers stand only as imitators; those that leave
/// no trace when they are small, such as a spring that yields at once, do not stand at all.
pub fn confused(data: &Data, recalibrated: &Tried, tried: &[Tried]) -> Vec<Confused> {
    let singles = tried.iter().filter(|t| t.hypothesis.additions.len() == 1);
    let real = singles.filter(|t| t.hypothesis.additions[0] != Addition::Placebo).collect::<Vec<_>>();
    let traces = real.par_iter().filter_map(|t| trace(data, recalibrated, t)).collect::<Vec<_>>();
    let one = |t: &&Trace| t.tried.hypothesis.unknowns.len() == t.tried.hypothesis.nuisances + 1;
    let effects = traces.iter().filter(|t| t.tried.hypothesis.additions[0].kind().is_some()).filter(one);
    let mut all = effects.filter_map(|effect| most_confused(effect, &traces)).collect::<Vec<_>>();
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}

fn trace<'t>(data: &Data, recalibrated: &Tried, tried: &'t Tried) -> Option<Trace<'t>> {
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
    let (slopes, _) = data.fit.slopes(h, &at, Some(&changes))?;
    let (near, _) = data.fit.slopes(h, &at, Some(&changes.iter().map(|c| c / 2.0).collect::<Vec<_>>()))?;
    let linear = |(far, near): (WindowSlopes, WindowSlopes)| is_linear(&far, &near).then_some(far);
    Some(Trace { tried, slopes: slopes.into_iter().zip(near).map(linear).collect() })
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

/// Inverse variance of an effect's number beside the wall's own uncertain numbers and the first few of another addition, in
/// the windows in which both are linear; `None` where it leaves no trace.
fn information(effect: &Trace, other: &Trace, added: usize) -> Option<f64> {
    let h = &effect.tried.hypothesis;
    let (own, at) = (h.nuisances, h.nuisances);
    let size = own + 1 + added;
    let mut a = DMatrix::zeros(size, size);
    for (w, window) in effect.slopes.iter().enumerate() {
        let (Some(window), Some(theirs)) = (window, &other.slopes[w]) else { continue };
        let mut columns = window.by_values.clone().resize_horizontally(size, 0.0);
        for k in 0..added {
            let theirs = theirs.by_values.column(other.tried.hypothesis.nuisances + k);
            columns.set_column(own + 1 + k, &theirs);
        }
        a += columns.transpose() * &columns;
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

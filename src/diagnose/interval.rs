//! How well the numbers of an answer are known.

use super::hypothesis::Hypothesis;
use super::search::{Data, Tried, refit};
use super::windows::Window;

/// Half width of a 90 % interval of a normal variable, in standard deviations.
const NINETY_PERCENT: f64 = 1.644_853_626_951_472_2;

/// 90 % intervals of the values of a fitted hypothesis.
///
/// From the curvature of the fit and from the scatter of fits that each leave one test out (jackknife): the first does
/// not know that the windows of a test err together.
pub fn intervals(data: &Data, tried: &Tried) -> Vec<[f64; 2]> {
    let count = tried.fit.values.len();
    let curvature = |i: usize| tried.fit.covariance.as_ref().map_or(0.0, |c| c[(i, i)].max(0.0));
    let scatter = jackknife(data, tried);
    let h = &tried.hypothesis;
    let interval = |i: usize| {
        let half = NINETY_PERCENT * (curvature(i) + scatter[i]).sqrt();
        let value = tried.fit.values[i];
        [(value - half).max(h.unknowns[i].lower), (value + half).min(h.unknowns[i].upper)]
    };
    (0..count).map(interval).collect()
}

/// Variances over fits that each leave one test out.
fn jackknife(data: &Data, tried: &Tried) -> Vec<f64> {
    let mut tests = data.fit.windows.iter().map(|w| w.test).collect::<Vec<_>>();
    tests.dedup();
    let without = tests.iter().filter_map(|test| refitted_without(data, tried, *test)).collect::<Vec<_>>();
    let n = without.len() as f64;
    let variance = |i: usize| {
        let mean = without.iter().map(|values| values[i]).sum::<f64>() / n;
        (n - 1.0) / n * without.iter().map(|values| (values[i] - mean).powi(2)).sum::<f64>()
    };
    (0..tried.fit.values.len()).map(|i| if without.len() < 2 { 0.0 } else { variance(i) }).collect()
}

fn refitted_without(data: &Data, tried: &Tried, test: usize) -> Option<Vec<f64>> {
    let kept = |window: &Window| window.test != test;
    let windows = data.fit.windows.iter().filter(|w| kept(w)).cloned().collect::<Vec<_>>();
    if windows.is_empty() {
        return None;
    }
    let states = data.fit.windows.iter().zip(&tried.fit.windows).filter(|(w, _)| kept(w));
    let mut from = tried.clone();
    from.fit.windows = states.map(|(_, state)| state.clone()).collect();
    from.held_out.windows.clear();
    let fit = super::fit::Problem { windows: &windows, ..data.fit };
    let part = Data { fit, held_out: super::fit::Problem { windows: &[], ..data.held_out } };
    let h: Hypothesis = tried.hypothesis.clone();
    Some(refit(&part, h, &from, &tried.fit.values)?.fit.values)
}

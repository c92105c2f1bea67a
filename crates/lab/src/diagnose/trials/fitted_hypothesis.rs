//! A hypothesis, fitted, and judged on tests that the fit has not seen.
//!
//! It is judged by whether it follows the tests within noise, closes a gap, and does something.

use super::kind_of;
use crate::diagnose::fit::{
    Fit, Problem, WindowFit, more_poor_held_out_sd, nats, poor_share, windowed_error,
};
use crate::diagnose::hypothesis::Hypothesis;
use crate::experiment::{TestData, Window};
use crate::limits::{
    HELD_OUT_ERROR, LEAST_SIZE, LEFT_OF_GAP, MISSED_HELD_OUT_SD, MISSED_SHARE, MISSED_SHARE_SD,
    NEARLY_CLOSES, NEXT_TO_NOTHING, NOISE, NOISE_AFTER, SIGNIFICANT_SD,
};
use mrbd_kernel::model::EffectKind;

/// A hypothesis, fitted, and judged on tests that the fit has not seen.
#[derive(Debug, Clone)]
pub struct FittedHypothesis {
    /// What was supposed.
    pub hypothesis: Hypothesis,
    /// Fit to the tests for it.
    pub fit: Fit,
    /// The other tests, with only the states of their windows fitted; empty if there are none.
    pub held_out: Fit,
}

/// The windows of the tests to fit and of the others.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a> {
    /// To fit.
    pub fit: Problem<'a>,
    /// Held out.
    pub held_out: Problem<'a>,
}

impl<'a> Data<'a> {
    /// Windows to fit and held out, of tests.
    pub fn new(tests: &'a [TestData], windows: &'a [Vec<Window>; 2]) -> Self {
        let problem = |windows: &'a Vec<Window>| Problem { tests, windows, budget: None };
        Self { fit: problem(&windows[0]), held_out: problem(&windows[1]) }
    }
}

impl FittedHypothesis {
    /// The states of the windows fitted.
    pub fn states(&self) -> Vec<Vec<f64>> {
        self.fit.windows.iter().map(|window| window.x.clone()).collect()
    }

    /// Windowed errors: fit, held out.
    pub fn errors(&self) -> [Option<f64>; 2] {
        [windowed_error(&self.fit.windows), windowed_error(&self.held_out.windows)]
    }

    /// Windowed error of the tests to fit; infinite where there are none.
    pub fn fit_error(&self) -> f64 {
        self.errors()[0].unwrap_or(f64::INFINITY)
    }

    /// What speaks against it, in natural logarithms of likelihood: the windows that were fitted, and those held out.
    /// The first include the prior and, for each added number, half the logarithm of the number of windows (Schwarz).
    pub fn against(&self, data: &Data) -> [f64; 2] {
        [self.in_tests_fitted() + self.price(data), nats(&self.held_out.windows)]
    }

    /// What speaks against it in the windows that were fitted, with the prior and without the price of added numbers.
    pub fn in_tests_fitted(&self) -> f64 {
        nats(&self.fit.windows) + self.prior()
    }

    /// The same in all windows, without the price of added numbers.
    pub fn unpriced(&self) -> f64 {
        self.in_tests_fitted() + nats(&self.held_out.windows)
    }

    /// What its added numbers cost: half the logarithm of the samples fitted for each (Schwarz).
    pub fn price(&self, data: &Data) -> f64 {
        let samples = data.fit.windows.iter().map(|w| w.samples.len()).sum::<usize>();
        let added = self.hypothesis.unknowns.len() - self.hypothesis.nuisances;
        0.5 * added as f64 * (samples.max(1) as f64).ln()
    }

    fn prior(&self) -> f64 {
        0.5 * self.hypothesis.prior_penalty(&self.fit.values)
    }
}

/// Windowed error over fitted and held-out windows together; `None` where there are none.
pub fn joint_error(tried: &FittedHypothesis) -> Option<f64> {
    windowed_error(&all_windows(tried))
}

/// Fitted and held-out windows together.
pub fn all_windows(tried: &FittedHypothesis) -> Vec<WindowFit> {
    [&tried.fit.windows[..], &tried.held_out.windows].concat()
}

/// Whether what is left is noise.
pub fn is_noise(tried: &FittedHypothesis) -> bool {
    let fits = all_windows(tried);
    windowed_error(&fits).is_some_and(|error| error < NOISE) && !too_many_poor(&fits)
}

/// Whether more windows are followed badly than may be.
fn too_many_poor(fits: &[WindowFit]) -> bool {
    let count = fits.len() as f64;
    let sd = (MISSED_SHARE * (1.0 - MISSED_SHARE) / count).sqrt();
    poor_share(fits) > MISSED_SHARE + MISSED_SHARE_SD * sd
}

/// What speaks against a hypothesis in all windows.
pub fn against(data: &Data, tried: &FittedHypothesis) -> f64 {
    tried.against(data).iter().sum()
}

/// Whether what a hypothesis leaves is near enough to noise to be the truth, for a gap that was `before`.
pub fn closes(tried: &FittedHypothesis, before: f64) -> bool {
    closes_held_out(tried) && follows_to_noise(tried, before)
}

/// Whether windows are followed badly: more than may be, or more of those held out.
pub fn misses_windows(tried: &FittedHypothesis) -> bool {
    are_missed(&tried.fit.windows, &tried.held_out.windows)
}

fn are_missed(fit: &[WindowFit], held_out: &[WindowFit]) -> bool {
    too_many_poor(&[fit, held_out].concat()) || more_poor_held_out_sd(fit, held_out) >= MISSED_HELD_OUT_SD
}

/// Whether the tests held out are followed as those fitted are.
pub fn closes_held_out(tried: &FittedHypothesis) -> bool {
    tried.errors()[1].is_none_or(|error| error < HELD_OUT_ERROR)
        && more_poor_held_out_sd(&tried.fit.windows, &tried.held_out.windows) < MISSED_HELD_OUT_SD
}

/// Whether what a hypothesis leaves of all windows is near enough to noise, for a gap that was `before`.
pub fn follows_to_noise(tried: &FittedHypothesis, before: f64) -> bool {
    let Some(after) = joint_error(tried) else { return false };
    let left = (after * after - 1.0) / (before * before - 1.0).max(f64::MIN_POSITIVE);
    !too_many_poor(&all_windows(tried)) && (after < NOISE_AFTER || left < LEFT_OF_GAP)
}

/// Whether what is left of windows to fit and held out is noise, as where an effect is named.
pub fn leave_noise([fit, held_out]: &[Vec<WindowFit>; 2]) -> bool {
    let all = [&fit[..], held_out].concat();
    windowed_error(&all).is_some_and(|error| error < NOISE_AFTER) && !are_missed(fit, held_out)
}

/// Whether what a hypothesis leaves of a gap that was `before` is so little that other starts may close it.
pub fn nearly_closes(tried: &FittedHypothesis, before: f64) -> bool {
    leaves_less(tried, before, NOISE, NEARLY_CLOSES)
}

/// Whether a hypothesis leaves hardly more than noise, or next to nothing of a gap that was `before`.
pub fn all_but_closes(tried: &FittedHypothesis, before: f64) -> bool {
    leaves_less(tried, before, NOISE_AFTER, NEXT_TO_NOTHING)
}

/// Whether what a hypothesis leaves of all windows is less than an error, or than a share of the squared error above noise of a gap that
/// was `before`.
fn leaves_less(tried: &FittedHypothesis, before: f64, error: f64, share: f64) -> bool {
    let Some(after) = joint_error(tried) else { return false };
    after < error || after * after - 1.0 < share * (before * before - 1.0)
}

/// Kinds of a hypothesis' additions, sorted; `None` if one is no answer.
pub fn kinds(tried: &FittedHypothesis) -> Option<Vec<EffectKind>> {
    let h = &tried.hypothesis;
    let kind = |index| kind_of(h, &tried.fit.values, index);
    let mut kinds = (0..h.additions.len()).map(kind).collect::<Option<Vec<_>>>()?;
    kinds.sort_unstable_by_key(|kind| kind.name());
    Some(kinds)
}

/// Whether every addition of a hypothesis does something. A number of it then differs from doing nothing by more than
/// chance, and by a size that matters.
pub fn does_something(tried: &FittedHypothesis) -> bool {
    let h = &tried.hypothesis;
    let acts = |i: usize, own: &[usize]| {
        let unknown = &h.unknowns[i];
        let size = (tried.fit.values[i] - unknown.start).abs();
        size > SIGNIFICANT_SD * sd_of(tried, i, own) && size > LEAST_SIZE * unknown.scale
    };
    let acts_by_one = |index: usize| {
        let own = (h.nuisances..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
        let own = own.collect::<Vec<_>>();
        own.iter().any(|i| acts(*i, &own))
    };
    (0..h.additions.len()).all(acts_by_one)
}

/// Standard deviation of a number of an addition with these numbers; of the size of a law with the numbers of its shape as they are. A law
/// that gains a thousand natural logarithms at 3e-4 rad may have a size and a width that the tests tell only together.
fn sd_of(tried: &FittedHypothesis, number: usize, own: &[usize]) -> f64 {
    let Some(covariance) = &tried.fit.covariance else { return f64::INFINITY };
    let h = &tried.hypothesis;
    let of_shape = own.iter().copied().filter(|i| h.is_size(number) && !h.is_size(*i)).collect::<Vec<_>>();
    let shape = covariance.select_rows(&of_shape).select_columns(&of_shape);
    let with_size = covariance.select_columns([&number]).select_rows(&of_shape);
    let told = shape.cholesky().map_or(0.0, |shape| with_size.dot(&shape.solve(&with_size)));
    (covariance[(number, number)] - told).max(0.0).sqrt()
}

/// The first of hypotheses in order that is an answer and does something.
pub fn best_answer<'t>(
    tried: impl IntoIterator<Item = &'t FittedHypothesis>,
) -> Option<&'t FittedHypothesis> {
    tried.into_iter().find(|t| kinds(t).is_some() && does_something(t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::discovery::twin::{Twin, drag, wall_with};
    use nalgebra::DMatrix;

    #[test]
    fn analytic_a_law_does_something_where_its_size_does_with_its_shape_as_it_is() {
        let twin = Twin::new(&wall_with(""), 1e-4);
        let trials = twin.trials();
        let wall = trials.wall_fits(None).expect("windows").recalibrated;
        let (hypothesis, values) = trials.law_beside(&wall, &drag(1.7, 300.0));
        let size = hypothesis.nuisances;
        // Size and exponent told to half of themselves, and their sum to a hundredth.
        let correlated = |share: f64| {
            let mut covariance = DMatrix::identity(values.len(), values.len());
            let sd = [0.5 * values[size], 0.5 * values[size + 1]];
            for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let correlation = if i == k { 1.0 } else { -share };
                covariance[(size + i, size + k)] = correlation * sd[i] * sd[k];
            }
            let fit = Fit { values: values.clone(), covariance: Some(covariance), ..wall.fit.clone() };
            FittedHypothesis { hypothesis: hypothesis.clone(), fit, ..wall.clone() }
        };
        // √(1 − 0.99²) is 0.14: the size is fourteen of the deviations that are left, or two.
        assert!(does_something(&correlated(0.99)));
        assert!(!does_something(&correlated(0.0)));
    }
}

//! When a hypothesis follows the tests within noise, closes a gap, and does something.

use super::{Data, Tried, kind_of};
use crate::diagnose::fit::{WindowFit, more_poor_held_out_sd, poor_share, windowed_error};
use mrbd_kernel::model::EffectKind;

/// Windowed error, in standard deviations of the noise, that is noise. Some twenty null experiments, at noises of 1e-5 to
/// 3e-4 rad, lie between 0.96 and 1.00.
const NOISE: f64 = 1.06;
/// The same after an effect was fitted to them: its tests are followed within it, or it is not the law. Where the right
/// effect is added, the error lies between 0.96 and 1.02.
const NOISE_AFTER: f64 = 1.03;
/// Share of windows that may have more error than noise leaves ([`WindowFit::is_poor`]), whatever the others say: a stop that is
/// met in the largest swings only shows in few. Chosen: where nothing is hidden, and beside right names, 0 to 4.4 % of 60 to
/// 330 windows lie beyond (impacts that the noise decides, and what another way of modelling a contact leaves), and 4 of 55 in
/// a twin; beside a wrong name 10 %, with a stop taken for nothing 12 %, and 19 % and more with other laws outside the catalogue.
const POOR_SHARE: f64 = 0.045;
/// Standard deviations of their number by which more of them are a gap.
const MORE_POOR_SD: f64 = 3.0;
/// Standard deviations by which more windows held out than fitted may have more error than noise leaves: a law that is only
/// near the right one takes up what it was fitted to. Chosen: right names 1.7 at most among 142, a saturating spring called a
/// cubic one 3.7.
const MORE_POOR_HELD_OUT_SD: f64 = 2.5;
/// Hypotheses this near the best, in natural logarithms of likelihood over all windows, cannot be told from it. Chosen: a
/// ratio of likelihoods of 3e6.
pub const EQUIVALENT: f64 = 15.0;
/// Error on tests held out above which nothing is named.
pub const HELD_OUT: f64 = 1.5;
/// Share of the squared error above noise that a named effect may leave, where the gap is so large that the least error of
/// another simulator shows. Right names leave less than 1e-4; a saturating spring called a cubic one 1e-3.
const LEFT: f64 = 5e-4;
/// Standard deviations by which at least one number of an effect must differ from doing nothing ...
const SIGNIFICANT: f64 = 4.0;
/// ... and the share of the size that would matter. Both chosen; a null twin that was once named had 1.2 standard
/// deviations and 7e-5.
pub const FLOOR: f64 = 0.005;

/// Windowed error over fitted and held-out windows together; none where there are none.
pub fn joint_error(tried: &Tried) -> Option<f64> {
    windowed_error(&all_windows(tried))
}

/// Fitted and held-out windows together.
pub fn all_windows(tried: &Tried) -> Vec<WindowFit> {
    [&tried.fit.windows[..], &tried.held_out.windows].concat()
}

/// Whether what is left is noise.
pub fn is_noise(tried: &Tried) -> bool {
    let fits = all_windows(tried);
    windowed_error(&fits).is_some_and(|error| error < NOISE) && !too_many_poor(&fits)
}

/// Whether more windows are followed badly than may be.
fn too_many_poor(fits: &[WindowFit]) -> bool {
    let count = fits.len() as f64;
    let sd = (POOR_SHARE * (1.0 - POOR_SHARE) / count).sqrt();
    poor_share(fits) > POOR_SHARE + MORE_POOR_SD * sd
}

/// What speaks against a hypothesis in all windows.
pub fn against(data: &Data, tried: &Tried) -> f64 {
    tried.against(data).iter().sum()
}

/// Whether what a hypothesis leaves is near enough to noise to be the truth, for a gap that was `before`.
pub fn closes(tried: &Tried, before: f64) -> bool {
    let Some(after) = joint_error(tried) else { return false };
    let held_out = tried.errors()[1].is_none_or(|error| error < HELD_OUT)
        && more_poor_held_out_sd(&tried.fit.windows, &tried.held_out.windows) < MORE_POOR_HELD_OUT_SD;
    let left = (after * after - 1.0) / (before * before - 1.0).max(f64::MIN_POSITIVE);
    held_out && !too_many_poor(&all_windows(tried)) && (after < NOISE_AFTER || left < LEFT)
}

/// Kinds of a hypothesis' additions, sorted; none if one is no answer.
pub fn kinds(tried: &Tried) -> Option<Vec<EffectKind>> {
    let h = &tried.hypothesis;
    let kind = |index| kind_of(h, &tried.fit.values, index);
    let mut kinds = (0..h.additions.len()).map(kind).collect::<Option<Vec<_>>>()?;
    kinds.sort_unstable_by_key(|kind| kind.name());
    Some(kinds)
}

/// Whether every addition of a hypothesis does something: a number of it differs from doing nothing by more than chance,
/// and by more than a size too small to matter.
pub fn does_something(tried: &Tried) -> bool {
    let h = &tried.hypothesis;
    let acts = |i: usize| {
        let unknown = &h.unknowns[i];
        let size = (tried.fit.values[i] - unknown.start).abs();
        let sd = tried.fit.covariance.as_ref().map_or(f64::INFINITY, |c| c[(i, i)].max(0.0).sqrt());
        size > SIGNIFICANT * sd && size > FLOOR * unknown.scale
    };
    let all = h.nuisances..h.unknowns.len();
    (0..h.additions.len()).all(|index| all.clone().any(|i| h.unknowns[i].belongs_to(index) && acts(i)))
}

/// The first of hypotheses in order that is an answer and does something.
pub fn best_answer<'t>(tried: impl IntoIterator<Item = &'t Tried>) -> Option<&'t Tried> {
    tried.into_iter().find(|t| kinds(t).is_some() && does_something(t))
}

//! How well a hypothesis follows the measurement over windows.

use super::window_fit::WindowFit;

/// Share of the windows, those worst followed, left out of the windowed error: an impact decided by less than the noise
/// parts even a perfect simulation from the measurement.
const LEFT_OUT: f64 = 0.1;
/// What one window can say against a hypothesis at most, in natural logarithms of likelihood.
const MOST_NATS: f64 = 40.0;

/// Root mean square error over windows, in standard deviations of the noise; 1 is perfect.
/// None where there are none.
pub fn windowed_error(fits: &[WindowFit]) -> Option<f64> {
    let mut reduced = fits.iter().map(WindowFit::reduced).collect::<Vec<_>>();
    if reduced.is_empty() {
        return None;
    }
    reduced.sort_by(f64::total_cmp);
    let kept = reduced.len() - (LEFT_OUT * reduced.len() as f64).floor() as usize;
    Some((reduced[..kept].iter().sum::<f64>() / kept as f64).sqrt())
}

/// Share of the windows with more than `reduced` times the squared noise.
pub fn share_beyond(fits: &[WindowFit], reduced: f64) -> f64 {
    let beyond = fits.iter().filter(|fit| fit.reduced() > reduced).count();
    if fits.is_empty() { 0.0 } else { beyond as f64 / fits.len() as f64 }
}

/// Share of the windows with more error than noise leaves.
pub fn poor_share(fits: &[WindowFit]) -> f64 {
    let poor = fits.iter().filter(|fit| fit.is_poor()).count();
    if fits.is_empty() { 0.0 } else { poor as f64 / fits.len() as f64 }
}

/// What the windows say against a hypothesis, in natural logarithms of likelihood: half the squared error above that of
/// noise, bounded for each window, so that no window decides alone.
pub fn nats(fits: &[WindowFit]) -> f64 {
    fits.iter().map(nats_of).sum()
}

/// The same for one window.
pub fn nats_of(fit: &WindowFit) -> f64 {
    let excess = 0.5 * (fit.squares - fit.freedom);
    if excess > 0.0 { MOST_NATS * (1.0 - (-excess / MOST_NATS).exp()) } else { excess }
}

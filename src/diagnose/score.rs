//! How well a hypothesis follows the measurement over windows.

use super::window_fit::WindowFit;
use super::windows::Window;

/// Share of the windows, those worst followed, left out of the windowed error: an impact decided by less than the noise
/// parts even a perfect simulation from the measurement.
const LEFT_OUT: f64 = 0.1;
/// What one window can say against a hypothesis at most, in natural logarithms of likelihood.
const MOST_NATS: f64 = 40.0;

/// Root mean square error over the windows in which the wall moves, in standard deviations of the noise; 1 is perfect.
/// None where nothing moves.
pub fn windowed_error(windows: &[Window], fits: &[WindowFit]) -> Option<f64> {
    let mut reduced = moving(windows, fits).map(|fit| fit.reduced()).collect::<Vec<_>>();
    if reduced.is_empty() {
        return None;
    }
    reduced.sort_by(f64::total_cmp);
    let kept = reduced.len() - (LEFT_OUT * reduced.len() as f64).floor() as usize;
    Some((reduced[..kept].iter().sum::<f64>() / kept as f64).sqrt())
}

/// Share of the windows in motion with more than `reduced` times the squared noise.
pub fn share_beyond(windows: &[Window], fits: &[WindowFit], reduced: f64) -> f64 {
    let count = moving(windows, fits).count();
    let beyond = moving(windows, fits).filter(|fit| fit.reduced() > reduced).count();
    if count == 0 { 0.0 } else { beyond as f64 / count as f64 }
}

/// What the windows say against a hypothesis, in natural logarithms of likelihood: half the squared error above that of
/// noise, bounded for each window, so that no window decides alone.
pub fn nats(windows: &[Window], fits: &[WindowFit]) -> f64 {
    moving(windows, fits).map(nats_of).sum()
}

/// The same for one window.
pub fn nats_of(fit: &WindowFit) -> f64 {
    let excess = 0.5 * (fit.squares - fit.freedom);
    if excess > 0.0 { MOST_NATS * (1.0 - (-excess / MOST_NATS).exp()) } else { excess }
}

fn moving<'a>(windows: &'a [Window], fits: &'a [WindowFit]) -> impl Iterator<Item = &'a WindowFit> {
    windows.iter().zip(fits).filter(|(window, _)| window.moves).map(|(_, fit)| fit)
}

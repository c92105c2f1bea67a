//! How well a hypothesis follows the measurement over windows.

use super::window_fit::WindowFit;
use crate::limits::{LEFT_OUT, MOST_NATS};

/// Root mean square error over windows, in standard deviations of the noise; 1 is perfect.
/// `None` without windows.
pub fn windowed_error(fits: &[WindowFit]) -> Option<f64> {
    let mut reduced = fits.iter().map(WindowFit::reduced).collect::<Vec<_>>();
    if reduced.is_empty() {
        return None;
    }
    reduced.sort_by(f64::total_cmp);
    let kept = reduced.len() - (LEFT_OUT * reduced.len() as f64).floor() as usize;
    Some((reduced[..kept].iter().sum::<f64>() / kept as f64).sqrt())
}

/// Share of the windows with more error than noise leaves.
pub fn poor_share(fits: &[WindowFit]) -> f64 {
    let poor = fits.iter().filter(|fit| fit.is_poor()).count();
    if fits.is_empty() { 0.0 } else { poor as f64 / fits.len() as f64 }
}

/// Excess of the share of missed windows among those held out over that among those fitted, in standard deviations.
///
/// Both are taken for samples of one population. Its share is estimated with one missed and one followed window more than
/// there are: a few windows of which none is missed do not make it zero. 0 without windows of either kind.
pub fn more_poor_held_out_sd(fitted: &[WindowFit], held_out: &[WindowFit]) -> f64 {
    if fitted.is_empty() || held_out.is_empty() {
        return 0.0;
    }
    let [n, m] = [fitted, held_out].map(|fits| fits.len() as f64);
    let [p, q] = [fitted, held_out].map(poor_share);
    let all = (p * n + q * m + 1.0) / (n + m + 2.0);
    (q - p) / (all * (1.0 - all) * (1.0 / n + 1.0 / m)).sqrt()
}

/// What the windows say against a hypothesis, in natural logarithms of likelihood: half the squared error above that of
/// noise, bounded for each window, so that no window decides alone.
pub fn nats(fits: &[WindowFit]) -> f64 {
    fits.iter().map(nats_of).sum()
}

/// The same for one window.
fn nats_of(fit: &WindowFit) -> f64 {
    let excess = 0.5 * (fit.squares - fit.freedom);
    if excess > 0.0 { MOST_NATS * (1.0 - (-excess / MOST_NATS).exp()) } else { excess }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_some_windows_far_off_show_in_their_share_and_hardly_in_the_error() {
        let window = |reduced: f64| WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let fits = [vec![window(1.0); 88], vec![window(4.0); 12]].concat();
        // Ten of the twelve are left out: √((88 + 2·4)/90).
        let error = windowed_error(&fits).expect("windows");
        assert!((error - (96.0_f64 / 90.0).sqrt()).abs() < 1e-15, "{error}");
        assert_eq!(poor_share(&fits), 0.12);
        // 1 + 5 √(2/200) is the limit.
        assert_eq!(poor_share(&[window(1.49), window(1.51)]), 0.5);
        assert_eq!(poor_share(&[]), 0.0);
    }

    #[test]
    fn analytic_windows_missed_among_those_held_out_alone_are_no_chance() {
        let window = |reduced: f64| WindowFit { x: vec![0.0; 4], squares: 200.0 * reduced, freedom: 200.0 };
        let windows =
            |poor: usize, of: usize| [vec![window(4.0); poor], vec![window(1.0); of - poor]].concat();
        let sd = |fitted: Vec<_>, held_out: Vec<_>| more_poor_held_out_sd(&fitted, &held_out);
        // 8 of 67 and 0 of 120: p = 9/189, 0.1194/√(p (1 − p)(1/67 + 1/120)).
        assert!((sd(windows(0, 120), windows(8, 67)) - 3.6764).abs() < 1e-4);
        assert!(sd(windows(8, 120), windows(1, 67)) < 0.0);
        assert_eq!(sd(windows(0, 120), Vec::new()), 0.0);
        assert_eq!(sd(windows(0, 120), windows(0, 67)), 0.0);
    }
}

//! What a window costs a fit, and how well a hypothesis follows the measurement over windows.
//!
//! Some windows hold an impact decided by less than the noise: the true model misses them too. So losses bound what one
//! window can cost, ever more closely as a fit goes on. At first they are multiples of the squared noise: S/(1 + S/c) for
//! the reduced chi-square S (Geman and McClure). A model far from the truth then still feels every window. At last they
//! are likelihoods: no window that no model follows outweighs what the others say.

use super::window_fit::WindowFit;
use crate::limits::{LEFT_OUT, MIDDLE_BOUND, MOST_NATS};

/// Bounds in squared noise, but for the first.
const FIRST_BOUND: f64 = 20.0;
const NEAR_BOUND: f64 = 3.0;
/// Bound of the last loss, in squared error above that of noise: twice what a window can say at most.
const LAST_EXCESS: f64 = 2.0 * MOST_NATS;

/// What a window costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loss {
    /// Bounded by this many times the squared noise.
    Noise(f64),
    /// Bounded in likelihood.
    Likelihood,
}

impl Loss {
    /// The last loss but one.
    pub const NEAR: Loss = Loss::Noise(NEAR_BOUND);

    /// The loss between the widest and the last but one.
    pub const MIDDLE: Loss = Loss::Noise(MIDDLE_BOUND);
    /// The losses that follow the widest, in the order a fit goes through them.
    pub const NARROWING: [Loss; 3] = [Loss::MIDDLE, Loss::NEAR, Loss::Likelihood];

    /// The loss a fit begins with: one that two thirds of the windows lie well inside.
    pub fn widest(reduced: Vec<f64>) -> Loss {
        Loss::Noise((3.0 * two_thirds(reduced)).max(FIRST_BOUND))
    }

    /// The loss in which starts from such windows are compared. A gap far above the noise must not leave every start
    /// at the bound.
    pub fn of_starts(reduced: Vec<f64>) -> Loss {
        Loss::Noise((3.0 * two_thirds(reduced)).max(NEAR_BOUND))
    }

    /// Whether the losses that follow the widest let go of more than a third of windows with these.
    pub fn let_go_of_many(reduced: Vec<f64>) -> bool {
        two_thirds(reduced) > MIDDLE_BOUND
    }

    /// The loss of a window; its squares where they are those of noise.
    pub fn of(self, fit: &WindowFit) -> f64 {
        match self {
            Loss::Noise(bound) => fit.squares / (1.0 + fit.reduced() / bound),
            Loss::Likelihood => {
                let excess = (fit.squares - fit.freedom).max(0.0);
                fit.squares.min(fit.freedom) + excess / (1.0 + excess / LAST_EXCESS)
            }
        }
    }

    /// Its slope: the weight of a window in least squares.
    pub fn weight(self, fit: &WindowFit) -> f64 {
        match self {
            Loss::Noise(bound) => (1.0 + fit.reduced() / bound).powi(-2),
            Loss::Likelihood => (1.0 + (fit.squares - fit.freedom).max(0.0) / LAST_EXCESS).powi(-2),
        }
    }
}

/// The squared noise that two thirds of the windows lie within.
fn two_thirds(mut reduced: Vec<f64>) -> f64 {
    reduced.sort_by(f64::total_cmp);
    reduced.get(reduced.len() * 2 / 3).copied().unwrap_or(1.0)
}

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
/// Both are taken for samples of one population. Its share is estimated with one missed and one followed window more
/// than there are. So a few windows of which none is missed do not make it zero. It is 0 without windows of either
/// kind.
pub fn more_poor_held_out_sd(fitted: &[WindowFit], held_out: &[WindowFit]) -> f64 {
    if fitted.is_empty() || held_out.is_empty() {
        return 0.0;
    }
    let [n, m] = [fitted, held_out].map(|fits| fits.len() as f64);
    let [p, q] = [fitted, held_out].map(poor_share);
    let all = (p * n + q * m + 1.0) / (n + m + 2.0);
    (q - p) / (all * (1.0 - all) * (1.0 / n + 1.0 / m)).sqrt()
}

/// What the windows say against a hypothesis, in natural logarithms of likelihood. It is half the squared error above
/// that of noise. Each window is bounded, so that none decides alone.
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
    fn analytic_losses_let_go_of_many_where_more_than_a_third_lie_beyond_them() {
        let windows = |far: usize| [vec![1.0; 30 - far], vec![50.0; far]].concat();
        assert!(!Loss::let_go_of_many(windows(9)));
        assert!(Loss::let_go_of_many(windows(11)));
        assert!(!Loss::let_go_of_many(vec![7.9; 30]) && !Loss::let_go_of_many(Vec::new()));
    }

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

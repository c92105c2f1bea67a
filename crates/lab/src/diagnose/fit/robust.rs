//! Losses that let go of windows no model follows.
//!
//! Some windows hold an impact decided by less than the noise: the true model misses them too. A fit goes through losses
//! that bound ever more closely what one window can cost: first in multiples of the squared noise (with S the reduced
//! chi-square, S/(1 + S/c), Geman and McClure), so that a model far from the truth still feels every window; at last in
//! likelihood, so that no window that is lost for good outweighs what the others say.

use super::window_fit::WindowFit;
use crate::limits::{MIDDLE_BOUND, MOST_NATS};

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

    /// The loss in which starts are compared that set out from windows with these: a gap far above the noise must not leave
    /// every start at the bound.
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
}

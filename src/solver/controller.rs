//! Choosing the step: as long as the estimated error of the positions allows.

use super::dormand_prince::Step;

/// What an error is measured against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorScale {
    /// Size of each position, in its unit.
    pub position: [f64; 2],
    /// Time in which an error of velocity becomes one of position, s.
    pub time_s: f64,
}

/// Keeps the error of each step below a bound and proposes the length of the next.
#[derive(Debug, Clone, Copy)]
pub struct Controller {
    scale: ErrorScale,
    bound: f64,
    proposed_s: f64,
}

/// The controller aims below the bound, so that most steps are kept.
const SAFETY: f64 = 0.9;
/// Changes of step beyond these factors would trust the estimate further than it reaches.
const LEAST_FACTOR: f64 = 0.2;
const MOST_FACTOR: f64 = 5.0;
/// The estimate is that of the method of order 4, so it falls with the fifth power of the step.
const ESTIMATE_ORDER: f64 = 5.0;

impl Controller {
    /// Keeps the scaled error of a step below `bound`, starting from a proposed step.
    pub fn new(scale: ErrorScale, bound: f64, first_s: f64) -> Self {
        Self { scale, bound, proposed_s: first_s }
    }

    /// Length for the next step with `remaining_s` to go: the proposal, or equal parts of what remains.
    #[inline]
    pub fn next_s(&self, remaining_s: f64) -> f64 {
        if remaining_s <= self.proposed_s {
            return remaining_s;
        }
        remaining_s / (remaining_s / self.proposed_s).ceil()
    }

    /// Scaled error of a step, in units of the bound.
    #[inline]
    fn error(&self, step: &Step) -> f64 {
        let of = |i: usize| {
            let position = step.position_error[i].abs().max(step.velocity_error[i].abs() * self.scale.time_s);
            position / self.scale.position[i]
        };
        f64::max(of(0), of(1)) / self.bound
    }

    /// Whether a step may be kept; proposes the next length either way.
    #[inline]
    pub fn accepts(&mut self, step: &Step) -> bool {
        let error = self.error(step);
        if error <= 1.0 {
            let whole = step.h >= 0.99 * self.proposed_s;
            // A step cut short by a sample or an event says nothing against a longer one; it may speak for one.
            if whole || error < (SAFETY * step.h / self.proposed_s).powi(5) {
                self.proposed_s = step.h * (SAFETY * error.powf(-1.0 / ESTIMATE_ORDER)).min(MOST_FACTOR);
            }
            return true;
        }
        // A NaN is an error too large to measure.
        let factor = SAFETY * error.powf(-1.0 / ESTIMATE_ORDER);
        self.proposed_s = step.h * if factor.is_nan() { LEAST_FACTOR } else { factor.max(LEAST_FACTOR) };
        false
    }
}

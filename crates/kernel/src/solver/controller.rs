//! Choosing the step: as long as the estimated error of the positions allows.

use wide::f64x2;

use super::nystrom::Step;

/// What an error is measured against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorScale {
    /// Size of each position, in its unit.
    pub position: [f64; 2],
    /// Time in which an error of velocity becomes one of position, s.
    pub time_s: f64,
    /// Rate at which the motion can change: of its fastest oscillation or decay, 1/s.
    pub fastest_rate_per_s: f64,
}

/// Keeps the error of each step below a bound and proposes the length of the next.
#[derive(Debug, Clone, Copy)]
pub struct Controller {
    /// Errors per position: one over its size and the bound.
    per_position: f64x2,
    time_s: f64,
    fastest_rate_per_s: f64,
    proposed_s: f64,
}

/// The controller aims below the bound, so that most steps are kept.
const SAFETY: f64 = 0.9;
/// Changes of step beyond these factors would trust the estimate further than it reaches.
const LEAST_FACTOR: f64 = 0.2;
const MOST_FACTOR: f64 = 5.0;
/// The estimate falls with this power of the step: the fifth of the embedded method, and one more (see `error`).
const ESTIMATE_ORDER: i32 = 6;

impl Controller {
    /// Keeps the scaled error of a step below `bound`, starting from a proposed step.
    pub fn new(scale: ErrorScale, bound: f64, first_s: f64) -> Self {
        Self {
            per_position: f64x2::ONE / (f64x2::new(scale.position) * bound),
            time_s: scale.time_s,
            fastest_rate_per_s: scale.fastest_rate_per_s,
            proposed_s: first_s,
        }
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
    ///
    /// The difference of both methods is the error of the lower order. That of the step that is kept is
    /// smaller by (h r)² where accelerations do not depend on velocities. Where they do it is smaller by h r,
    /// with r the fastest rate of the motion. One factor h r is taken. On walls of the survey errors are 0.01
    /// to 0.15 of this estimate (`benches/work_precision.rs`). This holds over three orders of magnitude of
    /// steps, with dampers of 5 % and without.
    #[inline]
    fn error(&self, step: &Step) -> f64 {
        let [x, v] = [step.position_error, step.velocity_error].map(|e| f64x2::new(e).abs());
        let [first, second] = (x.max(v * self.time_s) * self.per_position).to_array();
        f64::max(first, second) * (step.h * self.fastest_rate_per_s).min(1.0)
    }

    /// Whether a step may be kept; proposes the next length either way.
    #[inline]
    pub fn accepts(&mut self, step: &Step) -> bool {
        let error = self.error(step);
        if error <= 1.0 {
            let whole = step.h >= 0.99 * self.proposed_s;
            // A step cut short by a sample or an event says nothing against a longer one. It may speak for
            // one, up to the most that would be trusted anyhow.
            let longer = self.proposed_s < MOST_FACTOR * step.h
                && error < (SAFETY * step.h / self.proposed_s).powi(ESTIMATE_ORDER);
            if whole || longer {
                self.proposed_s =
                    step.h * (SAFETY * error.powf(-1.0 / f64::from(ESTIMATE_ORDER))).min(MOST_FACTOR);
            }
            return true;
        }
        // A NaN is an error too large to measure.
        let factor = SAFETY * error.powf(-1.0 / f64::from(ESTIMATE_ORDER));
        self.proposed_s = step.h * if factor.is_nan() { LEAST_FACTOR } else { factor.max(LEAST_FACTOR) };
        false
    }
}

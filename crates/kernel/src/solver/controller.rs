//! Choosing the step: as long as the estimated error of the positions allows.

use std::ops::Mul;

use fearless_simd::{Select, SimdMask};
use wide::f64x2;

use super::nystrom::Step;
use crate::lanes::{LANES, Numbers, Wide};
use crate::model::number::Number;

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
/// Seven sixths of the exponent of one, as bits, less what halves the first error of the root.
const SEVEN_SIXTHS: u64 = (0x3ff_u64 << 52) / 6 * 7 - (1_u64 << 52) / 18;

/// Below it numbers have a fraction.
const MOST_WITH_FRACTION: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// The power with which the estimate falls: the fifth of the embedded method, and one more (see `error`).
#[inline(always)]
fn to_estimate_order<N: Copy + Mul<Output = N>>(ratio: N) -> N {
    let square = ratio * ratio;
    square * (square * square)
}

/// x^(-1/6) to a ten-thousandth, of a positive number: a sixth of the exponent, and two of Newton's corrections. The library's power
/// would take longer than a stage of the step, and is not the same on every machine.
#[inline]
fn inverse_sixth_root(x: f64) -> f64 {
    corrected(x, corrected(x, near_inverse_sixth_root(x)))
}

/// The same of several numbers side by side.
#[inline(always)]
fn inverse_sixth_roots<F: Wide>(x: F) -> F {
    corrected(x, corrected(x, F::of_each(x.token(), |i| near_inverse_sixth_root(x[i]))))
}

#[inline(always)]
fn near_inverse_sixth_root(x: f64) -> f64 {
    f64::from_bits(SEVEN_SIXTHS.wrapping_sub(x.to_bits() / 6))
}

#[inline(always)]
fn corrected<N: Number>(x: N, root: N) -> N {
    root * (root.constant(7.0) - x * to_estimate_order(root)) / root.constant(6.0)
}

/// Below this error the length grows by [`MOST_FACTOR`]: nine tenths of (SAFETY / MOST_FACTOR)⁶, for the power's roundings.
const ERROR_OF_MOST: f64 = 3.06e-5;

/// The length proposed after a step that was kept, s.
#[inline]
fn longer_s(h: f64, error: f64) -> f64 {
    if error < ERROR_OF_MOST {
        return h * MOST_FACTOR;
    }
    h * (SAFETY * inverse_sixth_root(error)).min(MOST_FACTOR)
}

/// The length proposed after a step that was not kept, s. A NaN is an error too large to measure.
#[inline]
fn shorter_s(h: f64, error: f64) -> f64 {
    let factor = SAFETY * inverse_sixth_root(error);
    h * if factor.is_nan() { LEAST_FACTOR } else { factor.max(LEAST_FACTOR) }
}

/// The next whole number, as `ceil` has it. That is a call of a library on processors that may lack SSE4.1.
#[inline]
fn whole_parts(ratio: f64) -> f64 {
    if ratio.is_nan() || ratio.abs() >= MOST_WITH_FRACTION {
        return ratio;
    }
    let whole = ratio as i64 as f64;
    if whole < ratio { whole + 1.0 } else { whole }
}

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

    /// Proposes less than before a step that was kept, whose small error says nothing: it may have proposed the most.
    pub fn shorten(&mut self) {
        self.proposed_s *= LEAST_FACTOR / MOST_FACTOR;
    }

    /// Length for the next step with `remaining_s` to go: the proposal, or equal parts of what remains.
    #[inline]
    pub fn next_s(&self, remaining_s: f64) -> f64 {
        if remaining_s <= self.proposed_s {
            return remaining_s;
        }
        remaining_s / whole_parts(remaining_s / self.proposed_s)
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
                && error * to_estimate_order(self.proposed_s) < to_estimate_order(SAFETY * step.h);
            if whole || longer {
                self.proposed_s = longer_s(step.h, error);
            }
            return true;
        }
        self.proposed_s = shorter_s(step.h, error);
        false
    }
}

/// The controllers of several motions, number by number; the same sums as in [`Controller`].
#[derive(Debug, Default)]
pub(crate) struct ErrorRow {
    per_position: [Numbers; 2],
    time_s: Numbers,
    fastest_rate_per_s: Numbers,
    proposed_s: Numbers,
}

impl ErrorRow {
    /// Puts a controller in a lane.
    pub fn put(&mut self, i: usize, controller: &Controller) {
        let [first, second] = controller.per_position.to_array();
        self.per_position[0][i] = first;
        self.per_position[1][i] = second;
        self.time_s[i] = controller.time_s;
        self.fastest_rate_per_s[i] = controller.fastest_rate_per_s;
        self.proposed_s[i] = controller.proposed_s;
    }

    /// Tells a controller what its lane proposes by now.
    pub fn tell(&self, i: usize, controller: &mut Controller) {
        controller.proposed_s = self.proposed_s[i];
    }

    /// As [`Controller::error`].
    #[inline(always)]
    pub fn of<F: Wide>(&self, position: [F; 2], velocity: [F; 2], h: F) -> F {
        let of = |numbers: &Numbers| F::of_row(h.token(), numbers);
        let time_s = of(&self.time_s);
        let along =
            |i: usize| position[i].abs().max_precise(velocity[i].abs() * time_s) * of(&self.per_position[i]);
        along(0).max_precise(along(1)) * (h * of(&self.fastest_rate_per_s)).min_precise(1.0)
    }

    /// As [`Controller::accepts`] proposes, of steps that it does accept.
    #[inline(always)]
    pub fn propose<F: Wide>(&mut self, accepted: F::Mask, error: F, h: F) {
        let proposed_s = F::of_row(h.token(), &self.proposed_s);
        let whole = h.simd_ge(proposed_s * 0.99);
        let below_most = proposed_s.simd_lt(h * MOST_FACTOR);
        if !(accepted & (whole | below_most)).any_true() {
            return;
        }
        let longer =
            below_most & (error * to_estimate_order(proposed_s)).simd_lt(to_estimate_order(h * SAFETY));
        let changes = accepted & (whole | longer);
        if changes.any_true() {
            let by_error = h * (inverse_sixth_roots(error) * SAFETY).min_precise(MOST_FACTOR);
            let longer_s = error.simd_lt(ERROR_OF_MOST).select(h * MOST_FACTOR, by_error);
            changes.select(longer_s, proposed_s).put(&mut self.proposed_s);
        }
    }

    /// As [`Controller::accepts`] proposes, of steps that it does not accept.
    #[cold]
    pub fn propose_shorter(&mut self, which: u64, error: &Numbers, h: &Numbers) {
        for i in (0..LANES).filter(|i| which >> i & 1 == 1) {
            self.proposed_s[i] = shorter_s(h[i], error[i]);
        }
    }

    /// As [`Controller::next_s`].
    #[inline(always)]
    pub fn next_s<F: Wide>(&self, remaining_s: F) -> F {
        let proposed_s = F::of_row(remaining_s.token(), &self.proposed_s);
        let fits = remaining_s.simd_le(proposed_s);
        if fits.all_true() {
            return remaining_s;
        }
        // Two parts need no division, and are most that there are. No quotient of a larger number rounds to one.
        if remaining_s.simd_le(proposed_s * 2.0).all_true() {
            return fits.select(remaining_s, remaining_s * 0.5);
        }
        let parts = (remaining_s / proposed_s).ceil();
        fits.select(remaining_s, remaining_s / parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instructions::{dispatch_lanes, lanes_pay};
    use fearless_simd::Level;

    #[test]
    fn analytic_a_sixth_root_without_a_power() {
        for exponent in -300..300 {
            for x in [1.0, 1.7, 2.3, 5.0].map(|digits| digits * 10.0_f64.powi(exponent)) {
                let error = inverse_sixth_root(x) / x.powf(-1.0 / 6.0) - 1.0;
                assert!(error.abs() < 1e-4, "{error:e} at {x:e}");
            }
        }
    }

    #[inline(always)]
    fn next_side_by_side<F: Wide>(simd: F::Token, errors: &ErrorRow, remaining_s: &Numbers) -> Vec<f64> {
        errors.next_s(F::of_row(simd, remaining_s)).as_slice().to_vec()
    }

    #[test]
    fn analytic_lengths_side_by_side_have_the_bits_of_each() {
        let level = Level::new();
        if !lanes_pay(level) {
            return;
        }
        let scale = ErrorScale { position: [1.0; 2], time_s: 1.0, fastest_rate_per_s: 1.0 };
        // Whole parts of a proposal and a rounding to either side, and lengths between.
        let parts = (1..6).flat_map(|parts: u32| {
            let whole = f64::from(parts) * 0.0037;
            [whole.next_down(), whole, whole.next_up(), 0.7 * whole, 1.3 * whole]
        });
        let parts: Vec<f64> = parts.collect();
        for remaining_s in parts.windows(LANES) {
            for only in 0..=LANES {
                // Alone beside lengths of a whole proposal, and all of them.
                let length_s = |i: usize| if only == LANES || only == i { remaining_s[i] } else { 0.0037 };
                let asked = Numbers(std::array::from_fn(length_s));
                let controller = Controller::new(scale, 1.0, 0.0037);
                let mut errors = ErrorRow::default();
                (0..LANES).for_each(|i| errors.put(i, &controller));
                let found = [
                    dispatch_lanes!(level, Four of f64x4, simd => next_side_by_side::<Four<_>>(simd, &errors, &asked)),
                    dispatch_lanes!(level, Most of f64x8, simd => next_side_by_side::<Most<_>>(simd, &errors, &asked)),
                ];
                let expected = asked.map(|length_s| controller.next_s(length_s));
                assert!(found.iter().all(|found| *found == expected[..found.len()]), "{asked:?}");
            }
        }
    }

    #[test]
    fn analytic_lengths_grow_as_the_error_says() {
        // Just below where the power is not needed, and where it is.
        for error in [1e-12, 3.05e-5, 3.07e-5, 1e-3, 0.5] {
            let expected = (SAFETY * f64::powf(error, -1.0 / 6.0)).min(MOST_FACTOR);
            assert!((longer_s(2.0, error) / (2.0 * expected) - 1.0).abs() < 1e-4, "at {error:e}");
        }
    }
}

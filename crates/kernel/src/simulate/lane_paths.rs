//! The paths of the walls of a row over their steps: quintics in Bernstein form, whose coefficients bound them.

use super::lane_steps::Landed;
use super::row::MovingRow;
use crate::lanes::{Numbers, Wide};

/// Bernstein coefficients of the quintics through both ends of the steps, as [`crate::solver::Quintic`] has them.
#[inline(always)]
pub(super) fn hermite<F: Wide>([x0, v0, a0]: [F; 3], [x1, v1, a1]: [F; 3], [h_5, hh_20]: [F; 2]) -> [F; 6] {
    let (v0, v1) = (v0 * h_5, v1 * h_5);
    [x0, x0 + v0, x0 + v0 * 2.0 + a0 * hh_20, x1 - v1 * 2.0 + a1 * hh_20, x1 - v1, x1]
}

#[inline(always)]
pub(super) fn bound<F: Wide>(c: &[F; 6]) -> F {
    let [first, second] = [c[0].abs().max(c[1].abs()), c[2].abs().max(c[3].abs())];
    first.max(second).max(c[4].abs().max(c[5].abs()))
}

/// Whether a gap keeps to its side for sure, as [`crate::solver::Quintic::keep_to`] says.
#[inline(always)]
pub(super) fn keeps_to<F: Wide>(side: F, c: &[F; 6]) -> F::Mask {
    let at = [c[1] * side, c[2] * side, c[3] * side, c[4] * side, c[5] * side];
    let least = at[1].min(at[2].min(at[3])).min(at[4]) + (-side.abs() + 1.0);
    least.simd_gt(0.0) & (c[0] * side).min(at[0]).simd_ge(0.0)
}

impl MovingRow {
    /// Position, velocity and acceleration of a body.
    #[inline(always)]
    fn start<F: Wide>(&self, simd: F::Token, i: usize) -> [F; 3] {
        let of = |numbers: &Numbers| F::of_row(simd, numbers);
        [of(&self.position[i]), of(&self.velocity[i]), of(&self.acceleration[i])]
    }

    /// The path of a body over the steps.
    #[inline(always)]
    pub fn path<F: Wide>(&self, i: usize, landed: &Landed<F>, scale: [F; 2]) -> [F; 6] {
        hermite(self.start(scale[0].token(), i), landed.end(i), scale)
    }

    /// The path of the upper body beside the lower one, from the differences at the ends.
    #[inline(always)]
    pub fn opening_of_crack<F: Wide>(&self, landed: &Landed<F>, scale: [F; 2]) -> [F; 6] {
        let simd = scale[0].token();
        let apart = |first: [F; 3], second: [F; 3]| {
            [second[0] - first[0], second[1] - first[1], second[2] - first[2]]
        };
        let start = apart(self.start(simd, 0), self.start(simd, 1));
        hermite(start, apart(landed.end(0), landed.end(1)), scale)
    }
}

impl<F: Wide> Landed<F> {
    #[inline(always)]
    fn end(&self, i: usize) -> [F; 3] {
        [self.position[i], self.velocity[i], self.acceleration[i]]
    }

    /// A number only where all of the end of a body are.
    #[inline(always)]
    pub fn sum(&self, i: usize) -> F {
        let [position, velocity, acceleration] = self.end(i);
        position + velocity + acceleration
    }
}

/// By what velocities and accelerations enter the coefficients.
#[inline(always)]
pub(super) fn scale<F: Wide>(h: F) -> [F; 2] {
    [h / 5.0, h * h / 20.0]
}

/// Value at a share of the steps, as [`crate::solver::Bernstein::value`] has it.
#[inline(always)]
pub(super) fn value<F: Wide>(mut c: [F; 6], share: F) -> F {
    for width in (1..6).rev() {
        for i in 0..width {
            c[i] = c[i] + share * (c[i + 1] - c[i]);
        }
    }
    c[0]
}

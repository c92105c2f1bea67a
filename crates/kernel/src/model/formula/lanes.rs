//! The formulas of walls side by side: each lane asks its own, one after another, between what lanes do at once.

use fearless_simd::{Select, Simd, SimdBase, SimdMask, f64x4, mask64x4};

use super::laws::{FormulaLaws, NO_MOMENTS};
use crate::lanes::{LANES, lanes};

type F<S> = f64x4<S>;

/// The formulas of the walls of a row.
pub(crate) type FormulaRow = [FormulaLaws; LANES];

/// The same while the walls step.
pub(in crate::model) struct FormulaLanes<S: Simd> {
    of: FormulaRow,
    /// The lanes that have any.
    written: mask64x4<S>,
    any: bool,
    at_joints: bool,
}

impl<S: Simd> FormulaLanes<S> {
    #[inline(always)]
    pub fn new(simd: S, of: FormulaRow) -> Self {
        let written = lanes(simd, |i| f64::from(u8::from(!of[i].is_empty()))).simd_eq(1.0);
        let at_joints = of.iter().any(FormulaLaws::act_at_joints);
        Self { any: written.any_true(), of, written, at_joints }
    }

    pub fn into_row(self) -> FormulaRow {
        self.of
    }

    /// A force at the top and that of formulas, N, at displacements in m and velocities in m/s.
    #[inline(always)]
    pub fn with_top_force_n(&self, force_n: F<S>, x_c_m: F<S>, v_c_m_s: F<S>) -> F<S> {
        if !self.any {
            return force_n;
        }
        let written_n = self.top_forces_n(x_c_m.into(), v_c_m_s.into());
        self.written.select(force_n + lanes(force_n.simd, |i| written_n[i]), force_n)
    }

    /// Moments on θ_1 and θ_2 and those of formulas, N m.
    #[inline(always)]
    pub fn with_joint_moments_n_m(
        &self,
        moments_n_m: [F<S>; 2],
        theta: impl Fn() -> [F<S>; 2],
        omega: [F<S>; 2],
    ) -> [F<S>; 2] {
        if !self.any {
            return moments_n_m;
        }
        let written_n_m = match self.at_joints {
            true => self.joint_moments_n_m(theta().map(Into::into), omega.map(Into::into)),
            false => [NO_MOMENTS; LANES],
        };
        let with = |j: usize| {
            let sum = moments_n_m[j] + lanes(omega[j].simd, |i| written_n_m[i][j]);
            self.written.select(sum, moments_n_m[j])
        };
        [with(0), with(1)]
    }

    #[inline(never)]
    fn top_forces_n(&self, x_c_m: [f64; LANES], v_c_m_s: [f64; LANES]) -> [f64; LANES] {
        std::array::from_fn(|i| match self.of[i].is_empty() {
            true => 0.0,
            false => self.of[i].top_force_n(x_c_m[i], v_c_m_s[i]),
        })
    }

    #[inline(never)]
    fn joint_moments_n_m(&self, theta: [[f64; LANES]; 2], omega: [[f64; LANES]; 2]) -> [[f64; 2]; LANES] {
        let both = |of: &[[f64; LANES]; 2], i: usize| [of[0][i], of[1][i]];
        std::array::from_fn(|i| self.of[i].joint_moments_n_m(|| both(&theta, i), both(&omega, i)))
    }
}

/// Angles by their sines and cosines, as [`super::super::motion::Configuration`] has them.
#[inline(never)]
pub(in crate::model) fn angles(sin: [f64; LANES], cos: [f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|i| sin[i].atan2(cos[i]))
}

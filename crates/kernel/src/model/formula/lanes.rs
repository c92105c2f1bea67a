//! The formulas of walls side by side: at once where all have the same, as windows of one hypothesis do; else each lane asks its own,
//! one after another, between what lanes do at once. Both give the same bits.

use std::sync::Arc;

use fearless_simd::{Select, Simd, SimdMask};

use super::super::contact::Joint;
use super::law::FormulaLaw;
use super::laws::{FormulaLaws, NO_MOMENTS};
use crate::lanes::{LANES, Numbers, Wide};

/// The formulas of the walls of a row.
pub(crate) type FormulaRow = [FormulaLaws; LANES];

/// The same while the walls step.
pub(in crate::model) struct FormulaLanes<F: Wide> {
    of: FormulaRow,
    /// The lanes that have any.
    written: F::Mask,
    any: bool,
    at_joints: bool,
    asks_rotations: bool,
    /// The first lane that has any, where all that have any have the same.
    alike: Option<usize>,
}

/// The first wall that has formulas, where all that have any have the same: these differ by branches and by what they remember.
#[inline(always)]
fn alike(of: &FormulaRow) -> Option<usize> {
    let first = of.iter().position(|laws| !laws.is_empty())?;
    let same = |laws: &FormulaLaws| {
        let pairs = || laws.laws.iter().zip(&of[first].laws);
        laws.is_empty()
            || laws.laws.len() == of[first].laws.len()
                && pairs().all(|(one, other)| Arc::ptr_eq(&one.program, &other.program))
    };
    of.iter().all(same).then_some(first)
}

impl<F: Wide> FormulaLanes<F> {
    #[inline(always)]
    pub fn new(simd: F::Token, of: FormulaRow) -> Self {
        let written = F::of_each(simd, |i| f64::from(u8::from(!of[i].is_empty()))).simd_eq(1.0);
        let at_joints = of.iter().any(FormulaLaws::act_at_joints);
        let asks_rotations = of.iter().any(FormulaLaws::ask_rotations);
        Self { any: written.any_true(), alike: alike(&of), of, written, at_joints, asks_rotations }
    }

    /// The lanes that have any; `None` where none does.
    #[inline(always)]
    pub fn written(&self) -> Option<F::Mask> {
        self.any.then_some(self.written)
    }

    pub fn into_row(self) -> FormulaRow {
        self.of
    }

    /// A force at the top and that of formulas, N, at displacements in m and velocities in m/s.
    #[inline(always)]
    pub fn with_top_force_n(&self, force_n: F, x_c_m: F, v_c_m_s: F) -> F {
        if !self.any {
            return force_n;
        }
        self.written.select(force_n + self.top_forces_n(x_c_m, v_c_m_s), force_n)
    }

    /// Moments on θ_1 and θ_2 and those of formulas, N m.
    #[inline(always)]
    pub fn with_joint_moments_n_m(
        &self,
        moments_n_m: [F; 2],
        theta: impl Fn() -> [F; 2],
        omega: [F; 2],
    ) -> [F; 2] {
        if !self.any {
            return moments_n_m;
        }
        let all = |number: f64| F::splat(omega[0].token(), number);
        let written_n_m = match (self.at_joints, self.asks_rotations) {
            (true, true) => self.joint_moments_n_m(theta(), omega),
            // Angles cost more than most formulas.
            (true, false) => self.joint_moments_n_m([all(0.0); 2], omega),
            (false, _) => NO_MOMENTS.map(all),
        };
        let with = |j: usize| self.written.select(moments_n_m[j] + written_n_m[j], moments_n_m[j]);
        [with(0), with(1)]
    }

    #[inline(never)]
    fn top_forces_n(&self, x_c_m: F, v_c_m_s: F) -> F {
        let simd = x_c_m.token();
        let Some(first) = self.alike else {
            let (x_c_m, v_c_m_s) = (x_c_m.numbers(), v_c_m_s.numbers());
            return F::of_each(simd, |i| match self.of[i].is_empty() {
                true => 0.0,
                false => self.of[i].top_force_n(x_c_m[i], v_c_m_s[i]),
            });
        };
        simd.vectorize(
            #[inline(always)]
            || self.sum_of_alike(first, None, x_c_m, v_c_m_s),
        )
    }

    /// [`FormulaLaws::joint_moments_n_m`] of every lane.
    #[inline(never)]
    fn joint_moments_n_m(&self, theta: [F; 2], omega: [F; 2]) -> [F; 2] {
        let simd = omega[0].token();
        let Some(first) = self.alike else {
            let of = |pair: [F; 2]| pair.map(F::numbers);
            let (theta, omega) = (of(theta), of(omega));
            let both = |of: &[Numbers; 2], i: usize| [of[0][i], of[1][i]];
            let moments: [[f64; 2]; LANES] =
                std::array::from_fn(|i| self.of[i].joint_moments_n_m(|| both(&theta, i), both(&omega, i)));
            return [0, 1].map(|j| F::of_each(simd, |i| moments[i][j]));
        };
        simd.vectorize(
            #[inline(always)]
            || {
                let (phi, rate) = (theta[1] - theta[0], omega[1] - omega[0]);
                let ground = self.sum_of_alike(first, Some(Joint::Ground), theta[0], omega[0]);
                let crack = self.sum_of_alike(first, Some(Joint::Crack), phi, rate);
                [ground - crack, crack]
            },
        )
    }

    /// The sum of the formulas that act at a place, N or N m, where all lanes have those of the `first`: in the order of one wall's.
    #[inline(always)]
    fn sum_of_alike(&self, first: usize, joint: Option<Joint>, q: F, rate: F) -> F {
        let simd = q.token();
        let (q, rate) = (self.or_that_of(first, q), self.or_that_of(first, rate));
        // As a sum of numbers begins.
        let mut sum = F::splat(simd, -0.0);
        for (k, law) in self.of[first].laws.iter().enumerate() {
            if law.joint == joint {
                sum += FormulaLaw::values(self.laws_at(k, law), q, rate);
            }
        }
        sum
    }

    /// Numbers of the lanes, that of the `first` in lanes without a wall.
    #[inline(always)]
    fn or_that_of(&self, first: usize, of: F) -> F {
        self.written.select(of, F::splat(of.token(), of.numbers()[first]))
    }

    /// The formula of a number in every lane; that of another wall where a lane has none.
    #[inline(always)]
    fn laws_at<'l>(&'l self, k: usize, other: &'l FormulaLaw) -> [&'l FormulaLaw; LANES] {
        self.of.each_ref().map(|own| own.laws.get(k).unwrap_or(other))
    }
}

/// Angles by their sines and cosines, as [`super::super::sharp::Configuration`] has them.
#[inline(never)]
pub(in crate::model) fn angles<F: Wide>(sin: F, cos: F) -> F {
    F::of_each(sin.token(), |i| sin[i].atan2(cos[i]))
}

//! Which steps of a row are surely free of kinks of the laws at the top.
//!
//! What lies nearer to a kink than the roundings of either way to work it out is left to [`super::events`].

use fearless_simd::Select;

use super::lane_accounts::keep;
use super::lane_paths::{hermite, scale};
use super::lane_steps::Landed;
use super::row::{KinkRow, MovingRow};
use crate::lanes::Wide;

/// Nearer than this share of its size a kink is looked for: a million roundings and more.
const NEAR_KINK: f64 = 1e-9;

impl KinkRow {
    /// Whether the top is far from every kink over the steps.
    #[inline(always)]
    pub fn far<F: Wide>(&self, moving: &MovingRow, before_m_s: F, landed: &Landed<F>, h: F) -> F::Mask {
        let simd = h.token();
        let start = [F::of_row(simd, &self.top_m), before_m_s, F::of_row(simd, &self.top_m_s2)];
        self.between(&hermite(start, landed.reactions.top, scale(h)))
            & self.keeps_moving(moving, start, landed, h)
    }

    /// Whether a path keeps to its branch of the springs. It may start at a kink, where it has just passed one.
    #[inline(always)]
    fn between<F: Wide>(&self, c: &[F; 6]) -> F::Mask {
        let simd = c[0].token();
        let least = c[1].min(c[2]).min(c[3].min(c[4])).min(c[5]);
        let most = c[1].max(c[2]).max(c[3].max(c[4])).max(c[5]);
        let (low, high) = (F::of_row(simd, &self.least_m), F::of_row(simd, &self.most_m));
        let thickness = F::of_row(simd, &self.thickness_m);
        let near = |limit: F| (thickness + limit.abs()) * NEAR_KINK;
        let starts = (c[0] - low).min(high - c[0]).simd_ge(0.0);
        starts & (least - low).simd_gt(near(low)) & (high - most).simd_gt(near(high))
    }

    /// Whether a top that yields or slides goes on to: the cubic through its velocities and accelerations.
    #[inline(always)]
    fn keeps_moving<F: Wide>(
        &self,
        moving: &MovingRow,
        [_, v_0, a_0]: [F; 3],
        landed: &Landed<F>,
        h: F,
    ) -> F::Mask {
        let simd = h.token();
        let [_, v_1, a_1] = landed.reactions.top;
        let c = [v_0, v_0 + h * a_0 / 3.0, v_1 - h * a_1 / 3.0, v_1];
        let [w1, w2] = [&moving.velocity[0], &moving.velocity[1]].map(|w| F::of_row(simd, w).abs());
        let turning = (w1 + w2) + (landed.velocity[0].abs() + landed.velocity[1].abs());
        let near = turning * F::of_row(simd, &self.height_m) * NEAR_KINK;
        let [yields, slides] = [F::of_row(simd, &self.stops[0]), F::of_row(simd, &self.stops[1])];
        goes_on(&c, yields, near) & goes_on(&c, slides, near)
    }

    /// Makes the ends of the steps of some lanes the present.
    #[inline(always)]
    pub fn move_on<F: Wide>(&mut self, done: F::Mask, landed: &Landed<F>) {
        keep(done, &mut self.top_m, landed.reactions.top[0]);
        keep(done, &mut self.top_m_s2, landed.reactions.top[2]);
    }
}

/// Whether a velocity keeps its sign; it may start at zero.
#[inline(always)]
fn goes_on<F: Wide>(c: &[F; 4], sign: F, near: F) -> F::Mask {
    let at = [c[0] * sign, c[1] * sign, c[2] * sign, c[3] * sign];
    let least = at[1].min(at[2]).min(at[3]);
    at[0].simd_ge(0.0) & sign.simd_eq(0.0).select(F::splat(near.token(), f64::MAX), least).simd_gt(near)
}

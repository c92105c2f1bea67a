//! The impacts inside the steps of a row: found in the lanes, where one joint closes once and nothing else happens.
//!
//! The same sums in the same order as in [`super::events`].

use fearless_simd::{Select, SimdMask};

use super::events::ROUNDINGS;
use super::lane_accounts::keep;
use super::lane_impacts::{AT_GROUND, REACHES};
use super::lane_paths::{bound, keeps_to, scale};
use super::lane_steps::Landed;
use super::row::{Row, SumRow};
use crate::lanes::Wide;
use crate::solver::{only_roots, turn_negative_once};

/// The gap that may close inside the steps.
struct Closing<F: Wide> {
    /// Positive where the joint is open.
    path: [F; 6],
    /// Where it starts at zero, up to roundings.
    starts_closed: F::Mask,
    /// Where it is negative at the end, and nothing else happens.
    is_first: F::Mask,
    /// Where it is that at the ground of a wall whose bodies turn apart.
    at_ground: F::Mask,
}

impl<F: Wide> Closing<F> {
    /// Of a gap that is open on a side, and the difference of rotations of this size.
    #[inline(always)]
    fn of(path: &[F; 6], side: F, size: F, is_first: F::Mask, at_ground: F::Mask) -> Self {
        let path =
            [path[0] * side, path[1] * side, path[2] * side, path[3] * side, path[4] * side, path[5] * side];
        // Beyond the rotations' own roundings.
        let rounding = size * (ROUNDINGS * f64::EPSILON);
        let (starts_closed, closes) = (path[0].simd_le(rounding), path[5].simd_lt(-rounding));
        Self { path, starts_closed, is_first: is_first & closes, at_ground }
    }
}

/// A path that starts at zero, over the share of the step: as [`crate::solver::Bernstein::first_root_after_start`] has it.
#[inline(always)]
fn after_start<F: Wide>(c: &[F; 6]) -> [F; 5] {
    [c[1] * 5.0 / 1.0, c[2] * 5.0 / 2.0, c[3] * 5.0 / 3.0, c[4] * 5.0 / 4.0, c[5] * 5.0 / 5.0]
}

impl Row {
    /// Requests steps up to the impacts inside those of some lanes, where nothing else happens.
    #[inline(always)]
    pub fn find_impacts<F: Wide, const AS_ONE: bool>(
        &mut self,
        which: F::Mask,
        landed: &Landed<F>,
    ) -> F::Mask {
        if !which.any_true() {
            return which;
        }
        let simd = landed.position[0].token();
        let all = |value: f64| F::splat(simd, value);
        let h = F::of_row(simd, &self.moving.h);
        let Closing { path, starts_closed, is_first, at_ground } = self.closing::<F, AS_ONE>(landed, h);
        let error = self.errors.of(landed.position_error, landed.velocity_error, h);
        let advances = F::of_row(simd, &self.limits.advances).simd_eq(1.0);
        let alone = which & is_first & advances & error.simd_le(1.0);
        let later = alone & !starts_closed & turn_negative_once(&path);
        let after_start = after_start(&path);
        let again = alone & starts_closed & turn_negative_once(&after_start);
        let found = later | again;
        if !found.any_true() {
            return found;
        }
        let mut share = all(0.0);
        if later.any_true() {
            share = only_roots(later, &path);
        }
        if again.any_true() {
            share = again.select(only_roots(again, &after_start), share);
        }
        self.errors.propose(found, error, h);
        keep(found, &mut self.moving.h, share * h);
        keep(found, &mut self.impacts.most_s, h);
        keep(found, &mut self.impacts.reaches, at_ground.select(all(AT_GROUND), all(REACHES)));
        keep(found, &mut self.limits.advances, all(0.0));
        SumRow::add(found, &mut self.impacts.found, all(1.0));
        found
    }

    /// The gap that closes over the steps, and where none of the others may, and nothing else happens.
    #[inline(always)]
    fn closing<F: Wide, const AS_ONE: bool>(&self, landed: &Landed<F>, h: F) -> Closing<F> {
        let (simd, scale, limits) = (h.token(), scale(h), &self.limits);
        let side = |i: usize| F::of_row(simd, &limits.sides[i]);
        let stands = |i: usize, size: F| size.simd_lt(F::of_row(simd, &limits.collapse_rad[i]));
        let lower = self.moving.path(0, landed, scale);
        let (size, sum) = (bound(&lower), landed.sum(0));
        let finite = sum.simd_eq(sum);
        if AS_ONE {
            let (_, stays_closed) = limits.corner_force(landed.reactions.crack);
            let is_first = finite & stands(0, size) & stands(1, size) & stays_closed;
            return Closing::of(&lower, side(0), size, is_first, <F::Mask>::splat(simd, false));
        }
        let (upper, sum) = (bound(&self.moving.path(1, landed, scale)), landed.sum(1));
        let crack = self.moving.opening_of_crack(landed, scale);
        let keep_to = [keeps_to(side(0), &lower), keeps_to(side(1), &crack)];
        let at_ground = keep_to[1] & !keep_to[0];
        let is_first =
            finite & sum.simd_eq(sum) & stands(0, size) & stands(1, upper) & (keep_to[0] | keep_to[1]);
        let of = |ground: F, crack: F| at_ground.select(ground, crack);
        let path = [
            of(lower[0], crack[0]),
            of(lower[1], crack[1]),
            of(lower[2], crack[2]),
            of(lower[3], crack[3]),
            of(lower[4], crack[4]),
            of(lower[5], crack[5]),
        ];
        Closing::of(&path, of(side(0), side(1)), of(size, upper), is_first, at_ground)
    }
}

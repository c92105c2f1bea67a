//! The accounts of the steps of a row: which of them nothing happened in, what these add up to, and what follows.
//!
//! The same sums in the same order as in [`super::run`] and [`super::totals`], lane by lane. A step in which something
//! may have happened is left to the run, which goes through it by itself.

use fearless_simd::{Select, SimdMask};

use super::events::NEAR_ZERO;
use super::ground_path::LEAST_PIECE;
use super::lane_paths::{bound, keeps_to, scale, value};
use super::lane_steps::{Landed, Stepping};
use super::row::{GroundRow, LimitRow, MovingRow, Row, Samples, SumRow};
use super::run::PROGRESS;
use crate::lanes::{LANES, Numbers, Wide};
use crate::model::Vector;

/// Keeps new numbers of some lanes.
#[inline(always)]
pub(super) fn keep<F: Wide>(which: F::Mask, numbers: &mut Numbers, new: F) {
    which.select(new, F::of_row(new.token(), numbers)).put(numbers);
}

#[inline(always)]
pub(super) fn keep_both<F: Wide>(which: F::Mask, numbers: &mut [Numbers; 2], new: [F; 2]) {
    keep(which, &mut numbers[0], new[0]);
    keep(which, &mut numbers[1], new[1]);
}

/// Whether the paths of both bodies are surely clear of collapse and contact, and whether they may rise above the
/// largest rotations so far.
struct Paths<F: Wide> {
    clear: F::Mask,
    rise: F::Mask,
}

/// What was found of the steps of a row.
struct Settled<F: Wide> {
    h: F,
    error: F,
    to: Onwards<F>,
    rise: F::Mask,
    corner_force: F,
}

/// Where a piece of the record goes on, or the next begins.
struct Onwards<F: Wide> {
    offset_s: F,
    ended: F::Mask,
    /// Number, start and length of the next piece, s.
    piece: F,
    start_s: F,
    length_s: F,
    /// Whether the step is followed by another in the same piece, or in one between samples.
    goes_on: F::Mask,
}

impl GroundRow {
    #[inline(always)]
    fn onwards<F: Wide>(&self, simd: F::Token, h: F) -> Onwards<F> {
        let (length_s, offset_s) = (F::of_row(simd, &self.length_s), F::of_row(simd, &self.offset_s));
        // The end of a piece is reached exactly, not up to a rounding.
        let offset_s = h.simd_eq(length_s - offset_s).select(length_s, offset_s + h);
        let ended = !offset_s.simd_lt(length_s);
        let (piece, step_s) = (F::of_row(simd, &self.piece) + 1.0, F::of_row(simd, &self.step_s));
        let start_s = (F::of_row(simd, &self.origin_s) + piece * step_s).max(F::splat(simd, 0.0));
        let left_s = F::of_row(simd, &self.end_s) - start_s;
        let between_samples = (piece + 1.0).simd_lt(F::of_row(simd, &self.samples));
        let goes_on = !ended | (between_samples & left_s.simd_gt(step_s * LEAST_PIECE));
        Onwards { offset_s, ended, piece, start_s, length_s: step_s.min(left_s), goes_on }
    }

    /// Moves on in some lanes; gives what is left of their pieces, s.
    #[inline(always)]
    fn move_on<F: Wide>(&mut self, done: F::Mask, to: &Onwards<F>, samples: &Samples) -> F {
        let simd = to.start_s.token();
        let ended = done & to.ended;
        let reached_s = to.ended.select(F::splat(simd, 0.0), to.offset_s);
        let offset_s = done.select(reached_s, F::of_row(simd, &self.offset_s));
        offset_s.put(&mut self.offset_s);
        let length_s = ended.select(to.length_s, F::of_row(simd, &self.length_s));
        if !ended.any_true() {
            return length_s - offset_s;
        }
        let at = self.k.map(|k| k + 1);
        let pair = |i: usize| samples[i].get(at[i]..at[i] + 2).unwrap_or(&[Vector { x: 0.0, y: 0.0 }; 2]);
        let pairs: [_; LANES] = std::array::from_fn(|i| if i < F::LEN { pair(i) } else { &[] });
        let per_step = F::of_row(simd, &self.samples_per_s);
        let from = [F::of_each(simd, |i| pairs[i][0].x), F::of_each(simd, |i| pairs[i][0].y)];
        let next = [F::of_each(simd, |i| pairs[i][1].x), F::of_each(simd, |i| pairs[i][1].y)];
        let slope = [(next[0] - from[0]) * per_step, (next[1] - from[1]) * per_step];
        keep_both(ended, &mut self.slope, slope);
        keep_both(ended, &mut self.from, [from[0] + slope[0] * 0.0, from[1] + slope[1] * 0.0]);
        keep(ended, &mut self.start_s, to.start_s);
        length_s.put(&mut self.length_s);
        keep(ended, &mut self.piece, to.piece);
        let bits = ended.to_bitmask();
        self.k = std::array::from_fn(|i| self.k[i] + (bits >> i & 1) as usize);
        length_s - offset_s
    }
}

impl LimitRow {
    #[inline(always)]
    fn paths<F: Wide>(&self, as_one: bool, moving: &MovingRow, landed: &Landed<F>, h: F) -> Paths<F> {
        let simd = h.token();
        let scale = scale(h);
        let lower = moving.path(0, landed, scale);
        let stands = |i: usize, bound: F| bound.simd_lt(F::of_row(simd, &self.collapse_rad[i]));
        let rises = |i: usize, bound: F| bound.simd_gt(F::of_row(simd, &self.theta_max_rad[i]));
        let sides = [F::of_row(simd, &self.sides[0]), F::of_row(simd, &self.sides[1])];
        // What is no number compares to nothing.
        let sum = landed.sum(0);
        let bound_1 = bound(&lower);
        let clear = sum.simd_eq(sum) & stands(0, bound_1) & keeps_to(sides[0], &lower);
        if as_one {
            return Paths { clear: clear & stands(1, bound_1), rise: rises(0, bound_1) | rises(1, bound_1) };
        }
        let (upper, gap) = (moving.path(1, landed, scale), moving.opening_of_crack(landed, scale));
        let sum = landed.sum(1);
        let bound_2 = bound(&upper);
        let clear = clear & sum.simd_eq(sum) & stands(1, bound_2) & keeps_to(sides[1], &gap);
        Paths { clear, rise: rises(0, bound_1) | rises(1, bound_2) }
    }

    /// Smallest corner force of the joint that is closed, over the weight, and whether it surely stays closed.
    #[inline(always)]
    pub fn corner_force<F: Wide>(&self, joint: [F; 3]) -> (F, F::Mask) {
        let (simd, end) = (joint[0].token(), self.least_at_corners(joint));
        let start = F::of_row(simd, &self.corner_force);
        let size = start.abs().max(end.abs()) + (end - start).abs();
        let stays = end.simd_ge(0.0) & start.min(end).simd_gt(size * NEAR_ZERO);
        (end, stays | F::of_row(simd, &self.closed).simd_eq(0.0))
    }

    /// As [`crate::model::RockingWall::smallest_corner_force`] of the joint that is closed.
    #[inline(always)]
    pub fn least_at_corners<F: Wide>(&self, [_, normal, moment]: [F; 3]) -> F {
        let (half, lever) = (normal * 0.5, moment * F::of_row(normal.token(), &self.per_width));
        (half + lever).min_precise(half - lever) * F::of_row(normal.token(), &self.per_weight)
    }

    /// Whether the pivots are under tension as they were.
    #[inline(always)]
    pub fn same_tension<F: Wide>(&self, normals: [F; 2]) -> F::Mask {
        let simd = normals[0].token();
        let none = F::splat(simd, 0.0);
        let now = |normal: F| normal.simd_lt(0.0).select(F::splat(simd, 1.0), none);
        now(normals[0]).simd_eq(F::of_row(simd, &self.tension[0]))
            & now(normals[1]).simd_eq(F::of_row(simd, &self.tension[1]))
    }
}

impl SumRow {
    /// As [`super::totals::Totals::forces`] of one joint.
    #[inline(always)]
    fn force<F: Wide>(&mut self, done: F::Mask, i: usize, [shear, normal]: [F; 2]) {
        let friction = F::of_row(normal.token(), &self.friction[i]);
        let rises = done & normal.simd_gt(0.0) & shear.abs().simd_gt(friction * normal);
        // A division only where the demand does rise.
        if rises.any_true() {
            rises.select(shear.abs() / normal, friction).put(&mut self.friction[i]);
        }
        let compression_n = F::of_row(normal.token(), &self.compression_n[i]);
        keep(done, &mut self.compression_n[i], compression_n.max_precise(normal));
    }

    /// As [`super::totals::Totals::top`].
    #[inline(always)]
    fn top<F: Wide>(&mut self, done: F::Mask, displacement_m: F, time_s: F) {
        let largest_m = F::of_row(time_s.token(), &self.top_m);
        let rises = done & displacement_m.abs().simd_gt(largest_m.abs());
        keep(rises, &mut self.top_m, displacement_m);
        keep(rises, &mut self.top_time_s, time_s);
    }

    #[inline(always)]
    pub fn add<F: Wide>(done: F::Mask, sum: &mut Numbers, more: F) {
        (F::of_row(more.token(), sum) + done.select(more, F::splat(more.token(), 0.0))).put(sum);
    }

    /// As [`super::totals::Totals::energy`].
    #[inline(always)]
    fn energy<F: Wide>(&mut self, done: F::Mask, [work_j, loss_j]: [F; 2]) {
        Self::add(done, &mut self.ground_work_j, work_j);
        Self::add(done, &mut self.effect_loss_j, loss_j);
        Self::add(done, &mut self.passed_through_j, work_j.abs() + loss_j.abs());
    }
}

impl Row {
    /// Keeps the steps in which nothing happened, and requests those that follow. Gives the bits of the lanes that are left.
    #[inline(always)]
    pub fn settle<F: Wide, M: Stepping<F>>(&mut self, motions: &M, alone: bool, landed: &Landed<F>) -> u64 {
        let simd = landed.position[0].token();
        let h = F::of_row(simd, &self.moving.h);
        let error = self.errors.of(landed.position_error, landed.velocity_error, h);
        let to = self.ground.onwards(simd, h);
        let paths = self.limits.paths(M::AS_ONE, &self.moving, landed, h);
        let mut kept = error.simd_le(1.0) & paths.clear & to.goes_on & self.far_from_kinks(landed, h);
        if M::ON_BEDS {
            kept &= self.beds.keep_contact(&self.moving, landed, h);
        }
        let (corner_force, stays) = self.stay_closed(M::AS_ONE, landed);
        let done = kept & stays;
        let left = self.taken & !done.to_bitmask();
        let settled = Settled { h, error, to, rise: paths.rise, corner_force };
        if alone && left == 0 {
            // In all lanes, so that the next step need not wait for all that was looked at. Only one is ever told of.
            let taken = <F::Mask>::from_bitmask(simd, self.taken);
            self.go_on([<F::Mask>::splat(simd, true), taken], motions, landed, &settled);
        } else {
            self.go_on([done, done], motions, landed, &settled);
        }
        left
    }

    /// Requests shorter steps in place of those of the lanes that are left whose errors are too large. Gives the bits of these lanes.
    #[inline(always)]
    pub fn reject<F: Wide>(&mut self, simd: F::Token, landed: &Landed<F>, left: u64) -> u64 {
        let (h, step_s) = (F::of_row(simd, &self.moving.h), F::of_row(simd, &self.ground.step_s));
        let error = self.errors.of(landed.position_error, landed.velocity_error, h);
        // Whether a step could be shorter at all is looked at by the run.
        let could_be_shorter = h.simd_ge(step_s * PROGRESS);
        let advances = F::of_row(simd, &self.limits.advances).simd_eq(1.0);
        // So is whether it may try another.
        let [steps, rejected, most_steps] =
            [&self.sums.steps, &self.sums.rejected_steps, &self.sums.most_steps].map(|n| F::of_row(simd, n));
        let goes_on = could_be_shorter & advances & (steps + rejected + 1.0).simd_lt(most_steps);
        let too_large = <F::Mask>::from_bitmask(simd, left) & error.simd_gt(1.0) & goes_on;
        if !too_large.any_true() {
            return 0;
        }
        self.errors.propose_shorter(too_large.to_bitmask(), &error.numbers(), &h.numbers());
        SumRow::add(too_large, &mut self.sums.rejected_steps, F::splat(simd, 1.0));
        let left_s = F::of_row(simd, &self.ground.length_s) - F::of_row(simd, &self.ground.offset_s);
        self.request(too_large, left_s);
        too_large.to_bitmask()
    }

    /// Keeps the steps of some lanes, and looks at maxima and at lengths that change in `told` of them.
    #[inline(always)]
    fn go_on<F: Wide, M: Stepping<F>>(
        &mut self,
        [done, told]: [F::Mask; 2],
        motions: &M,
        landed: &Landed<F>,
        &Settled { h, error, ref to, rise, corner_force }: &Settled<F>,
    ) {
        if self.watched {
            self.shown = (done & self.is_wanted(h)).to_bitmask();
            if self.shown != 0 {
                self.remember();
            }
        }
        let rises = told & rise;
        if rises.any_true() {
            self.landed.store_motion(landed);
            self.raise_rotations(rises.to_bitmask());
        }
        keep(done, &mut self.limits.corner_force, corner_force);
        self.account(done, landed, h);
        self.turn_top(told, motions, landed, h);
        self.moving_on(done, landed);
        self.errors.propose(told, error, h);
        let left_s = self.ground.move_on(done, to, &self.samples);
        self.request(done, left_s);
    }

    /// Whether steps of these lengths from here are wanted by those who watch.
    #[inline(always)]
    pub fn is_wanted<F: Wide>(&self, h: F) -> F::Mask {
        let of = |numbers: &Numbers| F::of_row(h.token(), numbers);
        let start_s = of(&self.ground.start_s) + of(&self.ground.offset_s);
        (start_s + h).simd_gt(of(&self.wants_from_s))
    }

    /// Requests the next steps of some lanes, with so much left of their pieces in s.
    #[inline(always)]
    pub fn request<F: Wide>(&mut self, done: F::Mask, left_s: F) {
        let simd = left_s.token();
        let next = self.errors.next_s(left_s);
        keep(done, &mut self.moving.h, next);
        let shorter = next.simd_lt(left_s).select(F::splat(simd, 1.0), F::splat(simd, 0.0));
        SumRow::add(done, &mut self.sums.tolerance_steps, shorter);
    }

    #[inline(always)]
    fn far_from_kinks<F: Wide>(&self, landed: &Landed<F>, h: F) -> F::Mask {
        let advances = F::of_row(h.token(), &self.limits.advances).simd_eq(1.0);
        if !self.kinks.any {
            return advances;
        }
        let before_m_s = F::of_row(h.token(), &self.limits.top_velocity_m_s);
        advances & self.kinks.far(&self.moving, before_m_s, landed, h)
    }

    /// The smallest corner forces, and whether closed joints surely stay closed and the pivots are under tension as
    /// they were.
    #[inline(always)]
    fn stay_closed<F: Wide>(&self, as_one: bool, landed: &Landed<F>) -> (F, F::Mask) {
        // On sharp edges, walls that turn as one have a closed crack, or none. Others have the ground closed, or nothing.
        let closed = if as_one { landed.reactions.crack } else { landed.reactions.ground };
        let (corner_force, stays) = self.limits.corner_force(closed);
        (corner_force, stays & self.limits.same_tension(self.normals(landed)))
    }

    /// Normal forces through the ground and the crack, 0 where there is none.
    #[inline(always)]
    pub fn normals<F: Wide>(&self, landed: &Landed<F>) -> [F; 2] {
        let normal = landed.reactions.crack[1];
        let cracked = F::of_row(normal.token(), &self.limits.cracked).simd_eq(1.0);
        [landed.reactions.ground[1], cracked.select(normal, F::splat(normal.token(), 0.0))]
    }

    /// Adds the steps of some lanes up.
    #[inline(always)]
    pub fn account<F: Wide>(&mut self, done: F::Mask, landed: &Landed<F>, h: F) {
        let normals = self.normals(landed);
        let (simd, sums, ground) = (h.token(), &mut self.sums, &self.ground);
        let start_s = F::of_row(simd, &ground.start_s) + F::of_row(simd, &ground.offset_s);
        SumRow::add(done, &mut sums.steps, F::splat(simd, 1.0));
        SumRow::add(done, &mut sums.pattern_time_s, h);
        sums.top(done, landed.reactions.top[0], start_s + h);
        sums.force(done, 0, [landed.reactions.ground[0], normals[0]]);
        sums.force(done, 1, [landed.reactions.crack[0], normals[1]]);
        sums.energy(done, landed.quadrature);
    }

    /// Raises the largest displacement of tops that turn back inside the step, as [`super::run`] does.
    #[inline(always)]
    pub fn turn_top<F: Wide, M: Stepping<F>>(
        &mut self,
        done: F::Mask,
        motions: &M,
        landed: &Landed<F>,
        h: F,
    ) {
        let (simd, now) = (h.token(), landed.reactions.top[1]);
        let before = F::of_row(simd, &self.limits.top_velocity_m_s);
        let most_m = landed.reactions.top[0].abs() + (before.abs() + now.abs()) * 2.0 * h;
        let rises = most_m.simd_gt(F::of_row(simd, &self.sums.top_m).abs());
        let turns = done & rises & (before * now).simd_lt(0.0);
        if !turns.any_true() {
            return;
        }
        let share = turns.select(before / (before - now), F::splat(simd, 0.0));
        let scale = scale(h);
        let lower = value(self.moving.path(0, landed, scale), share);
        let upper = match M::AS_ONE {
            true => lower,
            false => value(self.moving.path(1, landed, scale), share),
        };
        let x_c = motions.top_displacement_m([lower, upper]);
        let start_s = F::of_row(simd, &self.ground.start_s) + F::of_row(simd, &self.ground.offset_s);
        self.sums.top(turns, x_c, start_s + share * h);
    }

    /// Makes the ends of the steps of some lanes the present.
    #[inline(always)]
    fn moving_on<F: Wide>(&mut self, done: F::Mask, landed: &Landed<F>) {
        keep_both(done, &mut self.moving.position, landed.position);
        keep_both(done, &mut self.moving.velocity, landed.velocity);
        keep_both(done, &mut self.moving.acceleration, landed.acceleration);
        keep_both(done, &mut self.moving.powers_w, landed.powers_w);
        keep(done, &mut self.limits.top_velocity_m_s, landed.reactions.top[1]);
        if self.kinks.any {
            self.kinks.move_on(done, landed);
        }
    }
}

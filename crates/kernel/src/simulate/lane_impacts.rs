//! Impacts in the lanes: walls that turn as one strike the ground and turn on about their other corner, or the crack of others
//! closes and opens on the other side. These are most impacts of most runs, and the row goes on through them.
//!
//! The same sums in the same order as a run does by itself ([`super::run`]): the search for the impact, the step up to it, its
//! correction, the accounts, the impact, and the motion after it. Where anything else may happen the step is left to the run.

use fearless_simd::{Select, SimdMask};

use super::events::ROUNDINGS;
use super::lane_accounts::{keep, keep_both};
use super::lane_paths::{bound, keeps_to, scale};
use super::lane_steps::{GroundLanes, Landed};
use super::row::{LimitRow, Row, SumRow};
use super::run::{PROGRESS, SHORT};
use super::totals::LITTLE;
use crate::lanes::{Numbers, Wide, exchange};
use crate::model::{CrackRow, Motions, PivotRow, RateLanes, ReactionLanes, StrikeRow};
use crate::solver::{only_roots, turn_negative_once};

/// What the impacts of the walls of a row need.
#[derive(Debug, Default)]
pub(super) struct ImpactRow {
    /// 1 of walls that may go through their impacts in their lane.
    pub known: Numbers,
    /// Where the step is to reach an impact inside a longer one, of this length in s: [`REACHES`] or [`AT_GROUND`], else 0.
    pub reaches: Numbers,
    pub most_s: Numbers,
    /// What the impact leaves that ends this contact state, and that which ends the one after it.
    pub here: StrikeRow,
    pub there: StrikeRow,
    /// What the motion turns about after it, and the time in that pattern, s.
    pub pivots_there: PivotRow,
    pub time_there_s: Numbers,
    pub cracks: CrackRow,
    /// Openings up to this are contact, rad, and velocities below this leave a joint closed, rad/s.
    pub contact_rad: Numbers,
    pub capture_rad_s: Numbers,
    pub loss_j: Numbers,
    /// Steps since the run boarded in which an impact was found.
    pub found: Numbers,
}

/// In [`ImpactRow::reaches`]: an impact that the row may go through, and one at the ground of a wall whose bodies turn apart, which
/// the run goes through.
pub(super) const REACHES: f64 = 1.0;
pub(super) const AT_GROUND: f64 = 2.0;

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

/// The end of a step to an impact, moved onto it.
struct Reached<F: Wide> {
    landed: Landed<F>,
    h: F,
    /// Offset reached in the piece, s.
    offset_s: F,
}

/// What an impact leaves.
struct Left<F: Wide> {
    theta: [F; 2],
    omega: [F; 2],
    loss_j: F,
}

/// The motion after an impact.
struct TurnedOn<F: Wide> {
    rate: RateLanes<F>,
    reactions: ReactionLanes<F>,
    corner_force: F,
}

impl ImpactRow {
    /// What impacts of walls leave that turn as one, and which of them turn on: as [`crate::model::RockingWall::impact`].
    #[inline(always)]
    fn whole<F: Wide>(&self, before: F) -> (Left<F>, F::Mask) {
        let of = |numbers: &Numbers| F::of_row(before.token(), numbers);
        let plastic = of(&self.here.plastic) * before;
        let omega = of(&self.here.coefficient) * plastic;
        let loss_j = of(&self.here.before_j) * before * before - of(&self.here.after_j) * omega * omega;
        let left = Left { theta: [F::splat(before.token(), 0.0); 2], omega: [omega; 2], loss_j };
        (left, plastic.abs().simd_ge(of(&self.capture_rad_s)))
    }

    /// The same of impacts at cracks that were open on these sides, where the ground is out of reach.
    #[inline(always)]
    fn at_crack<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &self,
        motions: [&Motions<F, AS_ONE, FURTHER>; 2],
        landed: &Landed<F>,
        sides: [F; 2],
    ) -> (Left<F>, F::Mask) {
        let of = |numbers: &Numbers| F::of_row(sides[0].token(), numbers);
        let theta = landed.position[0];
        let limits = [of(&self.here.coefficient), of(&self.capture_rad_s)];
        let (impact, turns_on) = self.cracks.strike(
            [&motions[0].sharp, &motions[1].sharp],
            (theta, landed.velocity),
            -sides[1],
            limits,
        );
        let apart = (sides[0] * theta).simd_gt(of(&self.contact_rad));
        (Left { theta: [theta; 2], omega: impact.omega, loss_j: impact.loss_j }, turns_on & apart)
    }
}

impl SumRow {
    /// As [`super::totals::Totals::surely_outdo`].
    #[inline(always)]
    fn surely_outdo<F: Wide>(&self, i: usize, limits: &LimitRow, [shear, normal]: [F; 2]) -> F::Mask {
        let of = |numbers: &Numbers| F::of_row(normal.token(), numbers);
        of(&limits.tension[i]).simd_eq(0.0)
            & (shear.abs() * (1.0 + LITTLE)).simd_lt(of(&self.friction[i]) * normal)
            & (normal * (1.0 + LITTLE)).simd_lt(of(&self.compression_n[i]))
    }
}

/// The opening of the joint that closes: at the ground, or at the crack.
#[inline(always)]
fn gap<F: Wide, const AS_ONE: bool>([lower, upper]: [F; 2]) -> F {
    if AS_ONE { lower } else { upper - lower }
}

/// Where that joint is among both.
const fn joint(as_one: bool) -> usize {
    if as_one { 0 } else { 1 }
}

impl Row {
    /// Finds impacts in the steps of the lanes that are left, and goes through those that were to be reached. Gives the bits of
    /// the lanes that go on so.
    #[inline(always)]
    pub fn meet_impacts<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &mut self,
        simd: F::Token,
        landed: &Landed<F>,
        left: u64,
    ) -> u64 {
        let known = F::of_row(simd, &self.impacts.known).simd_eq(1.0) & <F::Mask>::from_bitmask(simd, left);
        let reaches = F::of_row(simd, &self.impacts.reaches);
        let found = self.find_impacts::<F, AS_ONE>(known & reaches.simd_eq(0.0), landed);
        let gone = self.go_through_impacts::<F, AS_ONE, FURTHER>(known & reaches.simd_eq(REACHES), landed);
        (found | gone).to_bitmask()
    }

    /// Requests steps up to the impacts inside those of some lanes, where nothing else happens.
    #[inline(always)]
    fn find_impacts<F: Wide, const AS_ONE: bool>(&mut self, which: F::Mask, landed: &Landed<F>) -> F::Mask {
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

    /// Goes through the impacts that some lanes have reached.
    #[inline(always)]
    fn go_through_impacts<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &mut self,
        which: F::Mask,
        landed: &Landed<F>,
    ) -> F::Mask {
        if !which.any_true() {
            return which;
        }
        let simd = landed.position[0].token();
        let (reached, on_time) = self.onto_impact::<F, AS_ONE>(landed);
        let may = which & on_time;
        // What leads up to an impact is shown by the run.
        let may = if self.watched { may & !self.is_wanted(reached.h) } else { may };
        if !may.any_true() {
            return may;
        }
        let before = Motions::<F, AS_ONE, FURTHER>::unwritten(simd, &self.motions);
        self.motions.turn_over::<F>(may, &mut self.impacts.pivots_there);
        let after = Motions::<F, AS_ONE, FURTHER>::unwritten(simd, &self.motions);
        let (left, turns_on) = self.struck::<F, AS_ONE, FURTHER>([&before, &after], &reached.landed);
        let (turned, stays_closed) = self.turned_on(&after, &reached, &left);
        let (gone, back) = (may & turns_on & stays_closed, may & !(turns_on & stays_closed));
        if back.any_true() {
            self.motions.turn_over::<F>(back, &mut self.impacts.pivots_there);
        }
        self.account_for_flight(gone, &before, &reached);
        self.turn_on::<F, AS_ONE>(gone, &reached, &left, &turned);
        gone
    }

    /// The ends of steps moved onto the impact, and where it may be so: by little, with forces that need no second look, and
    /// joints that fall back.
    #[inline(always)]
    fn onto_impact<F: Wide, const AS_ONE: bool>(&self, landed: &Landed<F>) -> (Reached<F>, F::Mask) {
        let simd = landed.position[0].token();
        let of = |numbers: &Numbers| F::of_row(simd, numbers);
        let (theta, omega, theta_dd) = (landed.position, landed.velocity, landed.acceleration);
        let late_s = gap::<F, AS_ONE>(theta) / gap::<F, AS_ONE>(omega);
        let (short_s, h, step_s) = (-late_s, of(&self.moving.h) - late_s, of(&self.ground.step_s));
        let position = |i: usize| theta[i] + short_s * (omega[i] + short_s * 0.5 * theta_dd[i]);
        let velocity = |i: usize| omega[i] + short_s * theta_dd[i];
        let (position, velocity) = ([position(0), position(1)], [velocity(0), velocity(1)]);
        let [x_c, v_c, a_c] = landed.reactions.top;
        let top = [x_c + short_s * v_c, v_c + short_s * a_c, a_c];
        let offset_s = of(&self.ground.offset_s) + h;
        let [ground, crack] = [landed.reactions.ground, landed.reactions.crack];
        let outdone = self.sums.surely_outdo(0, &self.limits, [ground[0], ground[1]])
            & (self.sums.surely_outdo(1, &self.limits, [crack[0], crack[1]])
                | of(&self.limits.cracked).simd_eq(0.0));
        let falls_back = gap::<F, AS_ONE>(velocity) * of(&self.limits.sides[joint(AS_ONE)]);
        let on_time = late_s.abs().simd_le(step_s * SHORT)
            & h.simd_ge(step_s * PROGRESS)
            & offset_s.simd_lt(of(&self.ground.length_s))
            & outdone
            & falls_back.simd_lt(0.0);
        let reactions = ReactionLanes { top, ..landed.reactions };
        (Reached { landed: Landed { position, velocity, reactions, ..*landed }, h, offset_s }, on_time)
    }

    /// What the impacts leave, by the motions before and after, and where these are surely those after.
    #[inline(always)]
    fn struck<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &self,
        motions: [&Motions<F, AS_ONE, FURTHER>; 2],
        landed: &Landed<F>,
    ) -> (Left<F>, F::Mask) {
        let simd = landed.position[0].token();
        if AS_ONE {
            return self.impacts.whole(landed.velocity[0]);
        }
        let sides = [0, 1].map(|i| F::of_row(simd, &self.limits.sides[i]));
        self.impacts.at_crack(motions, landed, sides)
    }

    /// The motion after the impact, and whether a crack that is closed stays so in it.
    #[inline(always)]
    fn turned_on<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &self,
        after: &Motions<F, AS_ONE, FURTHER>,
        reached: &Reached<F>,
        left: &Left<F>,
    ) -> (TurnedOn<F>, F::Mask) {
        let simd = reached.h.token();
        let ground = GroundLanes::of_row(simd, &self.ground).at(reached.h);
        let (rate, reactions) =
            after.rate_and_reactions(&after.configuration(left.theta), left.omega, ground);
        let corner_force = self.limits.least_at_corners(reactions.crack);
        let stays = corner_force.simd_ge(0.0) | F::of_row(simd, &self.limits.closed).simd_eq(0.0);
        (TurnedOn { rate, reactions, corner_force }, stays)
    }

    /// Adds up the steps to the impacts, as [`Row::settle`] does whole ones.
    #[inline(always)]
    fn account_for_flight<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &mut self,
        gone: F::Mask,
        motions: &Motions<F, AS_ONE, FURTHER>,
        reached: &Reached<F>,
    ) {
        let Reached { landed, h, .. } = reached;
        keep(gone, &mut self.moving.h, *h);
        let scale = scale(*h);
        let lower = bound(&self.moving.path(0, landed, scale));
        let upper = if AS_ONE { lower } else { bound(&self.moving.path(1, landed, scale)) };
        let rises = |i: usize, size: F| size.simd_gt(F::of_row(h.token(), &self.limits.theta_max_rad[i]));
        let rises = gone & (rises(0, lower) | rises(1, upper));
        if rises.any_true() {
            self.landed.store_motion(landed);
            self.raise_rotations(rises.to_bitmask());
        }
        self.account(gone, landed, *h);
        self.turn_top(gone, motions, landed, *h);
    }

    /// Makes the motion after the impacts the present.
    #[inline(always)]
    fn turn_on<F: Wide, const AS_ONE: bool>(
        &mut self,
        gone: F::Mask,
        reached: &Reached<F>,
        left: &Left<F>,
        after: &TurnedOn<F>,
    ) {
        let simd = reached.h.token();
        let all = |value: f64| F::splat(simd, value);
        let impacts = &mut self.impacts;
        SumRow::add(gone, &mut impacts.here.count, all(1.0));
        SumRow::add(gone, &mut impacts.loss_j, left.loss_j);
        SumRow::add(gone, &mut self.sums.passed_through_j, left.loss_j.abs());
        keep(gone, &mut impacts.reaches, all(0.0));
        impacts.here.exchange::<F>(gone, &mut impacts.there);
        exchange::<F>(gone, &mut self.sums.pattern_time_s, &mut impacts.time_there_s);
        let side = &mut self.limits.sides[joint(AS_ONE)];
        let other = -F::of_row(simd, side);
        keep(gone, side, other);
        keep(gone, &mut self.limits.advances, all(1.0));
        keep(gone, &mut self.limits.corner_force, after.corner_force);
        keep(gone, &mut self.limits.top_velocity_m_s, after.reactions.top[1]);
        keep_both(gone, &mut self.moving.position, left.theta);
        keep_both(gone, &mut self.moving.velocity, left.omega);
        keep_both(gone, &mut self.moving.acceleration, after.rate.theta_dd);
        keep_both(gone, &mut self.moving.powers_w, after.rate.powers_w);
        keep(gone, &mut self.ground.offset_s, reached.offset_s);
        self.request(gone, F::of_row(simd, &self.ground.length_s) - reached.offset_s);
    }
}

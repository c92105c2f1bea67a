//! Impacts in the lanes: walls that turn as one strike the ground and turn on about their other corner, or the crack of others
//! closes and opens on the other side. These are most impacts of most runs, and the row goes on through them.
//!
//! The same sums in the same order as a run does by itself ([`super::run`]): the search for the impact ([`super::lane_closings`]), the
//! step up to it, its correction, the accounts, the impact, and the motion after it. Where anything else may happen the step is left to
//! the run.

use fearless_simd::{Select, SimdMask};

use super::lane_accounts::{keep, keep_both};
use super::lane_paths::{bound, scale};
use super::lane_steps::{GroundLanes, Landed};
use super::row::{LimitRow, Row, SumRow};
use super::run::{PROGRESS, SHORT};
use super::totals::LITTLE;
use crate::lanes::{Numbers, Wide, exchange};
use crate::model::{CrackRow, Motions, PivotRow, RateLanes, ReactionLanes, SharpMotion, StrikeRow};

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
    fn at_crack<F: Wide>(
        &self,
        motions: [&SharpMotion<F>; 2],
        landed: &Landed<F>,
        sides: [F; 2],
    ) -> (Left<F>, F::Mask) {
        let of = |numbers: &Numbers| F::of_row(sides[0].token(), numbers);
        let theta = landed.position[0];
        let limits = [of(&self.here.coefficient), of(&self.capture_rad_s)];
        let (impact, turns_on) = self.cracks.strike(motions, (theta, landed.velocity), -sides[1], limits);
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
        motions: &Motions<F, AS_ONE, FURTHER>,
        landed: &Landed<F>,
        left: u64,
    ) -> u64 {
        let known = F::of_row(simd, &self.impacts.known).simd_eq(1.0) & <F::Mask>::from_bitmask(simd, left);
        let reaches = F::of_row(simd, &self.impacts.reaches);
        let found = self.find_impacts::<F, AS_ONE>(known & reaches.simd_eq(0.0), landed);
        let gone = self.go_through_impacts(motions, known & reaches.simd_eq(REACHES), landed);
        (found | gone).to_bitmask()
    }

    /// Goes through the impacts that some lanes have reached.
    #[inline(always)]
    fn go_through_impacts<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &mut self,
        motions: &Motions<F, AS_ONE, FURTHER>,
        which: F::Mask,
        landed: &Landed<F>,
    ) -> F::Mask {
        if !which.any_true() {
            return which;
        }
        let simd = landed.position[0].token();
        let (mut reached, on_time) = self.onto_impact::<F, AS_ONE>(landed);
        let may = which & on_time;
        // What leads up to an impact is shown by the run.
        let may = if self.watched { may & !self.is_wanted(reached.h) } else { may };
        if !may.any_true() {
            return may;
        }
        self.look_again_at_reactions(motions, may, &mut reached);
        let may = may & self.limits.same_tension(self.normals(&reached.landed));
        self.motions.turn_over::<F>(may, &mut self.impacts.pivots_there);
        let after = self.motions.sharp(simd);
        let (left, turns_on) = match AS_ONE {
            true => self.impacts.whole(reached.landed.velocity[0]),
            false => self.at_crack([&motions.sharp, &after], &reached.landed),
        };
        let (turned, stays_closed) = self.turned_on(motions, &after, &reached, &left);
        let (gone, back) = (may & turns_on & stays_closed, may & !(turns_on & stays_closed));
        if back.any_true() {
            self.motions.turn_over::<F>(back, &mut self.impacts.pivots_there);
        }
        self.account_for_flight(gone, motions, &reached);
        self.turn_on::<F, AS_ONE>(gone, &reached, &left, &turned);
        gone
    }

    /// The ends of steps moved onto the impact, and where it may be so: by little, with joints that fall back.
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
        let falls_back = gap::<F, AS_ONE>(velocity) * of(&self.limits.sides[joint(AS_ONE)]);
        let on_time = late_s.abs().simd_le(step_s * SHORT)
            & h.simd_ge(step_s * PROGRESS)
            & offset_s.simd_lt(of(&self.ground.length_s))
            & falls_back.simd_lt(0.0);
        let reactions = ReactionLanes { top, ..landed.reactions };
        (Reached { landed: Landed { position, velocity, reactions, ..*landed }, h, offset_s }, on_time)
    }

    /// Works the reactions at the impacts of some lanes out where those at the end of the step do not stand for them: where forces may
    /// be the largest so far, and where formulas act. As [`super::run::Run`] does.
    #[inline(always)]
    fn look_again_at_reactions<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &self,
        motions: &Motions<F, AS_ONE, FURTHER>,
        may: F::Mask,
        reached: &mut Reached<F>,
    ) {
        let simd = reached.h.token();
        let landed = &mut reached.landed;
        let [ground, crack] = [landed.reactions.ground, landed.reactions.crack];
        let cracked = F::of_row(simd, &self.limits.cracked).simd_eq(1.0);
        let outdone = self.sums.surely_outdo(0, &self.limits, [ground[0], ground[1]])
            & (self.sums.surely_outdo(1, &self.limits, [crack[0], crack[1]]) | !cracked);
        let again = may & motions.written().map_or(!outdone, |written| written | !outdone);
        if !again.any_true() {
            return;
        }
        let at = GroundLanes::of_row(simd, &self.ground).at(reached.h);
        let t = motions.configuration(landed.position);
        let there = motions.reactions(&t, landed.velocity, landed.acceleration, at);
        let of = |new: [F; 3], old: [F; 3]| {
            [again.select(new[0], old[0]), again.select(new[1], old[1]), again.select(new[2], old[2])]
        };
        landed.reactions = ReactionLanes {
            ground: of(there.ground, ground),
            crack: of(there.crack, crack),
            top: of(there.top, landed.reactions.top),
        };
    }

    /// What impacts at cracks leave, by the motions before and after, and where these are surely those after.
    #[inline(always)]
    fn at_crack<F: Wide>(&self, motions: [&SharpMotion<F>; 2], landed: &Landed<F>) -> (Left<F>, F::Mask) {
        let simd = landed.position[0].token();
        let sides = [F::of_row(simd, &self.limits.sides[0]), F::of_row(simd, &self.limits.sides[1])];
        self.impacts.at_crack(motions, landed, sides)
    }

    /// The motion after the impact, and whether a crack that is closed stays so in it.
    #[inline(always)]
    fn turned_on<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
        &self,
        motions: &Motions<F, AS_ONE, FURTHER>,
        after: &SharpMotion<F>,
        reached: &Reached<F>,
        left: &Left<F>,
    ) -> (TurnedOn<F>, F::Mask) {
        let simd = reached.h.token();
        let ground = GroundLanes::of_row(simd, &self.ground).at(reached.h);
        let t = after.turned(Motions::<F, AS_ONE, FURTHER>::turns(left.theta));
        let (rate, reactions) = motions.rate_and_reactions_about(after, &t, left.omega, ground);
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

//! The loop of one run: stand, move, open, strike, until the end.

use wide::f64x2;

use super::events::{Event, first_event};
use super::ground_path::{GroundPath, Piece};
use super::history::Observer;
use super::kinks;
use super::response::{Outcome, Peak, Response};
use super::rest::RestLimits;
use super::simulator::{Placed, Simulator};
use super::tally::Tally;
use crate::model::{
    Aftermath, Contact, Joint, Kink, MechanicsError, Motion, Pair, RatePair, RockingWall, State, Touching,
    Turned, Vector, opening,
};
use crate::solver::{Controller, Field, Nystrom, Point, Quintic, Rate, STAGES, Step};

/// An opening is placed this share of a sample step after the instant its corner force vanishes, so that the joint
/// does accelerate apart; it moves nothing by more than roundings.
const AFTER_OPENING: f64 = 1e-9;

/// A share of a sample step so short that a parabola is exact over it: its cube times any jerk of a wall is below
/// roundings. A share and no time, so that a wall four times as large moves the same to the bit.
const SHORT: f64 = 2e-7;
/// Newton corrections of an event's time; one suffices but for grazing impacts.
const MOST_CORRECTIONS: u32 = 4;

/// Events without progress, one after another, that count as a defect: the longest burst of impacts, that of a wall sixty
/// times as high as thick with a capture velocity of zero, takes some ten thousand to come to rest.
const MOST_EVENTS_AT_ONCE: u32 = 50_000;
/// Progress, as a share of a sample step, that an event must make not to count as stalled.
const PROGRESS: f64 = 1e-6;

/// Where the run stands.
pub(super) struct Run<'a, O> {
    wall: RockingWall,
    ground: GroundPath,
    rest: RestLimits,
    collapse_rad: Pair,
    controller: Controller,
    tally: Tally,
    observer: &'a mut O,
    contact: Contact,
    now: Point,
    quadrature_rate: Pair,
    /// Smallest corner force of the closed joints now.
    corner_force: Option<f64>,
    /// Velocity of the top now, m/s.
    top_velocity_m_s: f64,
    stalled: u32,
}

/// The motion of a contact state under a piece of the record, and what its last landing told.
struct Shaken<'a> {
    law: &'a Motion,
    piece: Piece,
    from_s: f64,
    posture: Turned,
    after: Aftermath,
}

impl Field for Shaken<'_> {
    #[inline(always)]
    fn rate(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        let ground = self.piece.at(self.from_s + after_s);
        if self.law.turns_as_one() {
            return as_rate(self.law.monolithic_rate(theta.to_array()[0], omega.to_array()[0], ground));
        }
        self.posture = self.law.turned(theta);
        as_rate(self.law.rate_at(&self.posture, omega, ground))
    }

    #[inline(always)]
    fn land(&mut self, after_s: f64, theta: f64x2, omega: f64x2) -> Rate {
        // The posture of the last stage serves again, for the joint forces too.
        if self.law.turns_as_one() {
            self.posture = self.law.turned(theta);
        }
        let (rate, after) = self.law.arrival(&self.posture, omega, self.piece.at(self.from_s + after_s));
        self.after = after;
        as_rate(rate)
    }
}

#[inline(always)]
fn as_rate(rate: RatePair) -> Rate {
    Rate { acceleration: rate.theta_dd, quadrature: rate.powers_w }
}

/// Why a run ended before its time.
enum Stop {
    Collapsed {
        time_s: f64,
    },
    Failed {
        time_s: f64,
        reason: String,
    },
    /// Its observer has seen enough.
    SeenEnough,
}

impl<'a, O: Observer> Run<'a, O> {
    /// A run that starts as it is placed and ends where its ground path does.
    pub fn new(simulator: &Simulator, placed: &Placed, ground: GroundPath, observer: &'a mut O) -> Self {
        let mut wall = simulator.wall.clone();
        wall.place_top(placed.contact, &placed.state, placed.plastic_displacement_m);
        Self {
            rest: simulator.rest.clone(),
            collapse_rad: simulator.wall.wall().collapse_rotation_rad(),
            controller: simulator.controller,
            tally: Tally::new(simulator.wall.joints().count()),
            observer,
            contact: placed.contact,
            now: Point { position: placed.state.theta, velocity: placed.state.omega, ..Point::default() },
            quadrature_rate: [0.0; 2],
            corner_force: None,
            top_velocity_m_s: 0.0,
            stalled: 0,
            wall,
            ground,
        }
    }

    pub fn go(mut self, start_s: f64) -> Response {
        let outcome = match self.start(start_s).and_then(|()| self.all_pieces(start_s)) {
            Ok(()) | Err(Stop::SeenEnough) => Outcome::Stood,
            Err(Stop::Collapsed { time_s }) => Outcome::Collapsed { time_s },
            Err(Stop::Failed { time_s, reason }) => Outcome::Failed { time_s, reason },
        };
        self.response(outcome)
    }

    fn state(&self) -> State {
        State { theta: self.now.position, omega: self.now.velocity }
    }

    fn start(&mut self, start_s: f64) -> Result<(), Stop> {
        let ground = self.ground.at(start_s);
        let released = self.contact;
        self.tally.energy.initial_j = self.wall.energy_j(released, &self.state());
        self.tally.energy.passed_through_j = self.tally.energy.initial_j.abs();
        self.tally.rotations(start_s, &Quintic::new(&self.now, &self.now, 0.0));
        self.tally.top(self.wall.top_displacement_m(released, self.now.position), start_s);
        if (0..2).any(|i| self.now.position[i].abs() >= self.collapse_rad[i]) {
            return Err(Stop::Collapsed { time_s: start_s });
        }
        if self.closes_at_once() {
            return self.strike(Touching::closed_in(released), ground, start_s);
        }
        self.enter(released, ground, start_s)
    }

    /// Whether an open joint without a gap does not separate: only where a start was given so.
    fn closes_at_once(&self) -> bool {
        self.wall.joints().any(|joint| {
            let side = self.contact.at(joint).sign();
            let [gap, rate] = [self.now.position, self.now.velocity].map(|pair| side * opening(joint, pair));
            side != 0.0 && gap == 0.0 && rate <= 0.0
        })
    }

    /// Goes on in the contact state that carries the joint forces, opening joints where it must.
    fn enter(&mut self, contact: Contact, ground: Vector, time_s: f64) -> Result<(), Stop> {
        let settled = self.settle(contact, ground).map_err(|e| failed(time_s, &e))?;
        if settled != contact {
            self.tally.opening(contact, settled);
        }
        self.contact = settled;
        let rate = self.wall.rate(settled, &self.state(), ground);
        self.tally.work.evaluations += 1;
        self.now.acceleration = rate.theta_dd;
        self.quadrature_rate = [rate.ground_power_w, rate.loss_power_w];
        let after = self.aftermath(&self.now, ground);
        self.corner_force = self.wall.least_hold(settled, &after);
        self.top_velocity_m_s = after.top_velocity_m_s;
        Ok(())
    }

    fn settle(&mut self, contact: Contact, ground: Vector) -> Result<Contact, MechanicsError> {
        let Some(restraint) = self.wall.restraint().copied() else {
            return self.wall.settle(contact, &self.state(), ground);
        };
        self.now.velocity = self.wall.come_to_stand(contact, &self.state());
        let state = self.state();
        if contact == Contact::REST && restraint.yields() {
            // A spring that has yielded leans on the wall at rest.
            self.wall.place_top(contact, &state, self.wall.regime().plastic_m);
            self.rest = RestLimits::new(&self.wall);
        }
        let rest_hold = self.rest.hold(ground);
        self.wall.settle_restrained(&restraint, contact, &state, ground, rest_hold)
    }

    fn all_pieces(&mut self, start_s: f64) -> Result<(), Stop> {
        let (mut k, mut offset_s) = self.ground.place(start_s);
        while let Some(piece) = self.ground.piece(k) {
            while offset_s < piece.length_s {
                offset_s = match self.contact {
                    Contact::REST => self.stand(&piece, offset_s)?,
                    _ => self.advance(&piece, offset_s)?,
                };
            }
            k += 1;
            offset_s = 0.0;
            if self.observer.seen_enough() {
                return Err(Stop::SeenEnough);
            }
            if self.contact == Contact::REST {
                k = self.stand_through(k);
            }
        }
        Ok(())
    }

    /// Stands through all pieces from the `k`-th on at whose ends no corner has lifted; gives the first that is left.
    fn stand_through(&mut self, k: usize) -> usize {
        let mut friction = 0.0_f64;
        let next = self.ground.first_end_against(k, |ground| {
            let holds = self.rest.holds(ground);
            if holds {
                friction = friction.max(self.rest.friction(ground));
            }
            holds
        });
        // The piece that ends the run may be cut short: it is left to be stood piece by piece.
        let next = next.min(self.ground.whole_pieces());
        if next <= k {
            return k;
        }
        self.stood(self.ground.start_s(k), self.ground.start_s(next), friction);
        next
    }

    /// Stands until a corner lifts or the piece ends; gives the offset reached.
    fn stand(&mut self, piece: &Piece, from_s: f64) -> Result<f64, Stop> {
        let lift_off = self.rest.lift_off_s(piece, from_s);
        let to_s = lift_off.map_or(piece.length_s, |s| self.after_opening(s, piece));
        let friction = self.rest.friction(piece.at(from_s)).max(self.rest.friction(piece.at(to_s)));
        self.stood(piece.start_s + from_s, piece.start_s + to_s, friction);
        if lift_off.is_some() {
            self.enter(Contact::REST, piece.at(to_s), piece.start_s + to_s)?;
        }
        Ok(to_s)
    }

    fn stood(&mut self, from_s: f64, to_s: f64, friction: f64) {
        self.tally.pattern_time_s[Contact::REST.index()] += to_s - from_s;
        for (demand, factor) in self.tally.demand.iter_mut().zip(self.rest.friction_factors()) {
            demand.friction = demand.friction.max(friction * factor);
        }
        self.observer.stood(from_s, to_s);
    }

    fn after_opening(&self, offset_s: f64, piece: &Piece) -> f64 {
        (offset_s + AFTER_OPENING * self.ground.step_s()).min(piece.length_s)
    }

    /// Moves over one step, or up to the first event inside it; gives the offset reached.
    fn advance(&mut self, piece: &Piece, from_s: f64) -> Result<f64, Stop> {
        let remaining_s = piece.length_s - from_s;
        let (step, after) = self.accepted_step(piece, from_s, remaining_s);
        let motion = Quintic::new(&step.start, &step.end, step.h);
        let end_force = self.wall.least_hold(self.contact, &after);
        let force_at =
            |share: f64| self.corner_force_within(&motion, share, piece.at(from_s + share * step.h));
        let corner_force = (self.corner_force, end_force);
        let event = first_event(self.contact, &motion, self.collapse_rad, corner_force, force_at);
        let kink = kinks::first_kink(&self.wall, self.contact, &step.start, &step.end, step.h);
        match earlier(event, kink) {
            None => {
                self.corner_force = end_force;
                self.keep(piece.start_s + from_s, &step, &motion, &after);
                self.stalled = 0;
                // The end of a piece is reached exactly, not up to a rounding.
                Ok(if step.h == remaining_s { piece.length_s } else { from_s + step.h })
            }
            Some((event, share)) => self.meet(event, share, piece, from_s, &step),
        }
    }

    fn aftermath(&self, point: &Point, ground: Vector) -> Aftermath {
        self.wall.motion(self.contact).aftermath(point.position, point.velocity, point.acceleration, ground)
    }

    fn corner_force_within(&self, motion: &Quintic, share: f64, ground: Vector) -> f64 {
        let law = self.wall.motion(self.contact);
        let [theta, omega] = [motion.position(share), motion.velocity(share)].map(f64x2::new);
        let (_, after) = law.arrival(&law.turned(theta), omega, ground);
        self.wall.least_hold(self.contact, &after).unwrap_or(f64::INFINITY)
    }

    fn accepted_step(&mut self, piece: &Piece, from_s: f64, remaining_s: f64) -> (Step, Aftermath) {
        loop {
            let (step, after) = self.step(piece, from_s, self.controller.next_s(remaining_s));
            if self.controller.accepts(&step) {
                return (step, after);
            }
            self.tally.work.rejected_steps += 1;
        }
    }

    /// A step, and the joint forces at its end.
    #[inline]
    fn step(&mut self, piece: &Piece, from_s: f64, h: f64) -> (Step, Aftermath) {
        self.tally.work.evaluations += STAGES;
        let mut shaken = Shaken {
            law: self.wall.motion(self.contact),
            piece: *piece,
            from_s,
            posture: Turned::default(),
            after: Aftermath::default(),
        };
        let step = Nystrom::step(self.now, self.quadrature_rate, h, &mut shaken);
        (step, shaken.after)
    }

    /// Makes the end of a step the present.
    fn keep(&mut self, start_s: f64, step: &Step, motion: &Quintic, after: &Aftermath) {
        self.tally.work.steps += 1;
        self.tally.pattern_time_s[self.contact.index()] += step.h;
        self.tally.rotations(start_s, motion);
        self.top_displacement(start_s, motion, after);
        self.tally.forces(&after.forces);
        self.tally.energy(step.quadrature);
        self.observer.moved(start_s, self.contact, motion);
        self.now = step.end;
        self.quadrature_rate = step.end_quadrature_rate;
        if self.wall.is_held() {
            // The error of a step, which would have it slide.
            self.now.velocity = self.wall.stopped(self.contact, self.now.position, self.now.velocity);
        }
    }

    /// Raises the largest top displacement, between the ends of the step too where the top turns back inside.
    fn top_displacement(&mut self, start_s: f64, motion: &Quintic, after: &Aftermath) {
        self.tally.top(after.top_displacement_m, start_s + motion.h());
        let (before, now) = (self.top_velocity_m_s, after.top_velocity_m_s);
        self.top_velocity_m_s = now;
        if before * now < 0.0 {
            // The velocity is all but linear over the little that is left of a swing.
            let share = before / (before - now);
            let x_c = self.wall.top_displacement_m(self.contact, motion.position(share));
            self.tally.top(x_c, start_s + share * motion.h());
        }
    }

    /// Steps again up to the event, and lets it happen.
    fn meet(
        &mut self,
        event: Event,
        share: f64,
        piece: &Piece,
        from_s: f64,
        whole: &Step,
    ) -> Result<f64, Stop> {
        if let (Event::Bends(kink), true) = (event, share == 0.0) {
            return self.bend(kink, piece.at(from_s), piece.start_s + from_s).map(|()| from_s);
        }
        let mut h = share * whole.h;
        if matches!(event, Event::Opens) {
            h = (h + AFTER_OPENING * self.ground.step_s()).min(whole.h);
        }
        let mut step = self.step(piece, from_s, h).0;
        if let Some(gap) = event.gap() {
            let left = |p: &Point| (gap(p.position), gap(p.velocity));
            step = self.onto_event(piece, from_s, step, whole.h, left);
        }
        if let Event::Bends(kink) = event {
            let (wall, contact) = (self.wall.clone(), self.contact);
            step = self.onto_event(piece, from_s, step, whole.h, |p| kinks::left(&wall, contact, kink, p));
        }
        let to_s = from_s + step.h;
        let (start_s, time_s) = (piece.start_s + from_s, piece.start_s + to_s);
        self.progress(step.h, time_s)?;
        let after = self.aftermath(&step.end, piece.at(to_s));
        self.keep(start_s, &step, &Quintic::new(&step.start, &step.end, step.h), &after);
        match event {
            Event::Collapses => return Err(Stop::Collapsed { time_s }),
            Event::Opens => self.enter(self.contact, piece.at(to_s), time_s)?,
            Event::Bends(kink) => self.bend(kink, piece.at(to_s), time_s)?,
            Event::Strikes(touching) => self.strike(touching, piece.at(to_s), time_s)?,
        }
        Ok(to_s.min(piece.length_s))
    }

    /// Goes on beyond a kink of the laws at the top.
    fn bend(&mut self, kink: Kink, ground: Vector, time_s: f64) -> Result<(), Stop> {
        if matches!(kink, Kink::Stops { .. }) {
            self.now.velocity = self.wall.stopped(self.contact, self.now.position, self.now.velocity);
        }
        self.wall.pass(kink, self.contact, self.now.position);
        self.progress(0.0, time_s)?;
        self.enter(self.contact, ground, time_s)
    }

    /// Moves the end of a step onto the zero of what is left to an event, told together with its rate: the quintic that
    /// found it is only as accurate as the step.
    ///
    /// To roundings whatever the tolerance: in a burst of ever smaller impacts a flight is short and slow, and what is
    /// small beside the wall's rotation is not small beside it. Not beyond the step that was searched: behind it may lie
    /// the end of the piece.
    #[inline]
    fn onto_event(
        &mut self,
        piece: &Piece,
        from_s: f64,
        mut step: Step,
        most_s: f64,
        left: impl Fn(&Point) -> (f64, f64),
    ) -> Step {
        let short_s = SHORT * self.ground.step_s();
        for _ in 0..MOST_CORRECTIONS {
            let (gap, rate) = left(&step.end);
            let late_s = gap / rate;
            if late_s.abs() <= short_s {
                step.end = step.end.after(-late_s);
                step.h -= late_s;
                break;
            }
            let h = (step.h - late_s).min(most_s);
            if !(h > 0.0 && h < 2.0 * step.h) {
                break;
            }
            let nearer = self.step(piece, from_s, h).0;
            if left(&nearer.end).0.abs() >= gap.abs() {
                break;
            }
            step = nearer;
        }
        step
    }

    fn progress(&mut self, h: f64, time_s: f64) -> Result<(), Stop> {
        self.stalled = if h < PROGRESS * self.ground.step_s() { self.stalled + 1 } else { 0 };
        if self.stalled > MOST_EVENTS_AT_ONCE {
            let reason =
                format!("{MOST_EVENTS_AT_ONCE} events without progress in pattern {}", self.contact.name());
            return Err(Stop::Failed { time_s, reason });
        }
        Ok(())
    }

    /// An impact: joints that touch close exactly, velocities change, and the wall goes on.
    fn strike(&mut self, touching: Touching, ground: Vector, time_s: f64) -> Result<(), Stop> {
        let touching = Touching {
            ground: self.touches(Joint::Ground, touching.ground),
            crack: self.touches(Joint::Crack, touching.crack),
        };
        let sign = |joint: Joint| self.contact.at(joint).sign();
        let [ground_gap, crack_gap] =
            [Joint::Ground, Joint::Crack].map(|joint| sign(joint) * opening(joint, self.now.position));
        if touching.ground || ground_gap < 0.0 {
            self.now.position[0] = 0.0;
        }
        if touching.crack || crack_gap < 0.0 {
            self.now.position[1] = self.now.position[0];
        }
        if touching == Touching::closed_in(self.contact) {
            // A flight lower than the error of a step: the root was thought to be where the joint still opens.
            return self.enter(self.contact, ground, time_s);
        }
        let impact =
            self.wall.impact(self.contact, touching, &self.state()).map_err(|e| failed(time_s, &e))?;
        self.tally.impact(&impact);
        self.now.velocity = impact.omega;
        self.enter(impact.contact, ground, time_s)
    }

    /// Whether a joint takes part in an impact: it is closed, or does not separate and either strikes or stands within a
    /// rounding of contact, so that its own impact would follow at the same instant.
    fn touches(&self, joint: Joint, strikes: bool) -> bool {
        let sign = self.contact.at(joint).sign();
        let gap = sign * opening(joint, self.now.position);
        let reached = strikes || gap <= f64::EPSILON * self.wall.wall().alpha_rad();
        reached && sign * opening(joint, self.now.velocity) <= 0.0
    }

    pub fn response(mut self, outcome: Outcome) -> Response {
        let end_time_s = match outcome {
            Outcome::Stood => self.ground.end_s(),
            Outcome::Collapsed { time_s } | Outcome::Failed { time_s, .. } => time_s,
        };
        self.tally.energy.final_j = self.wall.energy_j(self.contact, &self.state());
        // A wall that falls from rest by its own weight turns one energy into another, with no work from outside.
        let halted = State { omega: [0.0; 2], ..self.state() };
        let kinetic_j = self.tally.energy.final_j - self.wall.energy_j(self.contact, &halted);
        let passed_j = &mut self.tally.energy.passed_through_j;
        *passed_j = passed_j.max(kinetic_j);
        self.observer.ended(end_time_s, self.contact, self.now.position);
        let wall = self.wall.wall();
        let lower = self.tally.theta_max[0];
        Response {
            outcome,
            end_time_s,
            theta_max_rad: self.tally.theta_max,
            alpha_i_rad: wall.alpha_i_rad(),
            alpha_rad: wall.alpha_rad(),
            top_displacement_m: self.tally.top_max,
            // The middle of the crack moves monotonically with θ_1, so both are largest together.
            crack_displacement_m: Peak { value: self.wall.crack_displacement_m(lower.value), ..lower },
            pattern_time_s: self.tally.pattern_time_s,
            impacts: self.tally.impacts,
            openings: self.tally.openings,
            energy: self.tally.energy,
            demand: self.tally.demand,
            work: self.tally.work,
        }
    }
}

/// The first of what may happen inside a step; what happens to the joints goes first.
fn earlier(event: Option<(Event, f64)>, kink: Option<(Kink, f64)>) -> Option<(Event, f64)> {
    match (event, kink) {
        (Some((_, at)), Some((kink, share))) if share < at => Some((Event::Bends(kink), share)),
        (None, Some((kink, share))) => Some((Event::Bends(kink), share)),
        (event, _) => event,
    }
}

fn failed(time_s: f64, error: &MechanicsError) -> Stop {
    Stop::Failed { time_s, reason: error.to_string() }
}

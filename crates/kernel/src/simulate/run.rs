//! The loop of one run: rest, motion, openings and impacts, until the end.

mod bed;
mod boarding;
mod boarding_impacts;
mod carried;
mod ending;
mod event;
mod rest;
mod step;

use fearless_simd::Level;

use super::events::Event;
use super::ground_path::{GroundPath, Piece};
use super::history::Observer;
use super::rest::RestLimits;
use super::simulator::{Placed, Simulator};
use super::totals::Totals;
use crate::model::{
    Carried, Contact, MechanicsError, Pair, Pivot, Reactions, Regime, RockingWall, State, TopMemory, Vector,
    opening,
};
use crate::solver::{Controller, Point, Quintic, STAGES, Step};
use carried::CarriedRun;
pub(super) use carried::CarriedStep;
pub(super) use event::{PROGRESS, SHORT};
pub(super) use step::StepRequest;

/// A run between two of its steps.
pub(super) struct Run<O> {
    /// Apart, because runs are handed on before they begin.
    wall: Box<RockingWall>,
    ground: GroundPath,
    rest: RestLimits,
    collapse_rad: Pair,
    /// Openings up to this are contact: a rounding of α, rad.
    contact_rad: f64,
    controller: Controller,
    /// Steps that it may try.
    most_steps: u64,
    totals: Totals,
    observer: O,
    contact: Contact,
    now: Point,
    quadrature_rate: Pair,
    /// Smallest corner force of the closed joints now.
    corner_force: Option<f64>,
    /// Velocity of the top now, m/s.
    top_velocity_m_s: f64,
    stalled: u32,
    /// On which side a joint on a bed has been open since it last passed the middle.
    opened: [Pivot; 2],
    /// The switch of a formula that has turned at this instant.
    just_turned: Option<[usize; 2]>,
    /// Piece of the record the run is in, its number, and the offset reached in it, s.
    piece: Option<Piece>,
    k: usize,
    offset_s: f64,
    task: Task,
    stopped: Option<Stop>,
    /// The carried states of formulas.
    carried: Option<Box<CarriedRun>>,
}

/// What the requested step is for.
#[derive(Debug, Clone, Copy)]
enum Task {
    /// To advance, over a length in s.
    Advance { h: f64 },
    /// Up to an event inside a longer step, over a length that may grow to `most_s`.
    ReachEvent { event: Event, h: f64, most_s: f64 },
    /// Nearer to the event than this step, which left this gap.
    RefineEvent { event: Event, h: f64, most_s: f64, step: Step, gap: f64, corrections: u32 },
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

impl<O: Observer> Run<O> {
    /// A run that starts as it is placed and ends where its ground path does.
    pub fn new(simulator: &Simulator, placed: &Placed, ground: GroundPath, observer: O) -> Self {
        let mut wall = Box::new(simulator.wall.clone());
        wall.enter_branches(&placed.state, placed.crushed_rad);
        let contact = wall.with_beds_as_at(placed.contact, placed.state.theta);
        wall.enter_regime_of_state(contact, &placed.state, placed.memory);
        let carried = simulator.carried_weights_rad;
        let carried = carried.map(|weights_rad| CarriedRun::new(weights_rad, wall.formulas().carried()));
        Self {
            rest: simulator.rest.clone(),
            collapse_rad: simulator.wall.wall().collapse_rotation_rad(),
            contact_rad: f64::EPSILON * simulator.wall.wall().alpha_rad(),
            controller: simulator.controller,
            most_steps: simulator.most_steps,
            totals: simulator.totals(),
            observer,
            contact,
            carried: carried.map(Box::new),
            now: Point { position: placed.state.theta, velocity: placed.state.omega, ..Point::default() },
            quadrature_rate: [0.0; 2],
            corner_force: None,
            top_velocity_m_s: 0.0,
            stalled: 0,
            opened: [contact.ground, contact.crack],
            wall,
            ground,
            just_turned: None,
            piece: None,
            k: 0,
            offset_s: 0.0,
            task: Task::Advance { h: 0.0 },
            stopped: None,
        }
    }

    /// Starts the run; then [`Run::needs_step`] brings it to its first step.
    pub fn begin(&mut self, start_s: f64) {
        self.stopped = self.start(start_s).err();
        (self.k, self.offset_s) = self.ground.place(start_s);
        self.piece = self.ground.piece(self.k);
    }

    /// Goes by these vector instructions.
    pub fn set_level(&mut self, level: Level) {
        self.wall.set_level(level);
    }

    /// Ends the run before it starts.
    pub fn refuse(&mut self, time_s: f64, reason: String) {
        self.stopped = Some(Stop::Failed { time_s, reason });
    }

    /// Rests as long as nothing moves, and says whether a step is to be taken then. If so,
    /// [`Run::step_request`] and [`Run::finish_step`] follow. If not, the run is over: [`Run::end`].
    #[inline]
    pub fn needs_step(&mut self) -> bool {
        if self.stopped.is_some() {
            return false;
        }
        match self.advance_to_step() {
            Ok(wants) => wants,
            Err(stop) => {
                self.stopped = Some(stop);
                false
            }
        }
    }

    /// The step that is to be taken.
    #[inline]
    pub fn step_request(&self) -> StepRequest<'_> {
        let Some(piece) = &self.piece else { unreachable!("a step is asked for within a piece") };
        StepRequest {
            motion: self.wall.motion(self.contact),
            piece,
            from_s: self.offset_s,
            h: self.requested_s(),
            now: &self.now,
            quadrature_rate: self.quadrature_rate,
        }
    }

    /// Whether the next step is to advance, and not for an event.
    pub fn advances(&self) -> bool {
        matches!(self.task, Task::Advance { .. })
    }

    /// Length of the step that is to be taken, s.
    #[inline]
    fn requested_s(&self) -> f64 {
        let (Task::Advance { h } | Task::ReachEvent { h, .. } | Task::RefineEvent { h, .. }) = self.task;
        h
    }

    /// Continues with the step that was requested.
    #[inline]
    pub fn finish_step(&mut self, step: &mut Step, reactions: &Reactions) {
        let Some(piece) = self.piece else { return };
        self.totals.work.evaluations += STAGES;
        let result = match self.task {
            Task::Advance { .. } => self.advance(&piece, step, reactions),
            Task::ReachEvent { event, most_s, .. } => {
                self.refine_event(event, &piece, step, reactions, most_s, 0)
            }
            Task::RefineEvent { event, most_s, step: before, gap, corrections, .. } => {
                match self.left_to(event, &step.end) {
                    Some((left, _)) if left.abs() < gap => {
                        self.refine_event(event, &piece, step, reactions, most_s, corrections)
                    }
                    _ => {
                        self.unrefine_states();
                        let reactions = self.reactions(&before.end, piece.at(self.offset_s + before.h));
                        self.apply_event(event, &piece, &before, &reactions)
                    }
                }
            }
        };
        self.stopped = result.err();
    }

    fn state(&self) -> State {
        State { theta: self.now.position, omega: self.now.velocity }
    }

    fn start(&mut self, start_s: f64) -> Result<(), Stop> {
        let ground = self.ground.at(start_s);
        let released = self.contact;
        if self.totals.accounts {
            self.totals.energy.initial_j = self.wall.energy_j(released, &self.state());
            self.totals.energy.passed_through_j = self.totals.energy.initial_j.abs();
        }
        self.totals.rotations(start_s, &Quintic::new(&self.now, &self.now, 0.0));
        self.totals.top(self.wall.top_displacement_m(released, self.now.position), start_s);
        if (0..2).any(|i| self.now.position[i].abs() >= self.collapse_rad[i]) {
            return Err(Stop::Collapsed { time_s: start_s });
        }
        if self.closes_at_once() {
            return self.impact(self.wall.closed_edges(released), ground, start_s);
        }
        self.enter(released, ground, start_s)
    }

    /// Whether an open joint without a gap does not separate: only where a start was given so.
    fn closes_at_once(&self) -> bool {
        self.wall.joints().any(|joint| {
            let side = self.contact.at(joint).sign();
            let [gap, rate] = [self.now.position, self.now.velocity].map(|pair| side * opening(joint, pair));
            side != 0.0 && gap == 0.0 && rate <= 0.0 && self.wall.bed(joint).is_none()
        })
    }

    /// Enters the contact state that carries the joint forces, opening joints where it must.
    fn enter(&mut self, contact: Contact, ground: Vector, time_s: f64) -> Result<(), Stop> {
        let mut carried = Carried::default();
        let (next, known) =
            self.next_contact(contact, ground, &mut carried).map_err(|e| failed(time_s, &e))?;
        if next != contact {
            self.totals.opening(contact, next);
        }
        self.contact = next;
        if !known {
            carried = self.motion_now(ground);
        }
        self.enter_branches(&mut carried, ground);
        let rate = &carried.rate;
        self.totals.work.evaluations += 1;
        self.now.acceleration = rate.theta_dd;
        self.quadrature_rate = [rate.ground_power_w, rate.loss_power_w];
        self.corner_force =
            if self.shares_load_at_rest() { Some(self.reserve_at_rest(ground)) } else { carried.reserve };
        self.top_velocity_m_s = carried.top_velocity_m_s;
        Ok(())
    }

    /// Formulas go into the branches into which the motion goes, and that changes with them.
    #[inline]
    fn enter_branches(&mut self, carried: &mut Carried, ground: Vector) {
        let just_turned = self.just_turned.take();
        if !self.wall.formulas().have_switches() {
            return;
        }
        let theta_dd = carried.rate.theta_dd;
        if self.wall.turn_switches(self.contact, &self.state(), theta_dd, just_turned) {
            *carried = self.motion_now(ground);
        }
    }

    /// The motion in the contact state that the wall is in.
    fn motion_now(&self, ground: Vector) -> Carried {
        let rate = self.wall.rate(self.contact, &self.state(), ground);
        let reactions = self.reactions(&Point { acceleration: rate.theta_dd, ..self.now }, ground);
        let reserve = self.wall.smallest_reserve(self.contact, &reactions);
        Carried { rate, top_velocity_m_s: reactions.top_velocity_m_s, reserve }
    }

    /// The contact state that carries the joint forces, and whether its motion is known.
    #[inline(always)]
    fn next_contact(
        &mut self,
        contact: Contact,
        ground: Vector,
        carried: &mut Carried,
    ) -> Result<(Contact, bool), MechanicsError> {
        if self.wall.piecewise_laws().is_some() {
            return Ok((self.next_contact_by_laws(contact, ground)?, false));
        }
        self.wall.next_contact_and_motion(contact, &self.state(), ground, carried)
    }

    /// The contact state under laws at the top that have kinks.
    #[inline(never)]
    fn next_contact_by_laws(&mut self, contact: Contact, ground: Vector) -> Result<Contact, MechanicsError> {
        let Some(piecewise_laws) = self.wall.piecewise_laws().copied() else { return Ok(contact) };
        self.now.velocity = self.wall.with_slow_top_stopped(contact, &self.state());
        let state = self.state();
        if self.wall.rests_in(contact) && (piecewise_laws.remembers() || self.carried.is_some()) {
            // A spring that has yielded leans on the wall at rest, and so may a carried state.
            let Regime { plastic_m, largest_m, .. } = self.wall.regime();
            self.wall.enter_regime_of_state(
                contact,
                &state,
                TopMemory { plastic_m, largest_m, carried: None },
            );
            self.rest = RestLimits::new(&self.wall);
        }
        let rest_reserve = self.rest.reserve(ground);
        self.wall.next_contact_and_regime(&piecewise_laws, contact, &state, ground, rest_reserve)
    }

    /// Advances to where a step is to be taken; false at the end of the run.
    fn advance_to_step(&mut self) -> Result<bool, Stop> {
        // The piece is looked at where it is: to copy what was just written would wait for the writing.
        while let Some(&Piece { length_s, .. }) = self.piece.as_ref() {
            if let Task::ReachEvent { .. } | Task::RefineEvent { .. } = self.task {
                return Ok(true);
            }
            while self.offset_s < length_s {
                if !self.wall.rests_in(self.contact) || self.carried.is_some() {
                    let left_s = length_s - self.offset_s;
                    let h = self.controller.next_s(left_s);
                    self.totals.work.tolerance_steps += u64::from(h < left_s);
                    self.task = Task::Advance { h };
                    return Ok(true);
                }
                self.rest_in_piece()?;
            }
            self.k += 1;
            self.offset_s = 0.0;
            if self.observer.seen_enough() {
                return Err(Stop::SeenEnough);
            }
            if self.wall.rests_in(self.contact) && self.carried.is_none() {
                self.k = self.rest_through_pieces(self.k);
            }
            self.piece = self.ground.piece(self.k);
        }
        Ok(false)
    }

    fn reactions(&self, point: &Point, ground: Vector) -> Reactions {
        self.wall.motion(self.contact).reactions(point.position, point.velocity, point.acceleration, ground)
    }

    /// Makes the end of a step the present.
    fn keep(&mut self, start_s: f64, step: &Step, motion: &Quintic, reactions: &Reactions) {
        self.totals.work.steps += 1;
        self.totals.pattern_time_s[self.contact.index()] += step.h;
        self.totals.rotations(start_s, motion);
        self.top_displacement(start_s, motion, reactions);
        self.totals.forces(&reactions.forces);
        self.totals.energy(step.quadrature);
        self.observer.moved(start_s, self.contact, motion);
        self.keep_states();
        self.now = step.end;
        self.quadrature_rate = step.end_quadrature_rate;
        if self.wall.is_held() {
            // The error of a step, which would have it slide.
            self.now.velocity =
                self.wall.with_top_stopped(self.contact, self.now.position, self.now.velocity);
        }
    }

    /// Raises the largest top displacement, between the ends of the step too where the top turns back inside.
    fn top_displacement(&mut self, start_s: f64, motion: &Quintic, reactions: &Reactions) {
        self.totals.top(reactions.top_displacement_m, start_s + motion.h());
        let (before, now) = (self.top_velocity_m_s, reactions.top_velocity_m_s);
        self.top_velocity_m_s = now;
        // Twice as far from the end as at both speeds together is farther than it gets.
        let most_m = reactions.top_displacement_m.abs() + 2.0 * (before.abs() + now.abs()) * motion.h();
        if before * now < 0.0 && most_m > self.totals.top_max.value.abs() {
            // The velocity is all but linear over the little that is left of a swing.
            let share = before / (before - now);
            let x_c = self.wall.top_displacement_m(self.contact, motion.position(share));
            self.totals.top(x_c, start_s + share * motion.h());
        }
    }
}

fn failed(time_s: f64, error: &MechanicsError) -> Stop {
    Stop::Failed { time_s, reason: error.to_string() }
}

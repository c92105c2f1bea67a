//! The loop of one run: stand, move, open, strike, until the end.

mod meeting;
mod standing;
mod step;

use super::events::Event;
use super::ground_path::{GroundPath, Piece};
use super::history::Observer;
use super::response::{Outcome, Peak, Response};
use super::rest::RestLimits;
use super::simulator::{Placed, Simulator};
use super::tally::Tally;
use crate::model::{
    Aftermath, Contact, MechanicsError, MotionRate, Pair, RockingWall, State, Touching, Vector, opening,
};
use crate::solver::{Controller, Point, Quintic, STAGES, Step};
pub(super) use step::Asked;

/// A contact state, and the motion in it where that is known.
type Settled = (Contact, Option<(MotionRate, Aftermath)>);

/// Where the run stands.
pub(super) struct Run<O> {
    wall: RockingWall,
    ground: GroundPath,
    rest: RestLimits,
    collapse_rad: Pair,
    controller: Controller,
    tally: Tally,
    observer: O,
    contact: Contact,
    now: Point,
    quadrature_rate: Pair,
    /// Smallest corner force of the closed joints now.
    corner_force: Option<f64>,
    /// Velocity of the top now, m/s.
    top_velocity_m_s: f64,
    stalled: u32,
    /// Piece of the record the run is in, its number, and the offset reached in it, s.
    piece: Option<Piece>,
    k: usize,
    offset_s: f64,
    doing: Doing,
    stopped: Option<Stop>,
}

/// What the step is for that a run has asked for.
#[derive(Debug, Clone, Copy)]
enum Doing {
    /// To get on: over a length in s.
    On { h: f64 },
    /// Up to where a longer step met an event: over a length, which may grow to `most_s`.
    Meeting { event: Event, h: f64, most_s: f64 },
    /// Nearer to the event than this step was, whose gap was so large.
    Nearing { event: Event, h: f64, most_s: f64, step: Step, gap: f64, corrections: u32 },
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
            piece: None,
            k: 0,
            offset_s: 0.0,
            doing: Doing::On { h: 0.0 },
            stopped: None,
        }
    }

    /// The run that was begun, to its end, step by step.
    pub fn go(mut self) -> Response {
        let mut after = Aftermath::default();
        while self.wants_step() {
            let step = self.asked().take(&mut after);
            self.answer(&step, &after);
        }
        self.end()
    }

    /// Starts the run; then [`Run::wants_step`] tells how it goes on.
    pub fn begin(&mut self, start_s: f64) {
        self.stopped = self.start(start_s).err();
        (self.k, self.offset_s) = self.ground.place(start_s);
        self.piece = self.ground.piece(self.k);
    }

    /// Ends the run before it starts.
    pub fn refuse(&mut self, time_s: f64, reason: String) {
        self.stopped = Some(Stop::Failed { time_s, reason });
    }

    /// Stands as long as nothing moves; whether a step is to be taken then: [`Run::asked`], [`Run::answer`]. If not, the run
    /// is over: [`Run::end`].
    #[inline]
    pub fn wants_step(&mut self) -> bool {
        if self.stopped.is_some() {
            return false;
        }
        match self.go_on() {
            Ok(wants) => wants,
            Err(stop) => {
                self.stopped = Some(stop);
                false
            }
        }
    }

    /// The step that is to be taken.
    #[inline]
    pub fn asked(&self) -> Asked<'_> {
        let (Doing::On { h } | Doing::Meeting { h, .. } | Doing::Nearing { h, .. }) = self.doing;
        let Some(piece) = &self.piece else { unreachable!("a step is asked for within a piece") };
        Asked {
            law: self.wall.motion(self.contact),
            piece,
            from_s: self.offset_s,
            h,
            now: &self.now,
            quadrature_rate: self.quadrature_rate,
        }
    }

    /// Goes on with the step that was asked for.
    #[inline]
    pub fn answer(&mut self, step: &Step, after: &Aftermath) {
        let Some(piece) = self.piece else { return };
        self.tally.work.evaluations += STAGES;
        let told = match self.doing {
            Doing::On { .. } => self.advance(&piece, step, after),
            Doing::Meeting { event, most_s, .. } => self.onto_event(event, &piece, *step, most_s, 0),
            Doing::Nearing { event, most_s, step: before, gap, corrections, .. } => {
                match self.left_to(event, &step.end) {
                    Some((left, _)) if left.abs() < gap => {
                        self.onto_event(event, &piece, *step, most_s, corrections)
                    }
                    _ => self.met(event, &piece, &before),
                }
            }
        };
        self.stopped = told.err();
    }

    pub fn end(mut self) -> Response {
        let outcome = match self.stopped.take() {
            None | Some(Stop::SeenEnough) => Outcome::Stood,
            Some(Stop::Collapsed { time_s }) => Outcome::Collapsed { time_s },
            Some(Stop::Failed { time_s, reason }) => Outcome::Failed { time_s, reason },
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
        let (settled, known) = self.settle(contact, ground).map_err(|e| failed(time_s, &e))?;
        if settled != contact {
            self.tally.opening(contact, settled);
        }
        self.contact = settled;
        let (rate, after) = known.unwrap_or_else(|| {
            let rate = self.wall.rate(settled, &self.state(), ground);
            (rate, self.aftermath(&Point { acceleration: rate.theta_dd, ..self.now }, ground))
        });
        self.tally.work.evaluations += 1;
        self.now.acceleration = rate.theta_dd;
        self.quadrature_rate = [rate.ground_power_w, rate.loss_power_w];
        self.corner_force = self.wall.least_hold(settled, &after);
        self.top_velocity_m_s = after.top_velocity_m_s;
        Ok(())
    }

    /// The contact state that carries the joint forces, with its motion where that is known.
    fn settle(&mut self, contact: Contact, ground: Vector) -> Result<Settled, MechanicsError> {
        let Some(restraint) = self.wall.restraint().copied() else {
            return self.wall.settled(contact, &self.state(), ground);
        };
        self.now.velocity = self.wall.come_to_stand(contact, &self.state());
        let state = self.state();
        if contact == Contact::REST && restraint.yields() {
            // A spring that has yielded leans on the wall at rest.
            self.wall.place_top(contact, &state, self.wall.regime().plastic_m);
            self.rest = RestLimits::new(&self.wall);
        }
        let rest_hold = self.rest.hold(ground);
        let settled = self.wall.settle_restrained(&restraint, contact, &state, ground, rest_hold)?;
        Ok((settled, None))
    }

    /// Goes on to where a step is to be taken; false at the end of the record and its free motion.
    fn go_on(&mut self) -> Result<bool, Stop> {
        // The piece is looked at where it is: to copy what was just written would wait for the writing.
        while let Some(&Piece { length_s, .. }) = self.piece.as_ref() {
            if let Doing::Meeting { .. } | Doing::Nearing { .. } = self.doing {
                return Ok(true);
            }
            while self.offset_s < length_s {
                if self.contact != Contact::REST {
                    self.doing = Doing::On { h: self.controller.next_s(length_s - self.offset_s) };
                    return Ok(true);
                }
                self.stand_in_piece()?;
            }
            self.k += 1;
            self.offset_s = 0.0;
            if self.observer.seen_enough() {
                return Err(Stop::SeenEnough);
            }
            if self.contact == Contact::REST {
                self.k = self.stand_through(self.k);
            }
            self.piece = self.ground.piece(self.k);
        }
        Ok(false)
    }

    fn aftermath(&self, point: &Point, ground: Vector) -> Aftermath {
        self.wall.motion(self.contact).aftermath(point.position, point.velocity, point.acceleration, ground)
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

    fn response(mut self, outcome: Outcome) -> Response {
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

fn failed(time_s: f64, error: &MechanicsError) -> Stop {
    Stop::Failed { time_s, reason: error.to_string() }
}

//! A step, or the part of it up to its first event: found, located, applied.

use std::ops::ControlFlow;

use super::super::events::{EdgeEvent, Event, first_event, first_kink, left_to_kink, sooner};
use super::super::ground_path::Piece;
use super::super::history::Observer;
use super::super::response::Work;
use super::super::row::Row;
use super::{Run, Stop, Task, failed};
use crate::model::{Contact, Joint, Kink, Pair, Reactions, State, Touching, Vector, opening};
use crate::solver::{Controller, Point, Quintic, STAGES, Step};

/// An opening is placed this share of a sample step after the instant its corner force vanishes. So the joint
/// does accelerate apart, and nothing moves by more than roundings.
pub(super) const AFTER_OPENING: f64 = 1e-9;

/// A share of a sample step so short that a parabola is exact over it. Its cube times any jerk of a wall is
/// below roundings. A share and no time, so that a wall four times as large moves the same to the bit.
pub(in super::super) const SHORT: f64 = 2e-7;
/// Newton corrections of an event's time; one suffices but for grazing impacts.
const MOST_CORRECTIONS: u32 = 4;

/// Events without progress, one after another, that count as a defect. The longest burst of impacts takes
/// some ten thousand until rest. It is that of a wall sixty times as high as thick with a capture velocity of
/// zero.
const MOST_EVENTS_AT_ONCE: u32 = 50_000;
/// Turns of a formula's switch without progress from which steps are made shorter. Where a force rises steeply about zero velocity, steps
/// that are too long for it swing to either side, by less than their error may be, and each of these is a turn.
const MOST_TURNS_AT_ONCE: u32 = 8;
/// Progress, as a share of a sample step, that an event must make not to count as stalled.
pub(in super::super) const PROGRESS: f64 = 1e-6;

/// A step in which nothing happens.
struct Quiet {
    step: Step,
    motion: Quintic,
    /// It has accepted the step.
    controller: Controller,
    /// Smallest corner force of the closed joints at its end.
    end_force: Option<f64>,
}

impl<O: Observer> Run<O> {
    /// Steps that the run may still try. Looked at where a step is not kept, as some never are of a motion that changes too fast.
    pub(super) fn steps_left(&self) -> u64 {
        let Work { steps, rejected_steps, .. } = self.totals.work;
        self.most_steps.saturating_sub(steps + rejected_steps)
    }

    /// Keeps a step, or requests one up to the first event inside it.
    ///
    /// That shorter step is taken for its accuracy. To go on from the path inside the longer one, bent so that it has the acceleration of
    /// the equations of motion in its middle, was tried: it spared 4 % of the evaluations on sharp edges and 1 % of the time side by side,
    /// and errors doubled.
    #[inline]
    pub(super) fn advance(&mut self, piece: &Piece, step: &Step, reactions: &Reactions) -> Result<(), Stop> {
        if !self.controller.accepts(step) {
            self.totals.work.rejected_steps += 1;
            let time_s = piece.start_s + self.offset_s;
            if time_s + step.h == time_s {
                let reason = format!("no step is short enough in pattern {}", self.contact.name());
                return Err(Stop::Failed { time_s, reason });
            }
            if self.steps_left() == 0 {
                let reason = format!(
                    "after {} steps: the motion changes too fast to be followed in pattern {}",
                    self.most_steps,
                    self.contact.name()
                );
                return Err(Stop::Failed { time_s, reason });
            }
            return Ok(());
        }
        let from_s = self.offset_s;
        let motion = Quintic::new(&step.start, &step.end, step.h);
        let end_force = match self.shares_load_at_rest() {
            true => Some(self.reserve_at_rest(piece.at(from_s + step.h))),
            false => self.wall.smallest_reserve(self.contact, reactions),
        };
        let corner_force = (self.corner_force, end_force);
        let event = self.first_event(&motion, corner_force, piece, from_s);
        let carried = self.carried.as_ref().map(|carried| &carried.step);
        let kink = first_kink(&self.wall, self.contact, [&step.start, &step.end], step.h, carried);
        let kink = kink.map(|(kink, share)| (Event::Kink(kink), share));
        // What happens to the joints goes first.
        let event = event.map(|(event, share)| (self.on_edges(event.into()), share));
        let event = sooner(event, kink);
        match sooner(event, self.first_bed_change(step, &motion)) {
            None => {
                self.keep_whole(piece, step, &motion, reactions, end_force);
                Ok(())
            }
            Some((event, share)) => self.approach_event(event, share, piece, step.h),
        }
    }

    /// Keeps a step in which nothing happens.
    #[inline]
    fn keep_whole(
        &mut self,
        piece: &Piece,
        step: &Step,
        motion: &Quintic,
        reactions: &Reactions,
        end_force: Option<f64>,
    ) {
        let from_s = self.offset_s;
        self.corner_force = end_force;
        self.keep(piece.start_s + from_s, step, motion, reactions);
        self.stalled = 0;
        // The end of a piece is reached exactly, not up to a rounding.
        let reached = step.h == piece.length_s - from_s;
        self.offset_s = if reached { piece.length_s } else { from_s + step.h };
    }

    /// What happens first to the joints, and a collapse.
    #[inline]
    fn first_event(
        &self,
        motion: &Quintic,
        corner_force: (Option<f64>, Option<f64>),
        piece: &Piece,
        from_s: f64,
    ) -> Option<(EdgeEvent, f64)> {
        let force_at =
            |share: f64| self.corner_force_within(motion, share, piece.at(from_s + share * motion.h()));
        first_event(self.wall.edges_of(self.contact), motion, self.collapse_rad, corner_force, force_at)
    }

    /// Goes through a step that a row has taken in a lane and not kept. It has alighted after that, from the contact state that is
    /// given; none where it stays aboard and a step is requested up to an event inside this one.
    pub fn goes_through(&mut self, row: &mut Row, i: usize) -> Option<Contact> {
        let advances = row.limits.advances[i] == 1.0;
        let found = if advances { self.look_in(row, i) } else { ControlFlow::Continue(None) };
        let ControlFlow::Continue(quiet) = found else { return None };
        self.alight(row, i);
        let in_lane = self.contact;
        match quiet {
            Some(quiet) => self.keep_quiet(&quiet, &row.landed.reactions(i)),
            None => self.finish_step(&mut row.step(i), &row.landed.reactions(i)),
        }
        Some(in_lane)
    }

    /// Looks for events inside a step to advance, and breaks off where it requests a step up to the first of them in the lane. Gives the
    /// step where nothing happens in it; nothing where the run must go through it by itself.
    fn look_in(&mut self, row: &mut Row, i: usize) -> ControlFlow<(), Option<Quiet>> {
        self.follow_lane(row, i);
        let (step, piece, from_s) = (row.step(i), row.ground.at(i), row.ground.offset_s[i]);
        let has_kinks = self.wall.piecewise_laws().is_some() || self.wall.formulas().have_switches();
        if has_kinks {
            return ControlFlow::Continue(None);
        }
        let mut controller = self.controller;
        row.errors.tell(i, &mut controller);
        if !controller.accepts(&step) {
            return ControlFlow::Continue(None);
        }
        let motion = Quintic::new(&step.start, &step.end, step.h);
        let end_force = self.wall.smallest_reserve(self.contact, &row.landed.reactions(i));
        let corner_force = (self.corner_force.map(|_| row.limits.corner_force[i]), end_force);
        let event = self.first_event(&motion, corner_force, &piece, from_s);
        let mut event = event.map(|(event, share)| (Event::from(event), share));
        if self.wall.wall().rolls() {
            event = event.map(|(event, share)| (self.on_edges(event), share));
            event = sooner(event, self.first_bed_change(&step, &motion));
            if let Some((Event::Bed(_), 0.0)) = event {
                // It changes where it is.
                return ControlFlow::Continue(None);
            }
        }
        let Some((event, share)) = event else {
            return ControlFlow::Continue(Some(Quiet { step, motion, controller, end_force }));
        };
        self.totals.work.evaluations += STAGES;
        row.errors.put(i, &controller);
        self.request_up_to(event, share, step.h);
        self.board_task(row, i);
        ControlFlow::Break(())
    }

    /// Keeps a step in which nothing happens, of a run that has alighted after it.
    fn keep_quiet(&mut self, quiet: &Quiet, reactions: &Reactions) {
        let Some(piece) = self.piece else { return };
        self.totals.work.evaluations += STAGES;
        self.controller = quiet.controller;
        self.keep_whole(&piece, &quiet.step, &quiet.motion, reactions, quiet.end_force);
    }

    fn corner_force_within(&self, motion: &Quintic, share: f64, ground: Vector) -> f64 {
        if self.carried.is_some() {
            return self.corner_force_with_states(motion, share, ground);
        }
        let equations = self.wall.motion(self.contact);
        let (_, reactions) =
            equations.rate_and_reactions_at(motion.position(share), motion.velocity(share), ground);
        self.wall.smallest_reserve(self.contact, &reactions).unwrap_or(f64::INFINITY)
    }

    /// Requests a step up to the event.
    fn approach_event(&mut self, event: Event, share: f64, piece: &Piece, whole_s: f64) -> Result<(), Stop> {
        if let (Event::Bed(change), true) = (event, share == 0.0) {
            self.rewind_states();
            let from_s = self.offset_s;
            self.progress(0.0, piece.start_s + from_s)?;
            return self.change_contact(change, piece.at(from_s), piece.start_s + from_s);
        }
        if let (Event::Kink(kink), true) = (event, share == 0.0) {
            self.rewind_states();
            let from_s = self.offset_s;
            return self.pass_kink(kink, piece.at(from_s), piece.start_s + from_s);
        }
        self.request_up_to(event, share, whole_s);
        Ok(())
    }

    fn request_up_to(&mut self, event: Event, share: f64, whole_s: f64) {
        let mut h = share * whole_s;
        if matches!(event, Event::Opening) {
            h = (h + AFTER_OPENING * self.ground.step_s()).min(whole_s);
        }
        self.task = Task::ReachEvent { event, h, most_s: whole_s };
    }

    /// Applies the event at the end of a step.
    pub(super) fn apply_event(
        &mut self,
        event: Event,
        piece: &Piece,
        step: &Step,
        reactions: &Reactions,
    ) -> Result<(), Stop> {
        self.task = Task::Advance { h: 0.0 };
        let from_s = self.offset_s;
        let to_s = from_s + step.h;
        let (start_s, time_s) = (piece.start_s + from_s, piece.start_s + to_s);
        self.progress(step.h, time_s)?;
        if matches!(event, Event::Kink(Kink::Turns { .. })) && self.stalled > MOST_TURNS_AT_ONCE {
            self.controller.shorten();
        }
        self.keep(start_s, step, &Quintic::new(&step.start, &step.end, step.h), reactions);
        match event {
            Event::Collapse => return Err(Stop::Collapsed { time_s }),
            Event::Opening => self.enter(self.contact, piece.at(to_s), time_s)?,
            Event::Kink(kink) => self.pass_kink(kink, piece.at(to_s), time_s)?,
            Event::Bed(change) => self.change_contact(change, piece.at(to_s), time_s)?,
            Event::Impact(touching) => self.impact(touching, piece.at(to_s), time_s)?,
        }
        self.offset_s = to_s.min(piece.length_s);
        Ok(())
    }

    /// What is left to an event at an instant, and its rate. `None` for events that a share of a step locates
    /// well enough.
    #[inline]
    pub(super) fn left_to(&self, event: Event, at: &Point) -> Option<(f64, f64)> {
        if let Event::Kink(kink) = event {
            return Some(left_to_kink(&self.wall, self.contact, kink, at));
        }
        if let Event::Bed(change) = event {
            return Some(change.left(at));
        }
        let [lower, upper] = event.gap()?;
        let of = |pair: Pair| lower * pair[0] + upper * pair[1];
        Some((of(at.position), of(at.velocity)))
    }

    /// Enters the regime beyond a kink of the laws at the top.
    fn pass_kink(&mut self, kink: Kink, ground: Vector, time_s: f64) -> Result<(), Stop> {
        if matches!(kink, Kink::Stops { .. }) {
            self.now.velocity =
                self.wall.with_top_stopped(self.contact, self.now.position, self.now.velocity);
        }
        if let Kink::Turns { formula, switch } = kink {
            self.just_turned = Some([formula, switch]);
        }
        self.wall.pass_kink(kink, self.contact, self.now.position);
        self.progress(0.0, time_s)?;
        self.enter(self.contact, ground, time_s)
    }

    /// Moves the end of a step onto the zero of what is left to an event. The quintic that found the event is
    /// only as accurate as the step.
    ///
    /// To roundings whatever the tolerance. In a burst of ever smaller impacts a flight is short and slow.
    /// What is small beside the wall's rotation is not small beside the flight. Not beyond the step that was
    /// searched: behind it may lie the end of the piece.
    #[inline]
    pub(super) fn refine_event(
        &mut self,
        event: Event,
        piece: &Piece,
        step: &mut Step,
        reactions: &Reactions,
        most_s: f64,
        corrections: u32,
    ) -> Result<(), Stop> {
        let left = if corrections < MOST_CORRECTIONS { self.left_to(event, &step.end) } else { None };
        if let Some((gap, rate)) = left {
            let late_s = gap / rate;
            let h = (step.h - late_s).min(most_s);
            if late_s.abs() <= SHORT * self.ground.step_s() {
                step.end = step.end.after(-late_s);
                step.h -= late_s;
                self.move_end_of_states(-late_s);
                let reactions =
                    self.reactions_after(reactions, -late_s, &step.end, piece.at(self.offset_s + step.h));
                return self.apply_event(event, piece, step, &reactions);
            } else if h > 0.0 && h < 2.0 * step.h {
                let (gap, corrections) = (gap.abs(), corrections + 1);
                self.refine_states();
                self.task = Task::RefineEvent { event, h, most_s, step: *step, gap, corrections };
                return Ok(());
            }
        }
        self.apply_event(event, piece, step, reactions)
    }

    /// The reactions a short time after those at the end of a step. Forces are left as they were where neither raises a
    /// largest one. Beds, kinks and formulas may be stiffer than that says.
    #[inline]
    fn reactions_after(&self, reactions: &Reactions, short_s: f64, end: &Point, ground: Vector) -> Reactions {
        let stiff = self.wall.wall().gives() || self.wall.piecewise_laws().is_some();
        if stiff || !self.wall.formulas().is_empty() || !self.totals.surely_outdo(&reactions.forces) {
            return self.reactions(end, ground);
        }
        let Reactions { top_displacement_m, top_velocity_m_s, top_acceleration_m_s2, .. } = *reactions;
        Reactions {
            top_displacement_m: top_displacement_m + short_s * top_velocity_m_s,
            top_velocity_m_s: top_velocity_m_s + short_s * top_acceleration_m_s2,
            ..*reactions
        }
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

    /// An impact: joints that touch close exactly, velocities change, the contact state follows.
    pub(super) fn impact(&mut self, touching: Touching, ground: Vector, time_s: f64) -> Result<(), Stop> {
        let touching = Touching {
            ground: self.touches(Joint::Ground, touching.ground),
            crack: self.touches(Joint::Crack, touching.crack),
        };
        let edges = self.wall.edges_of(self.contact);
        let sign = |joint: Joint| edges.at(joint).sign();
        let [ground_gap, crack_gap] =
            [Joint::Ground, Joint::Crack].map(|joint| sign(joint) * opening(joint, self.now.position));
        let [mut lower, mut upper] = self.now.position;
        if touching.ground || ground_gap < 0.0 {
            lower = 0.0;
        }
        if touching.crack || crack_gap < 0.0 {
            upper = lower;
        }
        self.now.position = [lower, upper];
        if touching == self.wall.closed_edges(self.contact) {
            // A flight lower than the error of a step: the root was thought to be where the joint still opens.
            return self.enter(self.contact, ground, time_s);
        }
        let state = State { theta: [lower, upper], omega: self.now.velocity };
        let impact = self.wall.impact(self.contact, touching, &state).map_err(|e| failed(time_s, &e))?;
        self.totals.impact(&impact);
        self.now.velocity = impact.omega;
        self.enter(impact.contact, ground, time_s)
    }

    /// Whether a joint takes part in an impact. It does not separate, and it closes or is within a rounding
    /// of contact. Its own impact would else follow at the same instant.
    fn touches(&self, joint: Joint, closes: bool) -> bool {
        if self.wall.bed(joint).is_some() {
            return false;
        }
        let sign = self.contact.at(joint).sign();
        let gap = sign * opening(joint, self.now.position);
        let reached = closes || gap <= self.contact_rad;
        reached && sign * opening(joint, self.now.velocity) <= 0.0
    }
}

//! A step of a wall whose formulas carry states along, and where these are after it.
//!
//! While a step is looked at, the formulas of the wall have the states of its end. They go back to those of its start where it is
//! not kept.

use super::super::ground_path::Piece;
use super::super::history::Observer;
use super::super::rest::RestLimits;
use super::{Run, Stop, Task};
use crate::model::{CarriedStates, MOST_CARRIED, Motion, MotionRate, Reactions, Vector};
use crate::solver::{Beside, Field, Nystrom, Point, Quintic, Rate, Step};

/// Steps without an event within one sample of a record after which a state counts as too fast to be followed. One that decays
/// within a thousandth of a sample takes some hundreds, or some thousands at the tightest tolerances.
const MOST_STEPS_IN_PIECE: u32 = 20_000;

/// Carried states at both ends of a step, and their rates there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in super::super) struct CarriedStep {
    start: CarriedStates,
    start_rate: CarriedStates,
    end: CarriedStates,
    end_rate: CarriedStates,
    h: f64,
}

impl CarriedStep {
    /// The states at a share of the step: the cubic through values and rates at both ends.
    pub fn at(&self, share: f64) -> CarriedStates {
        let left = 1.0 - share;
        let [of_start, of_end] = [left * left * (1.0 + 2.0 * share), share * share * (1.0 + 2.0 * left)];
        let [of_start_rate, of_end_rate] = [self.h * share * left * left, -self.h * share * share * left];
        std::array::from_fn(|i| {
            of_start * self.start[i]
                + of_end * self.end[i]
                + of_start_rate * self.start_rate[i]
                + of_end_rate * self.end_rate[i]
        })
    }
}

/// What a run keeps of the carried states.
#[derive(Debug, Clone)]
pub(super) struct CarriedRun {
    /// Rotation of the lower body that a unit of each turns the wall by, rad.
    weights_rad: CarriedStates,
    /// The states now.
    pub now: CarriedStates,
    /// The step that was taken last, and the one before, where it is refined.
    pub step: CarriedStep,
    before: CarriedStep,
    /// Number of the piece of the record, and steps taken in it.
    piece: usize,
    steps: u32,
}

impl CarriedRun {
    pub fn new(weights_rad: CarriedStates, now: CarriedStates) -> Self {
        let step = CarriedStep::default();
        Self { weights_rad, now, step, before: step, piece: 0, steps: 0 }
    }
}

impl<O: Observer> Run<O> {
    /// Takes the step that is asked for, alone, and goes on with it.
    #[inline]
    pub fn step_alone(&mut self, reactions: &mut Reactions) {
        if self.carried.is_some() {
            return self.step_with_states(reactions);
        }
        let mut step = self.step_request().take(reactions);
        self.finish_step(&mut step, reactions);
    }

    #[cold]
    fn step_with_states(&mut self, reactions: &mut Reactions) {
        let mut step = self.take_with_states(reactions);
        self.finish_step(&mut step, reactions);
        self.rewind_states();
        if self.stopped.is_none() {
            self.stopped = self.states_fail();
        }
    }

    fn take_with_states(&mut self, reactions: &mut Reactions) -> Step {
        let (Some(piece), Some(carried)) = (self.piece, &mut self.carried) else {
            unreachable!("a step is asked for within a piece, of a wall that carries states")
        };
        let (Task::Advance { h } | Task::ReachEvent { h, .. } | Task::RefineEvent { h, .. }) = self.task;
        let (from_s, now, start) = (self.offset_s, self.now, carried.now);
        self.wall.put_carried(&start);
        let start_rate = self.wall.carried_rates(self.contact, now.position, now.velocity);
        let motion = self.wall.motion_mut(self.contact);
        let mut field = CarryingField { motion, piece, from_s, reactions };
        let none = [0.0; MOST_CARRIED];
        let [x, v] = [Beside::new(now.position, none), Beside::new(now.velocity, start)];
        let rate = Rate {
            acceleration: Beside::new(now.acceleration, start_rate),
            quadrature: Beside::new(self.quadrature_rate, none),
        };
        let stride = Nystrom::stride(x, v, rate, h, &mut field);
        let (end, end_rate) = (stride.velocity.beside(), stride.end.acceleration.beside());
        carried.step = CarriedStep { start, start_rate, end, end_rate, h };
        self.wall.put_carried(&end);
        // An error of a state is that of the rotation that it makes. What is no number is an error without a size.
        let errors = stride.velocity_error.beside().into_iter().zip(carried.weights_rad);
        let of_states = errors.map(|(error, weight)| (error * weight).abs());
        let [mut lower, upper] = stride.position_error.motion.to_array();
        for error in of_states {
            lower = if error.is_finite() { lower.abs().max(error) } else { f64::INFINITY };
        }
        Step {
            h,
            start: now,
            end: Point {
                position: stride.position.motion.to_array(),
                velocity: stride.velocity.motion.to_array(),
                acceleration: stride.end.acceleration.motion.to_array(),
            },
            quadrature: stride.quadrature.motion.to_array(),
            end_quadrature_rate: stride.end.quadrature.motion.to_array(),
            position_error: [lower, upper],
            velocity_error: stride.velocity_error.motion.to_array(),
        }
    }

    /// Why the states end a run.
    fn states_fail(&mut self) -> Option<Stop> {
        let time_s = self.piece.as_ref().map_or(0.0, |piece| piece.start_s) + self.offset_s;
        if let Some(reason) = self.wall.formulas().left_range() {
            return Some(Stop::Failed { time_s, reason });
        }
        let (carried, k) = (self.carried.as_mut()?, self.k);
        // A burst of impacts takes its steps whatever the states do.
        if !matches!(self.task, Task::Advance { .. }) || carried.piece != k {
            (carried.piece, carried.steps) = (k, 0);
        }
        carried.steps += 1;
        (carried.steps > MOST_STEPS_IN_PIECE).then(|| {
            let reason = format!(
                "more than {MOST_STEPS_IN_PIECE} steps within one sample without an event: a carried state changes too fast to be followed"
            );
            Stop::Failed { time_s, reason }
        })
    }

    /// The states at the end of a step that is kept are those now.
    #[inline]
    pub(super) fn keep_states(&mut self) {
        if let Some(carried) = &mut self.carried {
            carried.now = carried.step.end;
        }
    }

    /// Goes back to the states now.
    #[inline]
    pub(super) fn rewind_states(&mut self) {
        if let Some(carried) = &self.carried {
            self.wall.put_carried(&carried.now);
        }
    }

    /// Keeps the step that was taken, which is to be refined.
    #[inline]
    pub(super) fn refine_states(&mut self) {
        if let Some(carried) = &mut self.carried {
            carried.before = carried.step;
        }
    }

    /// Goes back to the step that was refined.
    #[inline]
    pub(super) fn unrefine_states(&mut self) {
        if let Some(carried) = &mut self.carried {
            carried.step = carried.before;
            self.wall.put_carried(&carried.step.end);
        }
    }

    /// Moves the end of a step by a time so short that rates do not change over it.
    #[inline]
    pub(super) fn move_end_of_states(&mut self, by_s: f64) {
        if let Some(carried) = &mut self.carried {
            let CarriedStep { end, end_rate, h, .. } = &mut carried.step;
            end.iter_mut().zip(end_rate).for_each(|(end, rate)| *end += by_s * *rate);
            *h += by_s;
            self.wall.put_carried(&carried.step.end);
        }
    }

    /// Whether friction and corners share the load of a wall at rest whose states move on.
    pub(super) fn shares_load_at_rest(&self) -> bool {
        let rubs = self.wall.piecewise_laws().is_some_and(|laws| laws.rubs());
        self.carried.is_some() && rubs && self.wall.rests_in(self.contact)
    }

    /// What holds such a wall at rest, over its weight.
    pub(super) fn reserve_at_rest(&self, ground: Vector) -> f64 {
        RestLimits::new(&self.wall).reserve_by_friction(ground) * self.wall.per_weight()
    }

    /// The least that holds the contact state at a share of the step that was taken with states.
    #[cold]
    pub(super) fn corner_force_with_states(&self, motion: &Quintic, share: f64, ground: Vector) -> f64 {
        let Some(carried) = &self.carried else { return f64::INFINITY };
        let at = carried.step.at(share);
        if self.shares_load_at_rest() {
            let mut wall = self.wall.clone();
            wall.put_carried(&at);
            return RestLimits::new(&wall).reserve_by_friction(ground) * wall.per_weight();
        }
        let mut equations = self.wall.motion(self.contact).clone();
        equations.put_carried(&at);
        let (_, reactions) =
            equations.rate_and_reactions_at(motion.position(share), motion.velocity(share), ground);
        self.wall.smallest_reserve(self.contact, &reactions).unwrap_or(f64::INFINITY)
    }
}

/// The motion of a contact state with carried states, under a piece of the record.
struct CarryingField<'a, 'b> {
    motion: &'a mut Motion,
    piece: Piece,
    from_s: f64,
    reactions: &'b mut Reactions,
}

impl CarryingField<'_, '_> {
    fn rate_by(
        &mut self,
        after_s: f64,
        [position, velocity]: [Beside; 2],
        of: impl FnOnce(&Motion, [[f64; 2]; 2], Vector) -> (MotionRate, Option<Reactions>),
    ) -> Rate<Beside> {
        let ground = self.piece.at(self.from_s + after_s);
        self.motion.put_carried(&velocity.beside());
        let moving = [position.motion.to_array(), velocity.motion.to_array()];
        let (rate, reactions) = of(self.motion, moving, ground);
        if let Some(reactions) = reactions {
            *self.reactions = reactions;
        }
        let powers_w = [rate.ground_power_w, rate.loss_power_w];
        Rate {
            acceleration: Beside::new(rate.theta_dd, self.motion.carried_rates(moving)),
            quadrature: Beside::new(powers_w, [0.0; MOST_CARRIED]),
        }
    }
}

impl Field<Beside> for CarryingField<'_, '_> {
    fn rate(&mut self, after_s: f64, position: Beside, velocity: Beside) -> Rate<Beside> {
        self.rate_by(after_s, [position, velocity], |motion, [theta, omega], ground| {
            (motion.rate(theta, omega, ground), None)
        })
    }

    fn land(&mut self, after_s: f64, position: Beside, velocity: Beside) -> Rate<Beside> {
        self.rate_by(after_s, [position, velocity], |motion, [theta, omega], ground| {
            let (rate, reactions) = motion.rate_and_reactions_at(theta, omega, ground);
            (rate, Some(reactions))
        })
    }
}

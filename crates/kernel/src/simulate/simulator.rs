//! A wall and a shaking made ready once, for the whole run or for many windows of it.

use super::ground_path::GroundPath;
use super::history::Observer;
use super::response::Response;
use super::rest::RestLimits;
use super::run::Run;
use super::side_by_side::Prepared;
use super::totals::Totals;
use super::{Accuracy, Shaking};
use crate::model::{
    CarriedStates, Contact, Joint, Pivot, RockingWall, State, TopMemory, Vector, Wall, opening,
};
use crate::solver::{Controller, ErrorScale};

/// Error of a step allowed, as a share of the error of a run. Impacts magnify what is there before them. With
/// it, well-conditioned runs at tolerances of 1e-4 to 1e-8 end within a tenth of them (`convergence` in the
/// tests). Three times as much would save 6 % of the evaluations of façades at 1e-6. Runs at 1e-8 would then
/// end within three tenths.
const STEP_SHARE: f64 = 1e-3;

/// The same for walls on beds, whose stiff contact magnifies errors as well.
const STEP_SHARE_ON_BEDS: f64 = 1e-2 * STEP_SHARE;

/// From where a window of a run starts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Start {
    /// Time in the record, s, 0 or more.
    pub time_s: f64,
    /// Rotations (rad) and angular velocities (rad/s) of the bodies; any values, such as measured ones.
    pub state: State,
    /// Contact state; `None`: that of the rotations, and where they are zero of the velocities
    /// ([`Contact::of_state`]).
    ///
    /// A state that does not fit is moved onto it. In pattern 3 both bodies take their mean, in pattern 4 the
    /// lower body does not turn. A joint open on the other side is about to open, or closes at once.
    pub contact: Option<Contact>,
    /// Plastic displacement of a yielding spring at the top, m; [`Wall::plastic_displacement_m`] follows it.
    /// A wall without such a spring has no use for it. Friction needs no memory: a top at rest sticks where
    /// it can.
    pub plastic_displacement_m: f64,
    /// The largest rotations so far of the joint at the ground and of that at the crack, each to the right and to the
    /// left, rad, without sign: what a joint that crushes remembers. Others have no use for it.
    pub crushed_rad: [[f64; 2]; 2],
    /// The largest |x_C| before, m, which formulas may depend on (`x_max`). Where the start is farther out, that is it.
    pub largest_displacement_m: f64,
    /// The carried states of formulas, in the order of the formulas and of their names there, each in its unit; `None`: as they
    /// start.
    pub carried: Option<CarriedStates>,
}

impl Start {
    /// In a state at a time in s, with what the laws at the top keep of the past.
    pub fn with_memory(time_s: f64, state: State, contact: Contact, memory: TopMemory) -> Self {
        let TopMemory { plastic_m, largest_m, carried } = memory;
        let contact = Some(contact);
        Self {
            time_s,
            state,
            contact,
            plastic_displacement_m: plastic_m,
            largest_displacement_m: largest_m,
            carried,
            ..Self::default()
        }
    }

    fn memory(&self) -> TopMemory {
        TopMemory {
            plastic_m: self.plastic_displacement_m,
            largest_m: self.largest_displacement_m,
            carried: self.carried,
        }
    }
}

/// A wall and a shaking made ready. Their equations, limits and samples are worked out once, so that a window
/// costs little more than its steps. Windows do not depend on one another.
#[derive(Debug, Clone)]
pub struct Simulator {
    pub(super) wall: RockingWall,
    pub(super) rest: RestLimits,
    pub(super) controller: Controller,
    /// Rotation that a unit of each carried state turns the wall by, rad; `None` without any.
    pub(super) carried_weights_rad: Option<CarriedStates>,
    /// The ground motion as recorded, and as the wall's effects make it.
    record: GroundPath,
    ground: GroundPath,
    /// Steps that a run may try, kept or not.
    pub(super) most_steps: u64,
    /// Whether anybody asks for largest values, forces and energy.
    accounts: bool,
}

/// A start moved onto its contact state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub contact: Contact,
    pub state: State,
    pub crushed_rad: [[f64; 2]; 2],
    pub memory: TopMemory,
}

impl Simulator {
    /// Makes a wall and a shaking ready.
    pub fn new(wall: &Wall, shaking: &Shaking, accuracy: Accuracy) -> Self {
        Self::over(wall, GroundPath::new(shaking), accuracy)
    }

    /// Another wall under the same shaking, whose samples are shared and not copied.
    #[must_use]
    pub fn with_wall(&self, wall: &Wall, accuracy: Accuracy) -> Self {
        let (most_steps, accounts) = (self.most_steps, self.accounts);
        Self { most_steps, accounts, ..Self::over(wall, self.record.clone(), accuracy) }
    }

    fn over(wall: &Wall, record: GroundPath, accuracy: Accuracy) -> Self {
        let ground = record.changed(&wall.effects.ground);
        let rocking = RockingWall::new(wall);
        let scale = ErrorScale {
            position: wall.alpha_i_rad(),
            time_s: rocking.response_time_s(),
            fastest_rate_per_s: rocking.fastest_rate_per_s(),
        };
        let share = if wall.rolls() { STEP_SHARE_ON_BEDS } else { STEP_SHARE };
        let controller = Controller::new(scale, share * accuracy.tolerance, ground.step_s());
        let [lower_rad, _] = wall.alpha_i_rad();
        let weights = rocking.carries().then(|| rocking.carried_weights());
        Self {
            rest: RestLimits::new(&rocking),
            controller,
            carried_weights_rad: weights.map(|weights| weights.map(|weight| weight * lower_rad)),
            wall: rocking,
            record,
            ground,
            most_steps: u64::MAX,
            accounts: true,
        }
    }

    /// The same, each of whose runs fails where it has tried more steps than these: a law looked for may be so steep far from where it
    /// was meant that a run would take days.
    #[must_use]
    pub fn with_most_steps(self, most_steps: u64) -> Self {
        Self { most_steps, ..self }
    }

    /// The same, whose runs keep no account of largest values, forces and energy, which their responses then tell as no number:
    /// for those who look at the motion alone. It is the same to the bit.
    #[must_use]
    pub fn without_accounts(self) -> Self {
        Self { accounts: false, ..self }
    }

    /// What a run begins with.
    pub(super) fn totals(&self) -> Totals {
        let joints = self.wall.joints().count();
        if self.accounts { Totals::new(joints) } else { Totals::without_accounts(joints) }
    }

    /// The wall, ready to move.
    pub fn wall(&self) -> &RockingWall {
        &self.wall
    }

    /// End of the whole run: that of the record and of the free motion after it, s.
    pub fn end_s(&self) -> f64 {
        self.ground.end_s()
    }

    /// Ground acceleration at a time, m/s², as the wall's effects make it of the record; y without gravity.
    pub fn ground_m_s2(&self, time_s: f64) -> Vector {
        self.ground.at(time_s)
    }

    /// The whole run, from the wall's initial rotations at rest.
    pub fn run(&self, observer: &mut dyn Observer) -> Response {
        self.run_from(&self.release(), self.end_s(), observer)
    }

    /// Where the whole run starts: with the wall's initial rotations, at rest.
    pub fn release(&self) -> Start {
        let theta = self.wall.wall().parameters().initial_rotation_rad;
        Start { state: State { theta, omega: [0.0; 2] }, ..Start::default() }
    }

    /// A window of a run: from a given start to `end_s`, or to a collapse. A window after the record is free motion.
    ///
    /// A start that is no time from 0 on with finite rotations and velocities gives a run that failed.
    pub fn run_from(&self, start: &Start, end_s: f64, observer: &mut dyn Observer) -> Response {
        self.watched_from(start, end_s, observer).run_alone()
    }

    /// The whole run, to be run beside others.
    pub fn prepared(&self) -> Prepared {
        self.prepared_from(&self.release(), self.end_s(), ())
    }

    /// A window as [`Simulator::run_from`] runs it, to be run beside others.
    pub fn watched_from<'o>(
        &self,
        start: &Start,
        end_s: f64,
        observer: &'o mut dyn Observer,
    ) -> Prepared<&'o mut dyn Observer> {
        self.prepared_from(start, end_s, observer)
    }

    pub(super) fn prepared_from<O: Observer>(&self, start: &Start, end_s: f64, observer: O) -> Prepared<O> {
        let run = Run::new(self, &self.placed(start), self.ground.until(end_s), observer);
        let State { theta, omega } = start.state;
        let finite = theta.iter().chain(&omega).all(|x| x.is_finite());
        let valid = finite && start.time_s.is_finite() && start.time_s >= 0.0;
        let refused = (!valid).then(|| format!("no time and state to start from: {start:?}"));
        Prepared::new(run, start.time_s, refused)
    }

    /// The same for a wall with joints that give, which may turn by anything; sharp joints that are closed do not.
    fn placed_on_beds(&self, contact: Contact, start: &Start) -> Placed {
        let contact = self.wall.with_beds_as_at(contact, start.state.theta);
        let closed = self.wall.closed_edges(contact);
        let cracked = self.wall.wall().is_cracked();
        let onto = |[lower, upper]: [f64; 2]| match (closed.ground, closed.crack || !cracked) {
            (true, _) => [0.0, upper],
            (_, true) if lower != upper => [0.5 * (lower + upper); 2],
            _ => [lower, upper],
        };
        let mut state = State { theta: onto(start.state.theta), omega: onto(start.state.omega) };
        let contact = self.wall.with_beds_as_at(contact, state.theta);
        for (joint, i) in [(Joint::Ground, 0), (Joint::Crack, 1)] {
            let side = if self.wall.bed(joint).is_none() { contact.at(joint).sign() } else { 0.0 };
            if side * opening(joint, state.theta) < 0.0 {
                state.theta[i] = if i == 0 { 0.0 } else { state.theta[0] };
            }
        }
        Placed { contact, state, crushed_rad: start.crushed_rad, memory: start.memory() }
    }

    /// Moves a start onto its contact state.
    fn placed(&self, start: &Start) -> Placed {
        let mut contact = start.contact.unwrap_or_else(|| Contact::of_state(&start.state));
        if !self.wall.wall().is_cracked() {
            contact.crack = Pivot::Closed;
        }
        if self.wall.wall().gives() {
            return self.placed_on_beds(contact, start);
        }
        let onto = |[lower, upper]: [f64; 2]| match contact.pattern_number() {
            None => [0.0, 0.0],
            Some(3) if lower != upper => [0.5 * (lower + upper); 2],
            Some(4) => [0.0, upper],
            _ => [lower, upper],
        };
        let mut state = State { theta: onto(start.state.theta), omega: onto(start.state.omega) };
        let [theta1, theta2] = &mut state.theta;
        if contact.ground.sign() * *theta1 < 0.0 {
            // The mean of pattern 3 turns as one.
            *theta2 = if contact.crack.is_closed() { 0.0 } else { *theta2 };
            *theta1 = 0.0;
        }
        if contact.crack.sign() * (*theta2 - *theta1) < 0.0 {
            *theta2 = *theta1;
        }
        Placed { contact, state, crushed_rad: start.crushed_rad, memory: start.memory() }
    }
}

//! Carried states of formulas: what a law remembers of the motion, as numbers with a rate of their own.
//!
//! A state moves with the motion, through impacts too, and at rest: there its rate is that at x = 0 and v = 0. It is one more
//! coordinate whose velocity it is. So it goes through the step as velocities do, and its error takes part in the choice of the
//! step, as the rotation that the force of that error would make.

use mrbd_formula::{Branches, Formula, FormulaError, MOST_STATES, Program, Range, State};

use super::super::contact::Contact;
use super::super::geometry::Pair;
use super::super::motion::Motion;
use super::super::rocking::RockingWall;
use super::super::wall::{G_M_S2, Wall};
use super::law::FormulaLaw;
use super::laws::FormulaLaws;
use crate::model::ImpossibleWall;

/// The carried states of the formulas of a wall, formula after formula, each in its unit.
pub type CarriedStates = [f64; MOST_CARRIED];

/// Carried states of a wall at most.
pub const MOST_CARRIED: usize = 4;

/// The carried states of one formula.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Carried {
    /// Their values now.
    pub(super) now: [f64; MOST_STATES],
    /// Between which they are finite, and at which a run ends.
    range: [[f64; 2]; MOST_STATES],
    /// What they come to in a motion of the wall's size: their roundings are relative to it.
    pub(super) size: [f64; MOST_STATES],
}

impl Carried {
    /// Those of a formula at their start.
    ///
    /// # Errors
    /// A state that is not shown to be bounded.
    pub(super) fn of(wall: &Wall, formula: &Formula, range: &Range) -> Result<Self, FormulaError> {
        let mut carried = Self::default();
        if formula.states().is_empty() {
            return Ok(carried);
        }
        let ranges = formula.state_ranges(range)?;
        for (i, (state, range)) in formula.states().iter().zip(ranges).enumerate() {
            (carried.now[i], carried.range[i]) = (state.start, range);
        }
        // Twice: one state may follow another.
        for _ in 0..2 {
            carried.size = carried.sizes(wall, formula.program());
        }
        Ok(carried)
    }

    fn sizes(&self, wall: &Wall, program: &Program) -> [f64; MOST_STATES] {
        let p = wall.parameters();
        let time_s = (p.height_m / G_M_S2).sqrt();
        let half_m = p.thickness_m / 2.0;
        let mut size = self.now.map(f64::abs);
        for_each(half_m, half_m / time_s, self, |state| {
            let rates = program.state_rates(state, &Branches::FREE);
            for (i, rate) in rates.into_iter().enumerate().take(program.states()) {
                let [least, most] = self.range[i];
                let by_rate = (self.now[i].abs() + rate.abs() * time_s).min(most.max(-least));
                size[i] = size[i].max(by_rate);
            }
        });
        size
    }
}

/// Where slopes by a carried state are looked at, as shares of a size.
const SHARES: [f64; 5] = [-1.0, -0.3, 1e-3, 0.3, 1.0];

/// The variables over displacements and velocities up to a size, and states up to theirs.
fn for_each(half_m: f64, speed_m_s: f64, carried: &Carried, mut take: impl FnMut(State)) {
    let of = |i: usize, share: f64| carried.now[i] + share * carried.size[i];
    let second: &[f64] = if carried.size[1] == 0.0 { &[0.0] } else { &SHARES };
    for x in SHARES.map(|share| share * half_m) {
        for v in SHARES.map(|share| share * speed_m_s) {
            for first in SHARES {
                second.iter().for_each(|second| take([x, v, x.abs(), of(0, first), of(1, *second)]));
            }
        }
    }
}

/// What the carried states of a formula do, at most.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Effects {
    /// Force of a unit of each, N.
    force_n: [f64; MOST_STATES],
    /// Rates of the first and the second by the first and the second, 1/s where units are the same.
    rate: [[f64; MOST_STATES]; MOST_STATES],
}

impl FormulaLaw {
    /// How many it has.
    pub(super) fn states(&self) -> usize {
        self.program.states()
    }

    /// How fast the states follow a velocity, each in its unit per metre.
    pub(super) fn follows(&self, state: State, branches: &Branches) -> State {
        let mut follows = [0.0; 5];
        for i in 0..self.states() {
            let slope = self.program.rate_of_state_rate(i, state, [0.0, 1.0, 0.0, 0.0, 0.0], branches);
            follows[3 + i] = if slope.is_finite() { slope } else { 0.0 };
        }
        follows
    }

    /// Rates of the states, in the branches it is in.
    pub(super) fn state_rates(&self, x: f64, v: f64, states: [f64; MOST_STATES]) -> [f64; MOST_STATES] {
        self.program.state_rates(self.state_with(x, v, states), &self.branches)
    }

    fn effects(&self, half_m: f64, speed_m_s: f64) -> Effects {
        let mut effects = Effects::default();
        let raise = |most: &mut f64, slope: f64| {
            if slope.is_finite() {
                *most = most.max(slope.abs());
            }
        };
        for_each(half_m, speed_m_s, &self.carried, |state| {
            let branches = self.program.branches_at(state, [state[1], 0.0, 0.0, 0.0, 0.0]);
            for j in 0..self.states() {
                let mut by = [0.0; 5];
                by[3 + j] = 1.0;
                raise(&mut effects.force_n[j], self.program.rate(state, by, &branches));
                for i in 0..self.states() {
                    let slope = self.program.rate_of_state_rate(i, state, by, &branches);
                    raise(&mut effects.rate[i][j], slope);
                }
            }
        });
        effects
    }
}

impl FormulaLaws {
    /// Whether any has a carried state.
    #[inline]
    pub fn carry(&self) -> bool {
        self.laws.iter().any(|law| law.states() > 0)
    }

    /// Whether the states of others start as these, change as fast and are as bounded.
    fn carry_as(&self, other: &Self) -> bool {
        let [own, others] =
            [self, other].map(|laws| laws.laws.iter().filter(|law| law.states() > 0).collect::<Vec<_>>());
        let start = |law: &FormulaLaw| (law.carried.now, law.carried.range);
        let is_same = |(one, two): (&&FormulaLaw, &&FormulaLaw)| {
            one.program.changes_as(&two.program) && start(one) == start(two)
        };
        own.len() == others.len() && own.iter().zip(&others).all(is_same)
    }

    /// Every state, by its law and its number there.
    fn each(&self) -> impl Iterator<Item = (&FormulaLaw, usize)> {
        self.laws.iter().flat_map(|law| (0..law.states()).map(move |i| (law, i)))
    }

    /// The carried states.
    pub fn carried(&self) -> CarriedStates {
        let mut carried = [0.0; MOST_CARRIED];
        carried.iter_mut().zip(self.each()).for_each(|(own, (law, i))| *own = law.carried.now[i]);
        carried
    }

    /// Puts the carried states.
    pub fn put_carried(&mut self, carried: &CarriedStates) {
        let mut values = carried.iter();
        for law in &mut self.laws {
            for i in 0..law.program.states() {
                law.carried.now[i] = values.next().copied().unwrap_or(0.0);
            }
        }
    }

    /// How fast they change at a displacement and velocity of the top.
    pub fn carried_rates(&self, x_c_m: f64, v_c_m_s: f64) -> CarriedStates {
        let mut rates = [0.0; MOST_CARRIED];
        let of_laws = self.laws.iter().flat_map(|law| {
            let of = law.state_rates(x_c_m, v_c_m_s, law.carried.now);
            of.into_iter().take(law.states())
        });
        rates.iter_mut().zip(of_laws).for_each(|(own, rate)| *own = rate);
        rates
    }

    /// The first state that is not within its range, as words.
    pub fn left_range(&self) -> Option<String> {
        let left = self.each().find(|(law, i)| {
            let [least, most] = law.carried.range[*i];
            !(least..=most).contains(&law.carried.now[*i])
        });
        left.map(|(law, i)| {
            let ([least, most], now) = (law.carried.range[i], law.carried.now[i]);
            format!("the carried state {} of a formula at {now} left its range from {least} to {most}", i + 1)
        })
    }

    /// The fastest rate at which a state changes by itself, 1/s.
    pub fn fastest_carried_per_s(&self, half_m: f64, speed_m_s: f64) -> f64 {
        let of = |law: &FormulaLaw| {
            let rate = law.effects(half_m, speed_m_s).rate;
            rate.iter().enumerate().map(|(i, row)| row[i]).fold(0.0, f64::max)
        };
        self.laws.iter().filter(|law| law.states() > 0).map(of).fold(0.0, f64::max)
    }

    /// Force at the top of a unit of each state, N: its own, or by another that it drives over a time in s.
    pub fn carried_forces_n(&self, half_m: f64, speed_m_s: f64, time_s: f64) -> CarriedStates {
        let mut forces_n = [0.0; MOST_CARRIED];
        let of_laws = self.laws.iter().filter(|law| law.states() > 0).flat_map(|law| {
            let Effects { force_n, rate } = law.effects(half_m, speed_m_s);
            let driven = move |j: usize| {
                let by = (0..MOST_STATES).filter(|i| *i != j).map(|i| force_n[i] * rate[i][j] * time_s);
                by.fold(force_n[j], f64::max)
            };
            (0..law.states()).map(driven)
        });
        forces_n.iter_mut().zip(of_laws).for_each(|(own, force_n)| *own = force_n);
        forces_n
    }
}

/// Refuses more states than a wall can carry.
///
/// # Errors
/// The key of the formula with which they are too many.
pub(super) fn check_count(laws: &[FormulaLaw]) -> Result<(), ImpossibleWall> {
    let mut count = 0;
    for (i, law) in laws.iter().enumerate() {
        count += law.states();
        if count > MOST_CARRIED {
            let key = std::borrow::Cow::Owned(format!("formulas.{i}.states"));
            let allowed = format!("at most {MOST_CARRIED} of all formulas");
            return Err(ImpossibleWall { key, found: format!("{count} carried states"), allowed });
        }
    }
    Ok(())
}

impl FormulaLaw {
    /// The states after a displacement of the top from one place to another in a time: each by the exponential of its own decay, of
    /// second order and stable however fast it decays.
    fn states_after(&self, before: [f64; MOST_STATES], top: &TopMove) -> [f64; MOST_STATES] {
        let h = top.time_s / f64::from(TopMove::PARTS);
        let v = (top.to_m - top.from_m) / top.time_s;
        let mut states = before;
        for part in 0..TopMove::PARTS {
            let share = (f64::from(part) + 0.5) / f64::from(TopMove::PARTS);
            let x = top.from_m + share * (top.to_m - top.from_m);
            let state = [x, v, top.largest_m.max(x.abs()), states[0], states[1]];
            for i in 0..self.states() {
                let mut by = [0.0; 5];
                by[3 + i] = 1.0;
                let [rate, slope] = self.program.state_rate_and_its_rate(i, state, by, &Branches::FREE);
                let [least, most] = self.carried.range[i];
                states[i] = (states[i] + h * rate * lasting(h * slope)).clamp(least, most);
            }
        }
        states
    }
}

/// (e^s - 1)/s, by its series where that is as accurate; 1 where nothing decays.
fn lasting(s: f64) -> f64 {
    // The next term is below 2e-16.
    if s.abs() < 0.01 {
        1.0 + s / 2.0 * (1.0 + s / 3.0 * (1.0 + s / 4.0 * (1.0 + s / 5.0 * (1.0 + s / 6.0))))
    } else if s.is_finite() {
        libm::expm1(s) / s
    } else {
        1.0
    }
}

/// A displacement of the top at a steady velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TopMove {
    /// From where, m.
    pub from_m: f64,
    /// To where, m.
    pub to_m: f64,
    /// The largest |x_C| before, m.
    pub largest_m: f64,
    /// Time that it takes, s, above zero.
    pub time_s: f64,
}

impl TopMove {
    /// Parts in which states are followed over a move.
    const PARTS: u32 = 4;
}

impl Motion {
    /// Puts the carried states.
    pub(crate) fn put_carried(&mut self, carried: &CarriedStates) {
        self.formulas.put_carried(carried);
    }

    /// How fast the carried states change at rotations and angular velocities.
    pub(crate) fn carried_rates(&self, [theta, omega]: [Pair; 2]) -> CarriedStates {
        let [x_c, v_c, _] = self.top(theta, omega, [0.0; 2]);
        self.formulas.carried_rates(x_c, v_c)
    }
}

impl RockingWall {
    /// Whether a formula has a carried state.
    #[inline]
    pub fn carries(&self) -> bool {
        self.formulas().carry()
    }

    /// Puts the carried states, in every contact state.
    pub(crate) fn put_carried(&mut self, carried: &CarriedStates) {
        self.formulas.put_carried(carried);
        self.motions_mut().iter_mut().for_each(|motion| motion.formulas.put_carried(carried));
    }

    /// How fast the carried states change.
    pub(crate) fn carried_rates(&self, contact: Contact, theta: Pair, omega: Pair) -> CarriedStates {
        self.motion(contact).carried_rates([theta, omega])
    }

    /// The carried states as they start.
    pub fn carried_at_start(&self) -> CarriedStates {
        let start =
            self.wall().formulas.iter().flat_map(|law| law.carried.now.into_iter().take(law.states()));
        let mut carried = [0.0; MOST_CARRIED];
        carried.iter_mut().zip(start).for_each(|(own, start)| *own = start);
        carried
    }

    /// Whether the formulas of another wall carry the same states along the same displacement of the top, from their start on.
    pub fn carries_as(&self, other: &Self) -> bool {
        self.formulas.carry_as(&other.formulas)
    }

    /// The carried states after a displacement of the top, such as a measured one between two samples; `before` it they are these.
    /// Approximately: a run follows them far better.
    pub fn carried_after(&self, before: &CarriedStates, top: &TopMove) -> CarriedStates {
        let mut after = *before;
        let mut first = 0;
        for law in &self.formulas.laws {
            let own = std::array::from_fn(|i| if i < law.states() { before[first + i] } else { 0.0 });
            let states = law.states_after(own, top);
            after[first..first + law.states()].copy_from_slice(&states[..law.states()]);
            first += law.states();
        }
        after
    }

    /// The equations of a contact state, to be moved with other states.
    pub(crate) fn motion_mut(&mut self, contact: Contact) -> &mut Motion {
        &mut self.motions_mut()[contact.index()]
    }

    /// What a unit of each carried state turns the wall by, over its rotations of size α.
    pub(crate) fn carried_weights(&self) -> CarriedStates {
        let p = self.wall().parameters();
        let [half_m, speed_m_s] = self.carried_motion();
        let forces_n = self.formulas.carried_forces_n(half_m, speed_m_s, self.response_time_s());
        let per_force = p.height_m / (self.turning_stiffness_n_m() * self.wall().alpha_rad());
        forces_n.map(|force_n| force_n * per_force)
    }

    /// The size of a motion in which states are looked at: half the thickness, m, and the speed of a wall that rocks so, m/s.
    pub(in crate::model) fn carried_motion(&self) -> Pair {
        let p = self.wall().parameters();
        let half_m = p.thickness_m / 2.0;
        [half_m, half_m * (G_M_S2 / p.height_m).sqrt()]
    }
}

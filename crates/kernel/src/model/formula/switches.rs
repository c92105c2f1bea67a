//! The switches of formulas as a wall moves: what is left to them, and on which side they are.

use std::sync::Arc;

use mrbd_formula::{Branch, MOST_STATES, Switch, SwitchAt};

use super::super::contact::Contact;
use super::super::geometry::Pair;
use super::super::rocking::{RockingWall, State, opening};
use super::carried::CarriedStates;
use super::law::FormulaLaw;
use super::laws::FormulaLaws;

/// Displacement or rotation at a place, its rate and its second rate.
pub(crate) type Place = [f64; 3];

/// A switch of a formula that may turn within a step, and its place.
pub(crate) struct Turn<'a> {
    law: &'a FormulaLaw,
    /// Number of the formula and of its switch.
    pub formula: usize,
    pub index: usize,
    switch: &'a Switch,
    /// Number of the first carried state of the formula among those of the wall.
    first_state: usize,
}

/// Where the argument of a switch goes over a step.
pub(crate) enum Path {
    /// With the displacement or rotation, from a value on.
    Displacement(f64),
    /// With its rate, from a value on.
    Rate(f64),
    /// With both, or with what a law carries along.
    Both,
    /// Nowhere: with a weight, or with how far the top has been, which stay.
    Nowhere,
}

/// Where the top stays while no switch turns.
pub(crate) struct TopSides {
    /// Displacements between which it stays, m; finite.
    pub between_m: [f64; 2],
    /// Which way it moves: 1, -1, or 0 where no switch asks.
    pub along: f64,
}

impl FormulaLaws {
    /// Where the top stays while no switch turns. `None` where any asks more than where the top is and which way it moves.
    pub fn top_sides(&self) -> Option<TopSides> {
        let mut sides = TopSides { between_m: [-f64::MAX, f64::MAX], along: 0.0 };
        let TopSides { between_m: [low_m, high_m], along } = &mut sides;
        for turn in self.turns().filter(|turn| !matches!(turn.path(), Path::Nowhere)) {
            let side = turn.side();
            match turn.path() {
                _ if !turn.is_at_top() || side == 0.0 => return None,
                Path::Displacement(value_m) if side > 0.0 => *low_m = low_m.max(value_m),
                Path::Displacement(value_m) => *high_m = high_m.min(value_m),
                Path::Rate(value) if value == 0.0 && *along != -side => *along = side,
                _ => return None,
            }
        }
        Some(sides)
    }

    /// Whether any has a branch to change.
    pub fn have_switches(&self) -> bool {
        self.laws.iter().any(|law| !law.program.switches().is_empty())
    }

    /// Every switch but that of friction, which the regime turns.
    pub fn turns(&self) -> impl Iterator<Item = Turn<'_>> {
        let mut states = 0;
        let firsts = self.laws.iter().map(move |law| {
            states += law.states();
            states - law.states()
        });
        self.laws.iter().zip(firsts).enumerate().flat_map(|(formula, (law, first_state))| {
            let switches = law.program.switches().iter().enumerate();
            let own = switches.filter(|(index, _)| law.friction != Some(*index));
            own.map(move |(index, switch)| Turn { law, formula, index, switch, first_state })
        })
    }

    fn turn(&self, formula: usize, index: usize) -> Turn<'_> {
        let law = &self.laws[formula];
        let first_state = self.laws[..formula].iter().map(|law| law.states()).sum();
        Turn { law, formula, index, switch: &law.program.switches()[index], first_state }
    }

    /// Puts a switch on its other side.
    fn flip(&mut self, formula: usize, index: usize) {
        let branches = &mut self.laws[formula].branches;
        let other = if branches.at(index) == Branch::Positive { Branch::Negative } else { Branch::Positive };
        *branches = branches.with(index, other);
    }
}

impl Turn<'_> {
    /// 1 or -1: the side it is on.
    pub fn side(&self) -> f64 {
        self.law.branches.at(self.index).sign()
    }

    pub fn path(&self) -> Path {
        match &self.switch.at {
            SwitchAt::Line { variable: 0, value } => Path::Displacement(*value),
            SwitchAt::Line { variable: 1, value } => Path::Rate(*value),
            SwitchAt::Line { variable: 2, .. } if !self.law.grows() => Path::Nowhere,
            SwitchAt::Line { .. } | SwitchAt::Surface(_) => Path::Both,
        }
    }

    /// Whether it acts at the top, and not at a joint.
    pub fn is_at_top(&self) -> bool {
        self.law.joint.is_none()
    }

    /// Where it acts.
    pub fn place(&self, wall: &RockingWall, contact: Contact, [theta, omega, theta_dd]: [Pair; 3]) -> Place {
        match self.law.joint {
            None => wall.top(contact, theta, omega, theta_dd),
            Some(joint) => [theta, omega, theta_dd].map(|pair| opening(joint, pair)),
        }
    }

    /// The argument, and its rate.
    pub fn argument(&self, place: Place) -> (f64, f64) {
        self.argument_and_rate_with(place, self.law.carried.now)
    }

    /// The argument alone, with other carried states of its law: how fast these change is not asked.
    pub fn argument_with(&self, [q, rate, _]: Place, states: [f64; MOST_STATES]) -> f64 {
        let state = self.law.state_with(q, rate, states);
        self.switch.argument_and_rate(state, [0.0; 3 + MOST_STATES], &self.law.branches).0
    }

    fn argument_and_rate_with(&self, [q, rate, second]: Place, states: [f64; MOST_STATES]) -> (f64, f64) {
        let state = self.law.state_with(q, rate, states);
        let [z_1, z_2] =
            if self.law.states() == 0 { [0.0; 2] } else { self.law.state_rates(q, rate, states) };
        let rates = [rate, second, self.law.third_rate(rate), z_1, z_2];
        self.switch.argument_and_rate(state, rates, &self.law.branches)
    }

    /// The carried states of its law now.
    pub fn states(&self) -> [f64; MOST_STATES] {
        self.law.carried.now
    }

    /// The carried states of its law among those of the wall.
    pub fn own_states(&self, carried: &CarriedStates) -> [f64; MOST_STATES] {
        std::array::from_fn(|i| carried.get(self.first_state + i).copied().unwrap_or(0.0))
    }

    /// Whether a carried state has a part in it.
    pub fn depends_on_states(&self) -> bool {
        self.switch.depends_on_states()
    }

    /// What the argument is known to, where displacement and rate are known to these errors.
    pub fn rounding(&self, [q, rate, _]: Place, [of_q, of_rate]: Pair) -> f64 {
        let of_third = if self.law.grows() { of_q } else { 0.0 };
        let [of_z_1, of_z_2] = self.law.carried.size.map(|size| ROUNDINGS * f64::EPSILON * size);
        let errors = [of_q, of_rate, of_third, of_z_1, of_z_2];
        self.switch.rounding(self.law.state(q, rate), errors, &self.law.branches)
    }

    /// How fast the rate of an argument with carried states changes from rest, and what its rate is known to where the velocity is known to
    /// an error.
    fn second_rate_from_rest(&self, [q, rate, second]: Place, of_rate: f64) -> (f64, f64) {
        let state = self.law.state(q, rate);
        let [.., first, last] = self.law.follows(state, &self.law.branches);
        let rates = [second, 0.0, 0.0, first * second, last * second];
        let (_, second) = self.switch.argument_and_rate(state, rates, &self.law.branches);
        (second, of_rate * first.abs().max(last.abs()).max(1.0))
    }

    /// The side that the argument is on, or, where it is zero to its rounding, goes to; `None` if it stays zero.
    fn side_at(&self, place: Place, errors: Pair) -> Option<Branch> {
        let (argument, rate) = self.argument(place);
        if argument.abs() > self.rounding(place, errors) {
            return Some(Branch::of(argument));
        }
        // From rest, a displacement goes where it is accelerated to, and so does a state that follows the velocity.
        let [_, of_rate] = errors;
        let (second, of_rate) = match self.path() {
            Path::Displacement(_) => (place[2], of_rate),
            _ if self.depends_on_states() => self.second_rate_from_rest(place, of_rate),
            _ => (0.0, of_rate),
        };
        let along = if rate.abs() > of_rate { rate } else { second };
        Some(Branch::of(along)).filter(|side| *side != Branch::Zero)
    }
}

impl RockingWall {
    /// The formulas of the wall.
    pub(crate) fn formulas(&self) -> &FormulaLaws {
        &self.formulas
    }

    /// Errors to which displacement and rate at the top or at a joint are known.
    pub(crate) fn place_errors(&self, turn: &Turn, contact: Contact, [theta, omega]: [Pair; 2]) -> Pair {
        let roundings = ROUNDINGS * f64::EPSILON;
        if turn.is_at_top() {
            let width_m = self.wall().parameters().thickness_m;
            return [roundings * width_m, roundings * self.top_speed_size(contact, omega)];
        }
        [theta, omega].map(|pair| roundings * (pair[0].abs() + pair[1].abs()))
    }

    /// Puts every switch but one on the side of a state: where it is, or where it goes from there. Says whether
    /// any turned.
    pub(crate) fn turn_switches(
        &mut self,
        contact: Contact,
        state: &State,
        theta_dd: Pair,
        but: Option<[usize; 2]>,
    ) -> bool {
        if !self.formulas.have_switches() {
            return false;
        }
        let mut turned = false;
        let turns = self.formulas.turns().map(|turn| [turn.formula, turn.index]);
        let all: Vec<_> = turns.filter(|turn| Some(*turn) != but).collect();
        // In their order: the argument of one may depend on the side of those before it.
        for [formula, index] in all {
            let turn = self.formulas.turn(formula, index);
            let place = turn.place(self, contact, [state.theta, state.omega, theta_dd]);
            let errors = self.place_errors(&turn, contact, [state.theta, state.omega]);
            let side = turn.side_at(place, errors);
            if side.is_some_and(|side| side.sign() != turn.side()) {
                self.formulas.flip(formula, index);
                turned = true;
            }
        }
        if turned {
            self.share_branches();
        }
        turned
    }

    /// Puts one switch on its other side.
    pub(crate) fn flip_switch(&mut self, formula: usize, index: usize) {
        self.formulas.flip(formula, index);
        self.share_branches();
    }

    /// Every contact state moves in the branches of the wall.
    pub(in crate::model) fn share_branches(&mut self) {
        if !self.formulas.is_empty() {
            let formulas = &self.formulas;
            let motions = Arc::make_mut(&mut self.motions);
            motions.iter_mut().for_each(|motion| motion.formulas.take_branches(formulas));
        }
    }

    /// What is left to a switch of a formula, and how fast it falls.
    pub(crate) fn left_to_switch(
        &self,
        [formula, index]: [usize; 2],
        contact: Contact,
        moving: [Pair; 3],
    ) -> (f64, f64) {
        let turn = self.formulas.turn(formula, index);
        turn.argument(turn.place(self, contact, moving))
    }
}

/// Roundings a displacement or rotation gathers over a step of some ten operations.
const ROUNDINGS: f64 = 8.0;

//! Carried states: numbers of a law that change by a rate of their own, and within what they stay.
//!
//! A state has no range by itself. It is bounded where its rate points inwards at both ends of an interval, whatever the other
//! variables are: once inside, it never leaves. Such an interval is looked for among powers of two, and shown by intervals. Where
//! none is found the range must be given, and a run that leaves it has failed.

use crate::error::FormulaError;
use crate::interval::Interval;
use crate::number::Number;
use crate::program::{Program, State, VARIABLES};
use crate::range::{Over, Range};
use crate::sloped::Sloped;
use crate::switch::{Branch, Branches, SwitchAt};

/// A number that a law carries along, as it stands in a wall file.
#[derive(Debug, Clone, PartialEq)]
pub struct CarriedState {
    /// Its name in the formulas.
    pub name: String,
    /// How fast it changes, in its unit per second: a formula of the variables of the place, the states and the parameters.
    pub rate: String,
    /// Its value at the start of a run, in its unit.
    pub start: f64,
    /// Its unit, as that of a parameter.
    pub unit: String,
    /// The least and the largest value, at which a run ends; `None` where it is bounded by its rate.
    pub range: Option<[f64; 2]>,
}

/// Sizes looked for are powers of two from this one ...
const LEAST_POWER: i32 = -40;
/// ... to this one: 1e15 is no number of a law of a wall.
const MOST_POWER: i32 = 50;
/// Parts of a range that are looked at for one end of one interval.
const MOST_PARTS: usize = 500;
/// Rounds in which the intervals of states that depend on each other grow.
const MOST_ROUNDS: usize = 8;

/// Intervals that states never leave, or those given.
///
/// # Errors
/// A state for which no interval is found.
pub(crate) fn ranges_of(
    states: &[CarriedState],
    program: &Program,
    range: &Range,
) -> Result<Vec<[f64; 2]>, FormulaError> {
    let least = 2f64.powi(LEAST_POWER);
    let start = |state: &CarriedState| state.range.unwrap_or([-least, least]);
    let mut found: Vec<_> = states.iter().map(start).collect();
    for _ in 0..MOST_ROUNDS {
        let before = found.clone();
        for (i, state) in states.iter().enumerate().filter(|(_, state)| state.range.is_none()) {
            let inwards = Inwards { program, of: i };
            let power = (LEAST_POWER..=MOST_POWER).find(|power| {
                let size = 2f64.powi(*power);
                let mut ranges = found.clone();
                ranges[i] = [-size, size];
                let holds = size >= state.start.abs() && size >= before[i][1];
                holds && inwards.at_both_ends(&range.with_states(&ranges))
            });
            let Some(power) = power else { return Err(unbounded(state)) };
            let size = 2f64.powi(power);
            found[i] = [-size, size];
        }
        if found == before {
            return Ok(found);
        }
    }
    let grows = states.iter().find(|state| state.range.is_none());
    grows.map_or(Ok(found), |state| Err(unbounded(state)))
}

fn unbounded(state: &CarriedState) -> FormulaError {
    let found = format!("`{}`, which no size of {} is shown to bound", state.rate, state.name);
    let allowed = "range = [least, largest], at which a run ends as failed; or a rate that leads back at some size, \
                   whatever the displacement and velocity";
    FormulaError::new(None, found, allowed).of_state(&state.name, "rate")
}

/// Position of the velocity among the variables.
const VELOCITY: usize = 1;

/// Whether a rate leads inwards at the ends of the interval of its state.
struct Inwards<'a> {
    program: &'a Program,
    /// Number of the state.
    of: usize,
}

impl Inwards<'_> {
    fn at_both_ends(&self, range: &Over) -> bool {
        let own = VARIABLES - crate::program::MOST_STATES + self.of;
        [(range.high[own], 1.0), (range.low[own], -1.0)].into_iter().all(|(end, side)| {
            let mut at = *range;
            (at.low[own], at.high[own]) = (end, end);
            // Most sizes fail at a corner already.
            let corners = [at.low, at.high].map(|corner| Over { low: corner, high: corner });
            corners.iter().all(|corner| self.leads(corner, side)) && self.over(&at, &at, side, &mut 0)
        })
    }

    fn over(&self, part: &Over, whole: &Over, side: f64, parts: &mut usize) -> bool {
        *parts += 1;
        if self.leads(part, side) {
            return true;
        }
        let varies = (0..VARIABLES).any(|i| whole.high[i] > whole.low[i]);
        let middle = std::array::from_fn(|i| 0.5 * (part.low[i] + part.high[i]));
        if *parts >= MOST_PARTS || !varies || !self.leads(&Over { low: middle, high: middle }, side) {
            return false;
        }
        part.halves(whole).iter().all(|half| self.over(half, whole, side, parts))
    }

    /// By the interval of the rate, or by its slope along the velocity from the end of the part that is nearer to rest.
    fn leads(&self, part: &Over, side: f64) -> bool {
        let branches = self.branches_of(part);
        let tape = &self.program.rates[self.of].tape;
        let leads = |rate: Interval| match side > 0.0 {
            true => rate.high <= 0.0,
            false => rate.low >= 0.0,
        };
        let over: State<Interval> = part.intervals();
        if leads(tape.run(over, &branches)) {
            return true;
        }
        let (low, high) = (part.low[VELOCITY], part.high[VELOCITY]);
        let nearest = if low.abs() < high.abs() { low } else { high };
        let mut from = over;
        from[VELOCITY] = Interval::constant(nearest);
        let mut sloped = over.map(Sloped::still);
        sloped[VELOCITY].slope = Interval::constant(1.0);
        let away = over[VELOCITY].sub(Interval::constant(nearest));
        let slope = tape.run(sloped, &branches).slope;
        slope.is_finite() && leads(tape.run(from, &branches).add(slope.mul(away)))
    }

    /// The branches in which a part of the range lies as a whole. Rates do not jump where the velocity passes zero, so that the end of a
    /// part lies in both.
    fn branches_of(&self, part: &Over) -> Branches {
        let mut branches = Branches::FREE;
        for (i, switch) in self.program.switches.iter().enumerate() {
            if let SwitchAt::Line { variable, value } = switch.at {
                if part.low[variable] >= value {
                    branches = branches.with(i, Branch::Positive);
                } else if part.high[variable] <= value {
                    branches = branches.with(i, Branch::Negative);
                }
            }
        }
        branches
    }
}

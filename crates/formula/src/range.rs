//! Has a formula a possible value at every state that can be reached? Shown by intervals, not by trying states.
//!
//! The range is halved where an interval is too wide to tell. What cannot be shown in so many halves is refused.

use std::collections::BTreeMap;

use crate::error::FormulaError;
use crate::expression::{Expression, Function, Operator};
use crate::formula::Place;
use crate::interval::Interval;
use crate::number::Number;
use crate::program::{MOST_STATES, State, VARIABLES, whole_exponent};

/// From the least to the largest value of each of the three variables of a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The least.
    pub low: [f64; 3],
    /// The largest.
    pub high: [f64; 3],
}

/// The same of all variables, carried states too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Over {
    pub low: State,
    pub high: State,
}

/// Halvings one within another: a part of the range then is a millionth of it.
const MOST_HALVINGS: usize = 40;
/// Parts looked at in all.
const MOST_PARTS: usize = 4000;
/// A force or moment larger than this is no law of a wall, N or N m.
const MOST_VALUE: f64 = 1e15;
/// Intervals are rounded outwards: a factor that is 1 somewhere is found this much above it, and one that is 0 below.
const ROUNDINGS: f64 = 1e-9;

/// What an expression gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Gives {
    /// What a formula gives at its place.
    At(Place),
    /// How fast a carried state changes.
    Rate,
}

impl Gives {
    /// The values that an expression may have, what others are, and how they are told.
    fn possible(self) -> (Interval, String, String) {
        match self {
            Gives::Rate => (
                Interval::new(-f64::MAX, f64::MAX),
                "too large for a number".to_owned(),
                "what is finite".to_owned(),
            ),
            Gives::At(Place::Top | Place::Ground | Place::Crack) => (
                Interval::new(-MOST_VALUE, MOST_VALUE),
                format!("beyond {MOST_VALUE:e}"),
                format!("forces and moments within {MOST_VALUE:e}"),
            ),
            Gives::At(Place::Impacts) => (
                Interval::new(-ROUNDINGS, 1.0 + ROUNDINGS),
                "below 0 or above 1".to_owned(),
                "a factor from 0 to 1: what is kept at any speed belongs into the coefficients".to_owned(),
            ),
        }
    }
}

impl Range {
    /// With those of carried states.
    pub(crate) fn with_states(&self, ranges: &[[f64; 2]]) -> Over {
        let of = |values: &[f64; 3], side: usize| {
            let states: [f64; MOST_STATES] =
                std::array::from_fn(|i| ranges.get(i).map_or(0.0, |range| range[side]));
            std::array::from_fn(|i| if i < 3 { values[i] } else { states[i - 3] })
        };
        Over { low: of(&self.low, 0), high: of(&self.high, 1) }
    }
}

impl Over {
    /// The range as intervals.
    pub(crate) fn intervals(&self) -> State<Interval> {
        std::array::from_fn(|i| Interval::new(self.low[i], self.high[i]))
    }

    /// Both halves, cut across the variable that is widest beside its whole width.
    pub(crate) fn halves(&self, whole: &Over) -> [Over; 2] {
        let share = |range: &Over, i: usize| (range.high[i] - range.low[i]) / (whole.high[i] - whole.low[i]);
        let widest = (0..VARIABLES).filter(|i| whole.high[*i] > whole.low[*i]);
        let cut = widest.max_by(|a, b| share(self, *a).total_cmp(&share(self, *b))).unwrap_or(0);
        let middle = 0.5 * (self.low[cut] + self.high[cut]);
        let (mut first, mut second) = (*self, *self);
        first.high[cut] = middle;
        second.low[cut] = middle;
        [first, second]
    }
}

/// What is not known to be finite, and what would be allowed.
struct Doubt {
    found: String,
    allowed: String,
}

struct Search<'a> {
    expression: &'a Expression,
    gives: Gives,
    variables: &'a [&'a str],
    values: &'a BTreeMap<&'a str, f64>,
    whole: &'a Over,
    parts: usize,
}

/// Refuses an expression that is not shown to be finite everywhere in a range, and to have values that its place may have.
///
/// # Errors
/// The subexpression, the reason, and the range.
pub(crate) fn check_values(
    expression: &Expression,
    gives: Gives,
    variables: &[&str],
    values: &BTreeMap<&str, f64>,
    range: &Over,
) -> Result<(), FormulaError> {
    let mut search = Search { expression, gives, variables, values, whole: range, parts: 0 };
    search.part(range, MOST_HALVINGS).map_err(|doubt| {
        let over: Vec<_> = (0..variables.len())
            .filter(|i| expression.has(variables[*i]))
            .map(|i| format!("{} from {} to {}", variables[i], written(range.low[i]), written(range.high[i])))
            .collect();
        let within = if over.is_empty() { String::new() } else { format!(", for {}", over.join(" and ")) };
        FormulaError::new(None, doubt.found, format!("{}{within}", doubt.allowed))
    })
}

/// Four digits, for messages.
fn written(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

impl Search<'_> {
    fn part(&mut self, range: &Over, halvings: usize) -> Result<(), Doubt> {
        self.parts += 1;
        let Err(doubt) = self.value(range.intervals()) else { return Ok(()) };
        let varies = (0..self.variables.len())
            .any(|i| self.whole.high[i] > self.whole.low[i] && self.expression.has(self.variables[i]));
        if halvings == 0 || self.parts >= MOST_PARTS || !varies {
            return Err(doubt);
        }
        // A state at which it fails needs no halves.
        let middle = std::array::from_fn(|i| Interval::constant(0.5 * (range.low[i] + range.high[i])));
        self.value(middle)?;
        let [first, second] = range.halves(self.whole);
        self.part(&first, halvings - 1)?;
        self.part(&second, halvings - 1)
    }

    /// Whether the value is shown to be a possible one.
    fn value(&self, over: State<Interval>) -> Result<(), Doubt> {
        let value = self.of(self.expression, over)?;
        let (possible, beyond, allowed) = self.gives.possible();
        if value.low >= possible.low && value.high <= possible.high {
            return Ok(());
        }
        Err(Doubt { found: format!("`{}`, which may be {beyond}", self.expression), allowed })
    }

    fn of(&self, e: &Expression, over: State<Interval>) -> Result<Interval, Doubt> {
        let parts = e.parts().into_iter().map(|part| self.of(part, over)).collect::<Result<Vec<_>, _>>()?;
        let variable = |name: &str| self.variables.iter().position(|own| *own == name).map(|i| over[i]);
        // The parts are finite: one level is left.
        let value = match (e, &parts[..]) {
            (Expression::Binary(operator, _, b), [x, y]) => self.of_two(*operator, b, *x, *y),
            (Expression::Of(function, _), [x]) => function.of(*x),
            (Expression::OfTwo(Function::Max, ..), [x, y]) => x.max(*y),
            (Expression::OfTwo(..), [x, y]) => x.min(*y),
            (Expression::Negative(_), [x]) => x.neg(),
            _ => e.over(self.values, &variable).unwrap_or(Interval::new(f64::NAN, f64::NAN)),
        };
        if value.is_finite() { Ok(value) } else { Err(self.doubt(e, &parts)) }
    }

    fn of_two(&self, operator: Operator, b: &Expression, x: Interval, y: Interval) -> Interval {
        let whole = b.constant(self.values).and_then(whole_exponent);
        match (operator, whole) {
            (Operator::Power, Some(exponent)) => x.powi(exponent),
            _ => operator.of(x, y),
        }
    }

    fn doubt(&self, e: &Expression, parts: &[Interval]) -> Doubt {
        let negative = parts.first().is_some_and(|a| a.low < 0.0);
        let (found, allowed) = match e {
            Expression::Binary(Operator::Divide, _, b) => {
                (format!("`{e}`, where `{b}` may be zero"), "a divisor that is never zero".to_owned())
            }
            Expression::Binary(Operator::Power, a, b)
                if b.constant(self.values).and_then(whole_exponent).is_none() && negative =>
            {
                (
                    format!("`{e}`, where `{a}` may be negative"),
                    format!("a base that is never negative, such as abs({a})**{b}*sign({a})"),
                )
            }
            Expression::Binary(Operator::Power, a, _) => (
                format!("`{e}`, where `{a}` may be zero, or the power too large"),
                "a power that is finite".to_owned(),
            ),
            Expression::Of(Function::Sqrt, a) => {
                (format!("`{e}`, where `{a}` may be negative"), "a root of what is never negative".to_owned())
            }
            _ => (format!("`{e}`, which may be too large for a number"), "what is finite".to_owned()),
        };
        Doubt { found, allowed }
    }
}

//! The dimension of every subexpression, and which of them do not go together.

use std::collections::BTreeMap;
use std::fmt;

use crate::error::FormulaError;
use crate::expression::{Expression, Function, Operator};
use crate::parse::Parsed;

/// Powers of kg, m and s. An angle has none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimension(pub [f64; 3]);

/// Exponents nearer than this are one: those of a product of powers carry roundings.
const SAME: f64 = 1e-9;

impl Dimension {
    /// A pure number.
    pub const NONE: Self = Self([0.0; 3]);
    /// A force, N.
    pub const FORCE: Self = Self([1.0, 1.0, -2.0]);
    /// A moment, N m.
    pub const MOMENT: Self = Self([1.0, 2.0, -2.0]);
    /// A length, m.
    pub const LENGTH: Self = Self([0.0, 1.0, 0.0]);
    /// A velocity, m/s.
    pub const VELOCITY: Self = Self([0.0, 1.0, -1.0]);
    /// A rate of rotation, rad/s.
    pub const RATE: Self = Self([0.0, 0.0, -1.0]);

    /// Of a product.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i] + other.0[i]))
    }

    /// Of a power.
    #[must_use]
    pub fn to(self, exponent: f64) -> Self {
        Self(self.0.map(|power| power * exponent))
    }

    /// Whether two are the same.
    pub fn is(self, other: Self) -> bool {
        (0..3).all(|i| (self.0[i] - other.0[i]).abs() <= SAME)
    }
}

/// In newtons where mass occurs as in a force: `N*(s/m)**1.7`; else in kg, m and s.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [kg, m, s] = self.0;
        let rounded = |power: f64| (power * 1e9).round() / 1e9;
        let powers = match rounded(kg) {
            1.0 => [("N", 1.0), ("m", rounded(m - 1.0)), ("s", rounded(s + 2.0))],
            kg => [("kg", kg), ("m", rounded(m)), ("s", rounded(s))],
        };
        let write = |(unit, power): &(&str, f64)| match power.abs() {
            1.0 => (*unit).to_owned(),
            power => format!("{unit}**{power}"),
        };
        let over: Vec<_> = powers.iter().filter(|(_, power)| *power > 0.0).map(write).collect();
        let under: Vec<_> = powers.iter().filter(|(_, power)| *power < 0.0).map(write).collect();
        match (over.is_empty(), &under[..]) {
            (true, []) => f.write_str("a pure number"),
            (true, under) => write!(f, "1/{}", bracketed(under)),
            (false, []) => f.write_str(&over.join("*")),
            (false, under) => write!(f, "{}/{}", over.join("*"), bracketed(under)),
        }
    }
}

fn bracketed(factors: &[String]) -> String {
    if factors.len() == 1 { factors[0].clone() } else { format!("({})", factors.join("*")) }
}

/// The dimension of a subexpression; a bare zero has any.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Found {
    Any,
    One(Dimension),
}

impl Found {
    fn is(self, other: Dimension) -> bool {
        match self {
            Found::Any => true,
            Found::One(own) => own.is(other),
        }
    }
}

/// What people write for the acceleration of the top, and why no formula has it.
const ACCELERATION: &str = "a";
const NO_ACCELERATION: &str =
    "; what goes with the acceleration is a mass, which takes part in impacts too: carriage_mass";

/// What is known of the names of a formula.
pub struct Names<'a> {
    /// Dimensions of variables and parameters.
    pub dimensions: BTreeMap<&'a str, Dimension>,
    /// Values of parameters.
    pub values: BTreeMap<&'a str, f64>,
    /// In words, for messages.
    pub known: String,
}

struct Check<'a> {
    names: &'a Names<'a>,
    places: &'a [usize],
    /// Parts seen so far.
    seen: usize,
}

/// Refuses an expression whose parts do not go together, or that is not of this dimension.
///
/// # Errors
/// The subexpression, its dimension, and what is allowed.
pub fn check(parsed: &Parsed, names: &Names, result: Dimension) -> Result<(), FormulaError> {
    let mut check = Check { names, places: &parsed.places, seen: 0 };
    let whole = check.of(&parsed.expression)?;
    match whole {
        Found::One(own) if !own.is(result) => {
            Err(FormulaError::new(Some(1), format!("`{}` in {own}", parsed.expression), format!("{result}")))
        }
        _ => Ok(()),
    }
}

impl Check<'_> {
    fn of(&mut self, part: &Expression) -> Result<Found, FormulaError> {
        let parts = part.parts().into_iter().map(|inner| self.of(inner)).collect::<Result<Vec<_>, _>>()?;
        let at = self.places.get(self.seen).copied();
        self.seen += 1;
        let found = match (part, &parts[..]) {
            (Expression::Number(value), _) => Ok(number(*value)),
            (Expression::Name(name), _) => self.named(name),
            (Expression::Negative(_), [a]) => Ok(*a),
            (Expression::Of(function, inner), [a]) => of_one(*function, inner, *a),
            (Expression::OfTwo(function, x, y), [a, b]) => same([x, y], [*a, *b], function.name()),
            (Expression::Binary(operator, x, y), [a, b]) => self.binary(*operator, [x, y], [*a, *b]),
            _ => unreachable!("each kind of expression has as many parts as it says"),
        };
        found.map_err(|(found, allowed)| FormulaError::new(at, found, allowed))
    }

    fn named(&self, name: &str) -> Result<Found, (String, String)> {
        match self.names.dimensions.get(name) {
            Some(dimension) => Ok(Found::One(*dimension)),
            None => {
                let hint = if name == ACCELERATION { NO_ACCELERATION } else { "" };
                Err((format!("an unknown name `{name}`"), format!("{}{hint}", self.names.known)))
            }
        }
    }

    fn binary(
        &self,
        operator: Operator,
        [x, y]: [&Expression; 2],
        [a, b]: [Found; 2],
    ) -> Result<Found, (String, String)> {
        match operator {
            Operator::Add | Operator::Subtract => same([x, y], [a, b], operator.sign()),
            Operator::Multiply => Ok(product(a, b, 1.0)),
            Operator::Divide => Ok(product(a, b, -1.0)),
            Operator::Power => self.power([x, y], [a, b]),
            _ => same([x, y], [a, b], operator.sign()).map(|_| Found::One(Dimension::NONE)),
        }
    }

    fn power(&self, [x, y]: [&Expression; 2], [a, b]: [Found; 2]) -> Result<Found, (String, String)> {
        if let (Found::One(own), false) = (b, b.is(Dimension::NONE)) {
            return Err((format!("the exponent `{y}` in {own}"), "a pure number".to_owned()));
        }
        match a {
            Found::One(own) if !own.is(Dimension::NONE) => match y.constant(&self.names.values) {
                Some(exponent) => Ok(Found::One(own.to(exponent))),
                None => Err((
                    format!("`{x}` in {own} to the power `{y}`, which varies"),
                    "an exponent of numbers and parameters, or a base without a unit such as x/x_0"
                        .to_owned(),
                )),
            },
            _ => Ok(Found::One(Dimension::NONE)),
        }
    }
}

fn number(value: f64) -> Found {
    if value == 0.0 { Found::Any } else { Found::One(Dimension::NONE) }
}

fn product(a: Found, b: Found, power: f64) -> Found {
    match (a, b) {
        (Found::One(a), Found::One(b)) => Found::One(a.times(b.to(power))),
        _ => Found::Any,
    }
}

fn same([x, y]: [&Expression; 2], [a, b]: [Found; 2], sign: &str) -> Result<Found, (String, String)> {
    match (a, b) {
        (Found::Any, other) | (other, Found::Any) => Ok(other),
        (Found::One(of_x), Found::One(of_y)) if of_x.is(of_y) => Ok(a),
        (Found::One(of_x), Found::One(of_y)) => {
            let found = format!("`{x}` in {of_x} and `{y}` in {of_y} for `{sign}`");
            let hint = "; a number with a unit is a parameter";
            let lone = [x, y].iter().any(|e| matches!(e, Expression::Number(_)));
            Err((found, format!("one unit on both sides{}", if lone { hint } else { "" })))
        }
    }
}

fn of_one(function: Function, inner: &Expression, a: Found) -> Result<Found, (String, String)> {
    let dimension = match a {
        Found::Any => Dimension::NONE,
        Found::One(own) => own,
    };
    match function {
        Function::Sqrt => Ok(Found::One(dimension.to(0.5))),
        Function::Sign => Ok(Found::One(Dimension::NONE)),
        Function::Abs => Ok(a),
        _ if dimension.is(Dimension::NONE) => Ok(Found::One(Dimension::NONE)),
        _ => Err((
            format!("`{inner}` in {dimension} for `{}`", function.name()),
            "a pure number: divide it by a parameter of the same unit".to_owned(),
        )),
    }
}

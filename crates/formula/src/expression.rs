//! The expression of a formula as a tree, and how it is written.

use std::collections::BTreeMap;
use std::fmt;

use crate::number::Number;
use crate::program::whole_exponent;

/// An operation on two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `**`
    Power,
    /// `<`, 0 or 1.
    Less,
    /// `<=`, 0 or 1.
    LessOrEqual,
    /// `>`, 0 or 1.
    Greater,
    /// `>=`, 0 or 1.
    GreaterOrEqual,
}

impl Operator {
    /// As it is written.
    pub fn sign(self) -> &'static str {
        match self {
            Operator::Add => "+",
            Operator::Subtract => "-",
            Operator::Multiply => "*",
            Operator::Divide => "/",
            Operator::Power => "**",
            Operator::Less => "<",
            Operator::LessOrEqual => "<=",
            Operator::Greater => ">",
            Operator::GreaterOrEqual => ">=",
        }
    }

    /// Whether it is a comparison.
    pub fn compares(self) -> bool {
        matches!(self, Operator::Less | Operator::LessOrEqual | Operator::Greater | Operator::GreaterOrEqual)
    }

    pub(crate) fn of<N: Number>(self, a: N, b: N) -> N {
        match self {
            Operator::Add => a.add(b),
            Operator::Subtract => a.sub(b),
            Operator::Multiply => a.mul(b),
            Operator::Divide => a.div(b),
            Operator::Power => a.pow(b),
            Operator::Less => b.above(a, false),
            Operator::LessOrEqual => b.above(a, true),
            Operator::Greater => a.above(b, false),
            Operator::GreaterOrEqual => a.above(b, true),
        }
    }

    /// How tightly it binds.
    fn binds(self) -> u8 {
        match self {
            Operator::Add | Operator::Subtract => SUM,
            Operator::Multiply | Operator::Divide => PRODUCT,
            Operator::Power => POWER,
            _ => COMPARISON,
        }
    }
}

const COMPARISON: u8 = 0;
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

/// A function of one number, or of two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// Magnitude.
    Abs,
    /// -1, 0 or 1.
    Sign,
    /// The larger of two.
    Max,
    /// The smaller of two.
    Min,
    /// Square root.
    Sqrt,
    /// Exponential.
    Exp,
    /// Hyperbolic tangent.
    Tanh,
    /// Arc tangent.
    Atan,
}

impl Function {
    /// Every function there is.
    pub const ALL: [Function; 8] = [
        Function::Abs,
        Function::Sign,
        Function::Max,
        Function::Min,
        Function::Sqrt,
        Function::Exp,
        Function::Tanh,
        Function::Atan,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Function::Abs => "abs",
            Function::Sign => "sign",
            Function::Max => "max",
            Function::Min => "min",
            Function::Sqrt => "sqrt",
            Function::Exp => "exp",
            Function::Tanh => "tanh",
            Function::Atan => "atan",
        }
    }

    /// Of one number.
    pub(crate) fn of<N: Number>(self, a: N) -> N {
        match self {
            Function::Abs | Function::Max | Function::Min => a.abs(),
            Function::Sign => a.sign(),
            Function::Sqrt => a.sqrt(),
            Function::Exp => a.exp(),
            Function::Tanh => a.tanh(),
            Function::Atan => a.atan(),
        }
    }

    /// Whether it takes two numbers (or more, as written), and not one.
    pub fn takes_two(self) -> bool {
        matches!(self, Function::Max | Function::Min)
    }
}

/// An expression: numbers, names, and what is done to them.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number, not negative as it is read.
    Number(f64),
    /// A variable or a parameter.
    Name(String),
    /// The negative.
    Negative(Box<Expression>),
    /// An operation on two.
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// A function of one.
    Of(Function, Box<Expression>),
    /// The larger or the smaller of two.
    OfTwo(Function, Box<Expression>, Box<Expression>),
}

impl Expression {
    /// A name.
    pub fn name(name: &str) -> Self {
        Expression::Name(name.to_owned())
    }

    /// An operation on two expressions.
    pub fn binary(operator: Operator, left: Expression, right: Expression) -> Self {
        Expression::Binary(operator, Box::new(left), Box::new(right))
    }

    /// The expressions of which it is made.
    pub fn parts(&self) -> Vec<&Expression> {
        match self {
            Expression::Number(_) | Expression::Name(_) => Vec::new(),
            Expression::Negative(a) | Expression::Of(_, a) => vec![a],
            Expression::Binary(_, a, b) | Expression::OfTwo(_, a, b) => vec![a, b],
        }
    }

    /// How many numbers, names and operations it has.
    pub fn nodes(&self) -> usize {
        1 + self.parts().into_iter().map(Expression::nodes).sum::<usize>()
    }

    /// How deep it is nested.
    pub fn depth(&self) -> usize {
        1 + self.parts().into_iter().map(Expression::depth).max().unwrap_or(0)
    }

    /// Whether a name occurs in it.
    pub fn has(&self, name: &str) -> bool {
        matches!(self, Expression::Name(own) if own == name) || self.parts().iter().any(|part| part.has(name))
    }

    /// The value where every name is a parameter; `None` where one is not. As Python reads it.
    pub fn constant(&self, values: &BTreeMap<&str, f64>) -> Option<f64> {
        self.over(values, &|_| None)
    }

    /// The value as it is written, parameters and variables by name; `None` where a name is neither.
    pub(crate) fn over<N: Number>(
        &self,
        values: &BTreeMap<&str, f64>,
        variable: &impl Fn(&str) -> Option<N>,
    ) -> Option<N> {
        let of = |part: &Expression| part.over(values, variable);
        Some(match self {
            Expression::Number(value) => N::constant(*value),
            Expression::Name(name) => match values.get(name.as_str()) {
                Some(value) => N::constant(*value),
                None => variable(name)?,
            },
            Expression::Negative(a) => of(a)?.neg(),
            Expression::Of(function, a) => function.of(of(a)?),
            Expression::OfTwo(Function::Max, a, b) => of(a)?.max(of(b)?),
            Expression::OfTwo(_, a, b) => of(a)?.min(of(b)?),
            Expression::Binary(Operator::Power, a, b) => match b.constant(values).and_then(whole_exponent) {
                Some(exponent) => of(a)?.powi(exponent),
                None => of(a)?.pow(of(b)?),
            },
            Expression::Binary(operator, a, b) => operator.of(of(a)?, of(b)?),
        })
    }

    fn binds(&self) -> u8 {
        match self {
            Expression::Number(value) if value.is_sign_negative() => SIGN,
            Expression::Number(_) | Expression::Name(_) | Expression::Of(..) | Expression::OfTwo(..) => ATOM,
            Expression::Negative(_) => SIGN,
            Expression::Binary(operator, ..) => operator.binds(),
        }
    }

    /// In parentheses where it binds less tightly than it must.
    fn at_least(&self, binds: u8, f: &mut fmt::Formatter) -> fmt::Result {
        if self.binds() >= binds { write!(f, "{self}") } else { write!(f, "({self})") }
    }
}

/// As it is read: what is printed is parsed to the same expression.
impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Expression::Number(value) => write_number(*value, f),
            Expression::Name(name) => f.write_str(name),
            Expression::Negative(a) => {
                f.write_str("-")?;
                a.at_least(SIGN, f)
            }
            Expression::Of(function, a) => write!(f, "{}({a})", function.name()),
            Expression::OfTwo(function, a, b) => write!(f, "{}({a}, {b})", function.name()),
            Expression::Binary(operator, a, b) => write_binary(*operator, a, b, f),
        }
    }
}

/// Without an exponent where that is short.
fn write_number(value: f64, f: &mut fmt::Formatter) -> fmt::Result {
    let plain = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    if plain { write!(f, "{value}") } else { write!(f, "{value:e}") }
}

fn write_binary(operator: Operator, a: &Expression, b: &Expression, f: &mut fmt::Formatter) -> fmt::Result {
    let binds = operator.binds();
    // A power goes from right to left; its exponent may begin with a sign. All else goes from left to right.
    let (left, right) = match operator {
        Operator::Power => (ATOM, SIGN),
        _ if operator.compares() => (SUM, SUM),
        _ => (binds, binds + 1),
    };
    a.at_least(left, f)?;
    match binds {
        COMPARISON | SUM => write!(f, " {} ", operator.sign())?,
        _ => f.write_str(operator.sign())?,
    }
    b.at_least(right, f)
}

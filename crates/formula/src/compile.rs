//! From an expression to a program: the tape, and which operations turn at the same switch.

use std::collections::BTreeMap;

use crate::error::FormulaError;
use crate::expression::{Expression, Function, Operator};
use crate::parse::MOST_DEPTH;
use crate::program::{MOST_SWITCHES, Program, RateTape, STACK, Step, Tape, VARIABLES, whole_exponent};
use crate::switch::{Surface, Switch, SwitchAt, SwitchUse};

/// Makes a program of an expression, and of the rates of carried states, whose names are known.
///
/// # Errors
/// More switches than there is room for.
pub(crate) fn compile(
    expression: &Expression,
    rates: &[Expression],
    variables: &[&str],
    values: &BTreeMap<&str, f64>,
) -> Result<Program, FormulaError> {
    let mut compiler = Compiler { variables, values, switches: Vec::new() };
    let tape = compiler.whole(expression)?;
    let terms = compiler.terms(expression)?;
    let rate = |rate: &Expression| Ok(RateTape { tape: compiler.whole(rate)?, terms: compiler.terms(rate)? });
    let rates = rates.iter().map(rate).collect::<Result<Vec<_>, FormulaError>>()?;
    Ok(Program { stack: tape.stack(), tape, switches: compiler.switches, terms, rates })
}

struct Compiler<'a> {
    variables: &'a [&'a str],
    values: &'a BTreeMap<&'a str, f64>,
    switches: Vec<Switch>,
}

impl Compiler<'_> {
    fn whole(&mut self, e: &Expression) -> Result<Tape, FormulaError> {
        let tape = self.tape(e)?;
        if tape.stack() > STACK {
            let allowed = format!("at most {MOST_DEPTH} levels");
            return Err(FormulaError::new(None, "a formula nested too deeply", allowed));
        }
        Ok(tape)
    }

    fn terms(&mut self, e: &Expression) -> Result<Vec<Tape>, FormulaError> {
        expanded(e).iter().map(|term| self.tape(term)).collect()
    }

    fn variable(&self, name: &str) -> Option<usize> {
        self.variables.iter().position(|own| *own == name)
    }

    /// Whether an expression changes between switches. A sign or a comparison does not.
    fn moves(&self, e: &Expression) -> bool {
        match e {
            Expression::Name(name) => self.variable(name).is_some(),
            Expression::Of(Function::Sign, _) => false,
            Expression::Binary(operator, ..) if operator.compares() => false,
            _ => e.parts().into_iter().any(|part| self.moves(part)),
        }
    }

    fn tape(&mut self, e: &Expression) -> Result<Tape, FormulaError> {
        let mut steps = Vec::new();
        self.write(e, &mut steps)?;
        Ok(Tape(steps))
    }

    fn write(&mut self, e: &Expression, steps: &mut Vec<Step>) -> Result<(), FormulaError> {
        if let Some(value) = e.constant(self.values) {
            steps.push(Step::Constant(value));
            return Ok(());
        }
        match e {
            Expression::Number(value) => steps.push(Step::Constant(*value)),
            Expression::Name(name) => steps.push(self.named(name)),
            Expression::Negative(a) => self.one(a, Step::Negative, steps)?,
            Expression::Of(Function::Abs | Function::Sign, a) => self.switched(e, a, steps)?,
            Expression::Of(function, a) => self.one(a, Step::Smooth(*function), steps)?,
            Expression::OfTwo(function, a, b) => self.extreme(*function, a, b, steps)?,
            Expression::Binary(operator, a, b) => self.binary(*operator, a, b, steps)?,
        }
        Ok(())
    }

    fn named(&self, name: &str) -> Step {
        match self.variable(name) {
            Some(variable) => Step::Variable(variable),
            // The check of dimensions has refused names that are neither.
            None => Step::Constant(self.values.get(name).copied().unwrap_or(f64::NAN)),
        }
    }

    fn one(&mut self, a: &Expression, step: Step, steps: &mut Vec<Step>) -> Result<(), FormulaError> {
        self.write(a, steps)?;
        steps.push(step);
        Ok(())
    }

    fn binary(
        &mut self,
        operator: Operator,
        a: &Expression,
        b: &Expression,
        steps: &mut Vec<Step>,
    ) -> Result<(), FormulaError> {
        let whole = || b.constant(self.values).and_then(whole_exponent);
        match operator {
            Operator::Less => return self.compared(b, a, false, steps),
            Operator::LessOrEqual => return self.compared(b, a, true, steps),
            Operator::Greater => return self.compared(a, b, false, steps),
            Operator::GreaterOrEqual => return self.compared(a, b, true, steps),
            Operator::Power => {
                if let Some(exponent) = whole() {
                    return self.one(a, Step::WholePower(exponent), steps);
                }
            }
            _ => {}
        }
        self.write(a, steps)?;
        self.write(b, steps)?;
        steps.push(match operator {
            Operator::Add => Step::Add,
            Operator::Subtract => Step::Subtract,
            Operator::Multiply => Step::Multiply,
            Operator::Divide => Step::Divide,
            _ => Step::Power,
        });
        Ok(())
    }

    /// `abs` or `sign`. Of a product it is the product of those of the factors, to the bit: so each factor has
    /// its own switch, and `sign(x*v)` turns where x or v does.
    fn switched(
        &mut self,
        e: &Expression,
        a: &Expression,
        steps: &mut Vec<Step>,
    ) -> Result<(), FormulaError> {
        let Expression::Of(function, _) = e else { return Ok(()) };
        let of = |part: &Expression| Expression::Of(*function, Box::new(part.clone()));
        let is_sign = *function == Function::Sign;
        if self.line(a).is_none() {
            match a {
                Expression::Binary(operator @ (Operator::Multiply | Operator::Divide), x, y) => {
                    return self.binary(*operator, &of(x), &of(y), steps);
                }
                Expression::Negative(x) if is_sign => return self.one(&of(x), Step::Negative, steps),
                Expression::Negative(x) => return self.write(&of(x), steps),
                Expression::Binary(Operator::Power, x, n) if self.is_odd(n) => {
                    return self.binary(Operator::Power, &of(x), n, steps);
                }
                _ => {}
            }
        }
        let from = steps.len();
        self.write(a, steps)?;
        let switch = self.switch(a, steps[from..].to_vec(), is_sign)?;
        steps.push(if is_sign { Step::Sign(switch) } else { Step::Abs(switch) });
        Ok(())
    }

    fn is_odd(&self, n: &Expression) -> bool {
        n.constant(self.values).and_then(whole_exponent).is_some_and(|n| n > 0 && n % 2 == 1)
    }

    fn extreme(
        &mut self,
        function: Function,
        a: &Expression,
        b: &Expression,
        steps: &mut Vec<Step>,
    ) -> Result<(), FormulaError> {
        let from = steps.len();
        self.write(a, steps)?;
        self.write(b, steps)?;
        let switch = self.switch(&difference(a, b), less(&steps[from..]), false)?;
        steps.push(if function == Function::Max { Step::Max(switch) } else { Step::Min(switch) });
        Ok(())
    }

    /// 1 where a is above b. A product above zero is its sign above zero.
    fn compared(
        &mut self,
        a: &Expression,
        b: &Expression,
        or_equal: bool,
        steps: &mut Vec<Step>,
    ) -> Result<(), FormulaError> {
        let argument = difference(a, b);
        let factors = |e: &Expression| {
            matches!(
                e,
                Expression::Binary(Operator::Multiply | Operator::Divide, ..) | Expression::Negative(_)
            )
        };
        let sign = Expression::Of(Function::Sign, Box::new(argument.clone()));
        if factors(&argument) && self.line(&argument).is_none() && self.moves(&argument) {
            return self.compared(&sign, &Expression::Number(0.0), or_equal, steps);
        }
        let from = steps.len();
        self.write(a, steps)?;
        self.write(b, steps)?;
        let switch = self.switch(&argument, less(&steps[from..]), true)?;
        steps.push(Step::Above { switch, or_equal });
        Ok(())
    }

    /// The switch that turns with an expression, whose steps these are; `None` where it does not change between
    /// other switches.
    fn switch(
        &mut self,
        argument: &Expression,
        steps: Vec<Step>,
        may_jump: bool,
    ) -> Result<Option<SwitchUse>, FormulaError> {
        let still = |slopes: Linear| slopes[..VARIABLES] == [0.0; VARIABLES];
        if !self.moves(argument) || self.linear(argument).is_some_and(still) {
            return Ok(None);
        }
        let (at, flipped) = match self.line(argument) {
            Some((variable, slope, constant)) => {
                // To +0, so that one zero is one switch.
                (SwitchAt::Line { variable, value: -constant / slope + 0.0 }, slope < 0.0)
            }
            None => {
                let mut variables = [false; VARIABLES];
                for (has, name) in variables.iter_mut().zip(self.variables) {
                    *has = argument.has(name);
                }
                (SwitchAt::Surface(Surface { tape: Tape(steps), variables }), false)
            }
        };
        let index = match self.switches.iter().position(|switch| switch.at == at) {
            Some(index) => index,
            None => self.added(at)?,
        };
        self.switches[index].may_jump |= may_jump;
        Ok(Some(SwitchUse { index, flipped }))
    }

    fn added(&mut self, at: SwitchAt) -> Result<usize, FormulaError> {
        if self.switches.len() == MOST_SWITCHES {
            let found = format!("more than {MOST_SWITCHES} different places where branches change");
            return Err(FormulaError::new(None, found, "fewer of abs, sign, max, min and comparisons"));
        }
        self.switches.push(Switch { at, may_jump: false });
        Ok(self.switches.len() - 1)
    }

    /// Variable, slope and constant of an expression that is linear in one variable.
    fn line(&self, e: &Expression) -> Option<(usize, f64, f64)> {
        let slope_and_constant = self.linear(e)?;
        let mut variables = (0..VARIABLES).filter(|i| slope_and_constant[*i] != 0.0);
        let variable = variables.next()?;
        let lone = variables.next().is_none() && slope_and_constant.iter().all(|x| x.is_finite());
        lone.then(|| (variable, slope_and_constant[variable], slope_and_constant[VARIABLES]))
    }

    /// Slopes by each variable, and the constant, of a linear expression.
    fn linear(&self, e: &Expression) -> Option<Linear> {
        if let Some(value) = e.constant(self.values) {
            let mut constant = [0.0; VARIABLES + 1];
            constant[VARIABLES] = value;
            return Some(constant);
        }
        match e {
            Expression::Name(name) => {
                let mut slopes = [0.0; VARIABLES + 1];
                slopes[self.variable(name)?] = 1.0;
                Some(slopes)
            }
            Expression::Negative(a) => Some(self.linear(a)?.map(|x| -x)),
            Expression::Binary(operator, a, b) => self.linear_of_two(*operator, a, b),
            _ => None,
        }
    }

    fn linear_of_two(&self, operator: Operator, a: &Expression, b: &Expression) -> Option<Linear> {
        let each = |of: fn(f64, f64) -> f64| {
            let (a, b) = (self.linear(a)?, self.linear(b)?);
            Some(std::array::from_fn(|i| of(a[i], b[i])))
        };
        match operator {
            Operator::Add => each(|a, b| a + b),
            Operator::Subtract => each(|a, b| a - b),
            Operator::Multiply => match (a.constant(self.values), b.constant(self.values)) {
                (Some(factor), None) => Some(self.linear(b)?.map(|x| factor * x)),
                (None, Some(factor)) => Some(self.linear(a)?.map(|x| x * factor)),
                _ => None,
            },
            Operator::Divide => {
                let divisor = b.constant(self.values)?;
                Some(self.linear(a)?.map(|x| x / divisor))
            }
            _ => None,
        }
    }
}

/// Slopes by each variable, and a constant.
type Linear = [f64; VARIABLES + 1];

/// Terms of an expanded sum at most; what has more is left as it is.
const MOST_TERMS: usize = 64;

/// The terms of a sum, products of sums multiplied out: what an interval of a difference can be told from.
fn expanded(e: &Expression) -> Vec<Expression> {
    let negative = |e: Expression| Expression::Negative(Box::new(e));
    let terms: Vec<Expression> = match e {
        Expression::Binary(Operator::Add, a, b) => [expanded(a), expanded(b)].concat(),
        Expression::Binary(Operator::Subtract, a, b) => {
            expanded(a).into_iter().chain(expanded(b).into_iter().map(negative)).collect()
        }
        Expression::Negative(a) => expanded(a).into_iter().map(negative).collect(),
        Expression::Binary(operator @ (Operator::Multiply | Operator::Divide), a, b) => {
            let factors = if *operator == Operator::Multiply { expanded(b) } else { vec![(**b).clone()] };
            let of = |x: &Expression, y: &Expression| Expression::binary(*operator, x.clone(), y.clone());
            expanded(a).iter().flat_map(|x| factors.iter().map(move |y| of(x, y))).collect()
        }
        _ => return vec![e.clone()],
    };
    if terms.len() > MOST_TERMS { vec![e.clone()] } else { terms }
}

/// Steps of a and b, and their difference.
fn less(of_both: &[Step]) -> Vec<Step> {
    of_both.iter().copied().chain([Step::Subtract]).collect()
}

/// a - b, or a alone where b is zero.
fn difference(a: &Expression, b: &Expression) -> Expression {
    match (a, b) {
        (_, Expression::Number(0.0)) => a.clone(),
        (Expression::Number(0.0), _) => Expression::Negative(Box::new(b.clone())),
        _ => Expression::binary(Operator::Subtract, a.clone(), b.clone()),
    }
}

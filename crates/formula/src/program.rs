//! An expression with the values of its parameters, as a tape that is run on a small stack.

use std::collections::BTreeMap;

use crate::error::FormulaError;
use crate::expression::{Expression, Function, Operator};
use crate::number::{Moving, Number};
use crate::parse::MOST_DEPTH;
use crate::switch::{Branch, Branches, Surface, Switch, SwitchAt, SwitchUse};

/// Values of the three variables of a place.
pub type State<N = f64> = [N; 3];

/// Switches of a formula at most.
pub const MOST_SWITCHES: usize = 24;

/// Numbers that wait on the stack at most: no more than there are levels, and one.
const STACK: usize = MOST_DEPTH + 1;

/// Whole exponents up to this size are products; others, as all exponents, are powers.
const MOST_FACTORS: f64 = 64.0;

/// One step of a tape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Step {
    Constant(f64),
    Variable(usize),
    Negative,
    Add,
    Subtract,
    Multiply,
    Divide,
    WholePower(i32),
    Power,
    Smooth(Function),
    Abs(Option<SwitchUse>),
    Sign(Option<SwitchUse>),
    /// Its switch turns with the first less the second.
    Max(Option<SwitchUse>),
    Min(Option<SwitchUse>),
    /// 1 where the first is above the second.
    Above {
        switch: Option<SwitchUse>,
        or_equal: bool,
    },
}

/// Steps of an expression, parts before what is made of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tape(pub(crate) Vec<Step>);

/// A formula ready to run: its tape and its switches.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    pub(crate) tape: Tape,
    pub(crate) switches: Vec<Switch>,
    /// The terms of its sum, for what only some of them have.
    pub(crate) terms: Vec<Tape>,
}

impl Program {
    /// The value at a state, in the branches given.
    #[inline]
    pub fn value(&self, state: State, branches: &Branches) -> f64 {
        self.tape.run(state, branches)
    }

    /// How fast the value changes where the variables change at these rates.
    pub fn rate(&self, state: State, rates: State, branches: &Branches) -> f64 {
        let moving = [0, 1, 2].map(|i| Moving { value: state[i], rate: rates[i] });
        self.tape.run(moving, branches).rate
    }

    /// Its switches; [`Branches`] counts them in this order. An argument depends on switches before it only.
    pub fn switches(&self) -> &[Switch] {
        &self.switches
    }

    /// Every switch in the branch of a state. One whose argument is zero takes that of its rate, or the
    /// positive one.
    pub fn branches_at(&self, state: State, rates: State) -> Branches {
        let mut branches = Branches::FREE;
        for (i, switch) in self.switches.iter().enumerate() {
            let (argument, rate) = switch.argument_and_rate(state, rates, &branches);
            let side = [argument, rate].into_iter().map(Branch::of).find(|side| *side != Branch::Zero);
            branches = branches.with(i, side.unwrap_or(Branch::Positive));
        }
        branches
    }
}

impl Tape {
    /// The value of the expression.
    pub(crate) fn run<N: Number>(&self, state: State<N>, branches: &Branches) -> N {
        let mut stack = [N::constant(0.0); STACK];
        let mut top = 0;
        for step in &self.0 {
            match step {
                Step::Constant(value) => stack[top] = N::constant(*value),
                Step::Variable(variable) => stack[top] = state[*variable],
                step if step.takes_two() => {
                    top -= 2;
                    stack[top] = step.of_two(stack[top], stack[top + 1], branches);
                }
                step => {
                    top -= 1;
                    stack[top] = step.of_one(stack[top], branches);
                }
            }
            top += 1;
        }
        stack[0]
    }
}

impl Step {
    fn takes_two(&self) -> bool {
        matches!(
            self,
            Step::Add
                | Step::Subtract
                | Step::Multiply
                | Step::Divide
                | Step::Power
                | Step::Max(_)
                | Step::Min(_)
                | Step::Above { .. }
        )
    }

    fn of_one<N: Number>(&self, a: N, branches: &Branches) -> N {
        match self {
            Step::Negative => a.neg(),
            Step::WholePower(exponent) => a.powi(*exponent),
            Step::Abs(switch) => match branches.seen_by(*switch) {
                Branch::Free => a.abs(),
                Branch::Negative => a.neg(),
                Branch::Zero => N::constant(0.0),
                Branch::Positive => a,
            },
            Step::Sign(switch) => match branches.seen_by(*switch) {
                Branch::Free => a.sign(),
                side => N::constant(side.sign()),
            },
            Step::Smooth(Function::Sqrt) => root_argument(a, branches).sqrt(),
            Step::Smooth(Function::Exp) => a.exp(),
            Step::Smooth(Function::Tanh) => a.tanh(),
            Step::Smooth(Function::Atan) => a.atan(),
            _ => a,
        }
    }

    fn of_two<N: Number>(&self, a: N, b: N, branches: &Branches) -> N {
        match self {
            Step::Add => a.add(b),
            Step::Subtract => a.sub(b),
            Step::Multiply => a.mul(b),
            Step::Divide => a.div(b),
            Step::Power => root_argument(a, branches).pow(b),
            Step::Max(switch) => match branches.seen_by(*switch) {
                Branch::Free => a.max(b),
                Branch::Negative => b,
                Branch::Zero | Branch::Positive => a,
            },
            Step::Min(switch) => match branches.seen_by(*switch) {
                Branch::Free => a.min(b),
                Branch::Negative => a,
                Branch::Zero | Branch::Positive => b,
            },
            Step::Above { switch, or_equal } => match branches.seen_by(*switch) {
                Branch::Free => a.above(b, *or_equal),
                Branch::Negative => N::constant(0.0),
                Branch::Zero => N::constant(f64::from(u8::from(*or_equal))),
                Branch::Positive => N::constant(1.0),
            },
            _ => a,
        }
    }
}

/// What a root is taken of. A step that looks for the end of a branch tries states beyond it, where a frozen
/// magnitude is negative: no root is there, and zero goes on from the end.
fn root_argument<N: Number>(a: N, branches: &Branches) -> N {
    if branches.is_frozen() { a.not_negative() } else { a }
}

/// Makes a program of an expression whose names are known.
///
/// # Errors
/// More switches than there is room for.
pub(crate) fn compile(
    expression: &Expression,
    variables: [&'static str; 3],
    values: &BTreeMap<&str, f64>,
) -> Result<Program, FormulaError> {
    let mut compiler = Compiler { variables, values, switches: Vec::new() };
    let tape = compiler.tape(expression)?;
    if tape.stack() > STACK {
        return Err(FormulaError::new(
            None,
            "a formula nested too deeply",
            format!("at most {MOST_DEPTH} levels"),
        ));
    }
    let terms = expanded(expression).iter().map(|term| compiler.tape(term)).collect::<Result<Vec<_>, _>>()?;
    Ok(Program { tape, switches: compiler.switches, terms })
}

struct Compiler<'a> {
    variables: [&'static str; 3],
    values: &'a BTreeMap<&'a str, f64>,
    switches: Vec<Switch>,
}

impl Compiler<'_> {
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
        let still = |slopes: [f64; 4]| slopes[..3] == [0.0; 3];
        if !self.moves(argument) || self.linear(argument).is_some_and(still) {
            return Ok(None);
        }
        let (at, flipped) = match self.line(argument) {
            Some((variable, slope, constant)) => {
                // To +0, so that one zero is one switch.
                (SwitchAt::Line { variable, value: -constant / slope + 0.0 }, slope < 0.0)
            }
            None => {
                let variables = self.variables.map(|name| argument.has(name));
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
        let mut variables = (0..3).filter(|i| slope_and_constant[*i] != 0.0);
        let variable = variables.next()?;
        let lone = variables.next().is_none() && slope_and_constant.iter().all(|x| x.is_finite());
        lone.then(|| (variable, slope_and_constant[variable], slope_and_constant[3]))
    }

    /// Slopes by each variable, and the constant, of a linear expression.
    fn linear(&self, e: &Expression) -> Option<[f64; 4]> {
        if let Some(value) = e.constant(self.values) {
            return Some([0.0, 0.0, 0.0, value]);
        }
        match e {
            Expression::Name(name) => {
                let mut slopes = [0.0; 4];
                slopes[self.variable(name)?] = 1.0;
                Some(slopes)
            }
            Expression::Negative(a) => Some(self.linear(a)?.map(|x| -x)),
            Expression::Binary(operator, a, b) => self.linear_of_two(*operator, a, b),
            _ => None,
        }
    }

    fn linear_of_two(&self, operator: Operator, a: &Expression, b: &Expression) -> Option<[f64; 4]> {
        let each = |of: fn(f64, f64) -> f64| {
            let (a, b) = (self.linear(a)?, self.linear(b)?);
            Some([0, 1, 2, 3].map(|i| of(a[i], b[i])))
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

/// Whole exponents that are products.
pub(crate) fn whole_exponent(exponent: f64) -> Option<i32> {
    (exponent.fract() == 0.0 && exponent.abs() <= MOST_FACTORS).then_some(exponent as i32)
}

/// a - b, or a alone where b is zero.
fn difference(a: &Expression, b: &Expression) -> Expression {
    match (a, b) {
        (_, Expression::Number(0.0)) => a.clone(),
        (Expression::Number(0.0), _) => Expression::Negative(Box::new(b.clone())),
        _ => Expression::binary(Operator::Subtract, a.clone(), b.clone()),
    }
}

impl Tape {
    /// How many numbers wait at once.
    fn stack(&self) -> usize {
        let mut top = 0_usize;
        let after = self.0.iter().map(|step| {
            top = match step {
                Step::Constant(_) | Step::Variable(_) => top + 1,
                step => top - usize::from(step.takes_two()),
            };
            top
        });
        after.max().unwrap_or(0)
    }

    /// Whether the value depends on the branch of a switch.
    pub(crate) fn uses(&self, index: usize) -> bool {
        self.0.iter().any(|step| step.switch().is_some_and(|switch| switch.index == index))
    }
}

impl Step {
    fn switch(&self) -> Option<SwitchUse> {
        match self {
            Step::Abs(switch) | Step::Sign(switch) | Step::Max(switch) | Step::Min(switch) => *switch,
            Step::Above { switch, .. } => *switch,
            _ => None,
        }
    }
}

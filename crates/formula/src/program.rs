//! An expression with the values of its parameters, as a tape that is run on a small stack.

use crate::expression::Function;
use crate::number::{Moving, Number};
use crate::parse::MOST_DEPTH;
use crate::switch::{Branch, Branches, Switch, SwitchUse};

/// Carried states of a formula at most.
pub const MOST_STATES: usize = 2;

/// The three variables of a place and the carried states.
pub const VARIABLES: usize = 3 + MOST_STATES;

/// Values of the three variables of a place, then of the carried states; zero where there is none.
pub type State<N = f64> = [N; VARIABLES];

/// The three variables of a place, without carried states.
pub fn state([q, rate, third]: [f64; 3]) -> State {
    [q, rate, third, 0.0, 0.0]
}

/// Switches of a formula at most.
pub const MOST_SWITCHES: usize = 24;

/// Numbers that wait on the stack at most: no more than there are levels, and one.
pub(crate) const STACK: usize = MOST_DEPTH + 1;

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
    /// How many numbers wait at once on the stack of the tape.
    pub(crate) stack: usize,
    pub(crate) switches: Vec<Switch>,
    /// The terms of its sum, for what only some of them have.
    pub(crate) terms: Vec<Tape>,
    /// How fast each carried state changes.
    pub(crate) rates: Vec<RateTape>,
}

/// How fast a carried state changes: its tape, and the terms of its sum.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RateTape {
    pub tape: Tape,
    pub terms: Vec<Tape>,
}

impl Program {
    /// The value at a state, in the branches given.
    #[inline]
    pub fn value(&self, state: State, branches: &Branches) -> f64 {
        self.tape.run(state, branches)
    }

    /// How fast the value changes where the variables change at these rates.
    pub fn rate(&self, state: State, rates: State, branches: &Branches) -> f64 {
        self.tape.run(moving(state, rates), branches).rate
    }

    /// How many carried states there are.
    pub fn states(&self) -> usize {
        self.rates.len()
    }

    /// How fast each carried state changes, in its unit per second; zero where there is none.
    #[inline]
    pub fn state_rates(&self, state: State, branches: &Branches) -> [f64; MOST_STATES] {
        let mut rates = [0.0; MOST_STATES];
        for (rate, law) in rates.iter_mut().zip(&self.rates) {
            *rate = law.tape.run(state, branches);
        }
        rates
    }

    /// How fast the rate of a carried state changes where the variables change at these rates.
    pub fn rate_of_state_rate(&self, index: usize, state: State, rates: State, branches: &Branches) -> f64 {
        self.rates[index].tape.run(moving(state, rates), branches).rate
    }

    /// How fast a carried state changes, and how fast that does where the variables change at these rates.
    pub fn state_rate_and_its_rate(
        &self,
        index: usize,
        state: State,
        rates: State,
        branches: &Branches,
    ) -> [f64; 2] {
        let Moving { value, rate } = self.rates[index].tape.run(moving(state, rates), branches);
        [value, rate]
    }

    /// Whether the carried states of another change as its own.
    pub fn changes_as(&self, other: &Self) -> bool {
        self.rates == other.rates
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

/// Variables that change.
pub(crate) fn moving(state: State, rates: State) -> State<Moving> {
    std::array::from_fn(|i| Moving { value: state[i], rate: rates[i] })
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
    #[inline]
    pub(crate) fn takes_two(&self) -> bool {
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

    pub(crate) fn of_one<N: Number>(&self, a: N, branches: &Branches) -> N {
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

    pub(crate) fn of_two<N: Number>(&self, a: N, b: N, branches: &Branches) -> N {
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

impl Tape {
    /// How many numbers wait at once.
    pub(crate) fn stack(&self) -> usize {
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

/// Whole exponents that are products.
pub(crate) fn whole_exponent(exponent: f64) -> Option<i32> {
    (exponent.fract() == 0.0 && exponent.abs() <= MOST_FACTORS).then_some(exponent as i32)
}

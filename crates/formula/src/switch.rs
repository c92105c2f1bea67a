//! Where a formula changes from one smooth branch to another: at `abs`, `sign`, `max`, `min`, comparisons.

use crate::interval::Interval;
use crate::number::Moving;
use crate::program::{MOST_STATES, MOST_SWITCHES, State, Tape, VARIABLES, moving};

/// On which side of a switch a formula is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Branch {
    /// As it is written, whatever the state.
    #[default]
    Free,
    /// Where the argument of the switch is negative, even beyond.
    Negative,
    /// Where it is zero: a velocity that friction holds.
    Zero,
    /// Where it is positive, even beyond.
    Positive,
}

impl Branch {
    /// The branch of a number.
    pub fn of(x: f64) -> Self {
        if x > 0.0 {
            Branch::Positive
        } else if x < 0.0 {
            Branch::Negative
        } else {
            Branch::Zero
        }
    }

    /// -1, 0 or 1; 0 where it is free.
    #[inline]
    pub fn sign(self) -> f64 {
        match self {
            Branch::Negative => -1.0,
            Branch::Free | Branch::Zero => 0.0,
            Branch::Positive => 1.0,
        }
    }

    /// The branch as a switch that turns the other way sees it.
    #[inline]
    fn flipped(self, flipped: bool) -> Self {
        match (self, flipped) {
            (Branch::Negative, true) => Branch::Positive,
            (Branch::Positive, true) => Branch::Negative,
            (branch, _) => branch,
        }
    }
}

/// The branch of each switch of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Branches {
    of: [Branch; MOST_SWITCHES],
    /// Whether any is not free.
    frozen: bool,
}

impl Branches {
    /// As the formula is written.
    pub const FREE: Self = Self { of: [Branch::Free; MOST_SWITCHES], frozen: false };

    /// The branch of a switch.
    pub fn at(&self, switch: usize) -> Branch {
        self.of[switch]
    }

    /// The same with one switch in another branch.
    #[must_use]
    pub fn with(mut self, switch: usize, branch: Branch) -> Self {
        self.of[switch] = branch;
        self.frozen |= branch != Branch::Free;
        self
    }

    /// Whether any branch is frozen.
    #[inline]
    pub(crate) fn is_frozen(&self) -> bool {
        self.frozen
    }

    #[inline]
    pub(crate) fn seen_by(&self, switch: Option<SwitchUse>) -> Branch {
        switch.map_or(Branch::Free, |switch| self.of[switch.index].flipped(switch.flipped))
    }
}

/// How an operation uses a switch: its number, and whether the argument counts with the other sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SwitchUse {
    pub index: usize,
    pub flipped: bool,
}

/// Where a switch turns.
#[derive(Debug, Clone, PartialEq)]
pub enum SwitchAt {
    /// Where a variable (0, 1 or 2, then the carried states) passes a value.
    Line {
        /// Which variable.
        variable: usize,
        /// The value.
        value: f64,
    },
    /// Where an expression passes zero.
    Surface(Surface),
}

/// An expression whose zero is a switch.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    pub(crate) tape: Tape,
    /// Which variables occur in it.
    pub(crate) variables: [bool; VARIABLES],
}

/// A switch: the formula is smooth on both sides of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Switch {
    /// Where it turns.
    pub at: SwitchAt,
    /// Whether `sign` or a comparison turns there, so that the force may jump.
    pub may_jump: bool,
}

impl Switch {
    /// What must pass zero for the switch to turn.
    pub fn argument(&self, state: State, branches: &Branches) -> f64 {
        match &self.at {
            SwitchAt::Line { variable, value } => state[*variable] - value,
            SwitchAt::Surface(surface) => surface.tape.run(state, branches),
        }
    }

    /// The argument and its rate where the variables change at these rates.
    pub fn argument_and_rate(&self, state: State, rates: State, branches: &Branches) -> (f64, f64) {
        match &self.at {
            SwitchAt::Line { variable, value } => (state[*variable] - value, rates[*variable]),
            SwitchAt::Surface(surface) => {
                let Moving { value, rate } = surface.tape.run(moving(state, rates), branches);
                (value, rate)
            }
        }
    }

    /// Below which size the argument cannot be told from zero, where the variables are known to these errors.
    pub fn rounding(&self, state: State, errors: State, branches: &Branches) -> f64 {
        match &self.at {
            SwitchAt::Line { variable, .. } => errors[*variable],
            SwitchAt::Surface(surface) => {
                let around =
                    std::array::from_fn(|i| Interval::new(state[i] - errors[i], state[i] + errors[i]));
                let width = surface.tape.run(around, branches).width();
                if width.is_nan() { 0.0 } else { width }
            }
        }
    }

    /// Whether a variable (0, 1 or 2, then the carried states) has a part in it.
    pub fn depends_on(&self, variable: usize) -> bool {
        match &self.at {
            SwitchAt::Line { variable: own, .. } => *own == variable,
            SwitchAt::Surface(surface) => surface.variables[variable],
        }
    }

    /// Whether a carried state has a part in it.
    pub fn depends_on_states(&self) -> bool {
        (VARIABLES - MOST_STATES..VARIABLES).any(|variable| self.depends_on(variable))
    }
}

//! A formula: text, place, parameters with units; checked, and ready to run.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use crate::carried::{CarriedState, ranges_of};
use crate::compile::compile;
use crate::dimension::{self, Dimension, Names};
use crate::error::FormulaError;
use crate::expression::{Expression, Function};
use crate::jump::{Jump, jumps};
use crate::parse::parse;
use crate::program::{MOST_STATES, Program, State, state};
use crate::range::{Gives, Range, check_values};
use crate::switch::Branches;
use crate::unit::dimension_of;

/// Where a formula acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// At the top, on its displacement `x` (m), velocity `v` (m/s) and the largest abs(x) so far, `x_max` (m): a
    /// force, N.
    Top,
    /// At the ground, on the rotation `phi` (rad) across the joint, its rate `w` (rad/s) and the weight `N`
    /// (N) that it carries: a moment, N m.
    Ground,
    /// The same at the crack.
    Crack,
    /// At impacts, on the speed `u` (m/s) at which the far edge of the joint that closes comes down, the rate `w` (rad/s)
    /// of the rotation across it and the weight `N` (N) that it carries, all positive: a factor on the coefficient C_l.
    Impacts,
}

impl Place {
    /// Every place.
    pub const ALL: [Place; 4] = [Place::Top, Place::Ground, Place::Crack, Place::Impacts];

    /// Its name in wall files.
    pub fn name(self) -> &'static str {
        match self {
            Place::Top => "top",
            Place::Ground => "ground",
            Place::Crack => "crack",
            Place::Impacts => "impacts",
        }
    }

    /// The place of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|place| place.name() == name)
    }

    /// The key of its formula in wall files, which says what the formula gives.
    pub fn key(self) -> &'static str {
        match self {
            Place::Top => "force_n",
            Place::Ground | Place::Crack => "moment_n_m",
            Place::Impacts => "factor",
        }
    }

    /// Names of the three variables.
    pub fn variables(self) -> [&'static str; 3] {
        match self {
            Place::Top => ["x", "v", "x_max"],
            Place::Ground | Place::Crack => ["phi", "w", "N"],
            Place::Impacts => ["u", "w", "N"],
        }
    }

    fn dimensions(self) -> [Dimension; 3] {
        match self {
            Place::Top => [Dimension::LENGTH, Dimension::VELOCITY, Dimension::LENGTH],
            Place::Ground | Place::Crack => [Dimension::NONE, Dimension::RATE, Dimension::FORCE],
            Place::Impacts => [Dimension::VELOCITY, Dimension::RATE, Dimension::FORCE],
        }
    }

    fn result(self) -> Dimension {
        match self {
            Place::Top => Dimension::FORCE,
            Place::Ground | Place::Crack => Dimension::MOMENT,
            Place::Impacts => Dimension::NONE,
        }
    }
}

/// A number of a formula, with its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name in the formula.
    pub name: String,
    /// Its value, in its unit.
    pub value: f64,
    /// Its unit: of SI, without prefixes; empty or `1` for a pure number. Exponents may be parameters.
    pub unit: String,
}

impl Parameter {
    /// A parameter.
    pub fn new(name: &str, value: f64, unit: &str) -> Self {
        Self { name: name.to_owned(), value, unit: unit.to_owned() }
    }
}

/// Parameters of a formula at most.
const MOST_PARAMETERS: usize = 32;

/// What Python takes for itself.
const KEYWORDS: [&str; 35] = [
    "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def",
    "del", "elif", "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is",
    "lambda", "nonlocal", "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

/// A law of a force, of a moment or of impacts as a formula: its units are right, and every name is known.
#[derive(Debug, Clone)]
pub struct Formula {
    place: Place,
    expression: Expression,
    parameters: Vec<Parameter>,
    states: Vec<CarriedState>,
    rates: Vec<Expression>,
    program: Arc<Program>,
}

/// Formulas are the same where place, expression and parameters are: the rest follows.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
            && self.expression == other.expression
            && self.parameters == other.parameters
            && self.states == other.states
    }
}

/// The formula as it is written.
impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.expression.fmt(f)
    }
}

impl Formula {
    /// Reads a formula. Parameters are kept in the order of their names.
    ///
    /// # Errors
    /// A text that is no formula; names that are unknown, taken or not used; units that do not go together.
    pub fn parse(text: &str, place: Place, parameters: &[Parameter]) -> Result<Self, FormulaError> {
        Self::parse_with_states(text, place, parameters, &[])
    }

    /// The same with carried states, at the top. They are kept in the order of their names.
    ///
    /// # Errors
    /// As [`Formula::parse`]; states elsewhere or too many of them; what is wrong with one.
    pub fn parse_with_states(
        text: &str,
        place: Place,
        parameters: &[Parameter],
        states: &[CarriedState],
    ) -> Result<Self, FormulaError> {
        let parsed = parse(text)?;
        let (mut parameters, mut states) = (parameters.to_vec(), states.to_vec());
        parameters.sort_by(|a, b| a.name.cmp(&b.name));
        states.sort_by(|a, b| a.name.cmp(&b.name));
        check_states(place, &states)?;
        let of_state = |state: &CarriedState| parse(&state.rate).map_err(|e| e.of_state(&state.name, "rate"));
        let parsed_rates = states.iter().map(of_state).collect::<Result<Vec<_>, _>>()?;
        let rates: Vec<_> = parsed_rates.iter().map(|rate| rate.expression.clone()).collect();
        for (state, rate) in states.iter_mut().zip(&rates) {
            state.rate = rate.to_string();
        }
        check_names(&parsed.expression, &rates, &parameters, &states)?;
        let values: BTreeMap<_, _> = parameters.iter().map(|p| (p.name.as_str(), p.value)).collect();
        let names = names(place, &parameters, &states, &values)?;
        dimension::check(&parsed, &names, place.result())?;
        for (state, rate) in states.iter().zip(&parsed_rates) {
            let own = names.dimensions.get(state.name.as_str()).copied().unwrap_or(Dimension::NONE);
            let per_second = own.times(Dimension::RATE);
            dimension::check(rate, &names, per_second).map_err(|e| e.of_state(&state.name, "rate"))?;
        }
        let variables = variables_of(place, &states);
        let program = Arc::new(compile(&parsed.expression, &rates, &variables, &values)?);
        Ok(Self { place, expression: parsed.expression, parameters, rates, program, states })
    }

    /// The same with other values of its parameters, in the order of [`Formula::parameters`].
    ///
    /// # Errors
    /// Values that are not finite, or with which the units do not go together any more.
    pub fn with_values(&self, values: &[f64]) -> Result<Self, FormulaError> {
        let own = self.parameters.iter().cloned().zip(values);
        let parameters: Vec<_> = own.map(|(parameter, &value)| Parameter { value, ..parameter }).collect();
        Self::parse_with_states(&self.to_string(), self.place, &parameters, &self.states)
    }

    /// Where it acts.
    pub fn place(&self) -> Place {
        self.place
    }

    /// What it is made of.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }

    /// Its parameters, by name.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Its carried states, by name.
    pub fn states(&self) -> &[CarriedState] {
        &self.states
    }

    /// The variables at a state of the place, carried states as they start.
    pub fn at_start(&self, of_place: [f64; 3]) -> State {
        let mut at = state(of_place);
        at[3..].iter_mut().zip(&self.states).for_each(|(own, state)| *own = state.start);
        at
    }

    /// Ready to run.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// Force or moment at a state of the place, N or N m: what acts on the wall. At impacts a factor. Carried states are as they
    /// start.
    pub fn value(&self, of_place: [f64; 3]) -> f64 {
        self.value_with_states(self.at_start(of_place))
    }

    /// The same with carried states.
    pub fn value_with_states(&self, state: State) -> f64 {
        self.program.value(state, &Branches::FREE)
    }

    /// As [`Formula::value`], as the expression says it, step by step: slower.
    pub fn value_as_written(&self, of_place: [f64; 3]) -> f64 {
        let state = self.at_start(of_place);
        let variables = variables_of(self.place, &self.states);
        let values = self.parameters.iter().map(|p| (p.name.as_str(), p.value)).collect();
        let of = |name: &str| variables.iter().position(|own| *own == name).map(|i| state[i]);
        self.expression.over(&values, &of).unwrap_or(f64::NAN)
    }

    /// Whether the force depends on how far the top has been, `x_max`.
    pub fn remembers(&self) -> bool {
        self.place == Place::Top && self.depends_on(2)
    }

    /// Whether a variable of the place (0, 1 or 2) occurs.
    pub fn depends_on(&self, variable: usize) -> bool {
        let name = self.place.variables()[variable];
        self.expression.has(name) || self.rates.iter().any(|rate| rate.has(name))
    }

    /// Refuses a formula that is not finite over a range, or no factor from 0 to 1 at impacts, or jumps where no motion
    /// could go on. Says of each switch what it does.
    ///
    /// # Errors
    /// The subexpression, the reason and the range.
    pub fn check(&self, range: &Range) -> Result<Vec<Jump>, FormulaError> {
        let values = self.parameters.iter().map(|p| (p.name.as_str(), p.value)).collect();
        let variables = variables_of(self.place, &self.states);
        let over = range.with_states(&self.state_ranges(range)?);
        check_values(&self.expression, Gives::At(self.place), &variables, &values, &over)?;
        for (state, rate) in self.states.iter().zip(&self.rates) {
            check_values(rate, Gives::Rate, &variables, &values, &over)
                .map_err(|e| e.of_state(&state.name, "rate"))?;
        }
        match self.place {
            // An impact asks once: nothing has to be followed through a jump.
            Place::Impacts => Ok(vec![Jump::None; self.program.switches.len()]),
            _ => jumps(&self.program, &variables, &over),
        }
    }

    /// Intervals that the carried states never leave while the variables of the place are within a range, or those given.
    ///
    /// # Errors
    /// A state that is not shown to be bounded.
    pub fn state_ranges(&self, range: &Range) -> Result<Vec<[f64; 2]>, FormulaError> {
        ranges_of(&self.states, &self.program, range)
    }
}

/// Names of the variables of a place and of states.
fn variables_of(place: Place, states: &[CarriedState]) -> Vec<&str> {
    place.variables().into_iter().chain(states.iter().map(|state| state.name.as_str())).collect()
}

/// Refuses states that a law cannot carry.
fn check_states(place: Place, states: &[CarriedState]) -> Result<(), FormulaError> {
    if states.len() > MOST_STATES {
        let found = format!("{} carried states", states.len());
        return Err(FormulaError::new(None, found, format!("at most {MOST_STATES}")));
    }
    for (i, CarriedState { name, start, range, .. }) in states.iter().enumerate() {
        let refused = |found: String, allowed: &str, key: &'static str| {
            Err(FormulaError::new(None, found, allowed).of_state(name, key))
        };
        if place != Place::Top {
            let found = format!("a carried state at {}", place.name());
            return refused(
                found,
                "states of a force at the top: a closed joint bears what it must, whatever a law carries",
                "",
            );
        }
        if let Some(problem) = problem_of_name(name) {
            return refused(format!("a state `{name}`"), problem, "");
        }
        if i > 0 && states[i - 1].name == *name {
            return refused(format!("`{name}` again"), "each state once", "");
        }
        if !start.is_finite() {
            return refused(start.to_string(), "a finite number", "start");
        }
        if let Some([least, most]) = range {
            if !(least.is_finite() && most.is_finite() && least < most) {
                return refused(
                    format!("[{least}, {most}]"),
                    "a finite least and a larger largest value",
                    "range",
                );
            }
            if !(least..=most).contains(&start) {
                return refused(format!("{start}"), "a start within the range", "start");
            }
        }
    }
    Ok(())
}

/// Why a name can be none of a parameter or state.
fn problem_of_name(name: &str) -> Option<&'static str> {
    let variables = Place::ALL.map(Place::variables).concat();
    let functions = Function::ALL.map(Function::name);
    if !is_name(name) {
        return Some("letters, digits and _, and no word of Python");
    }
    (variables.contains(&name) || functions.contains(&name))
        .then_some("a name that is no variable and no function")
}

fn is_name(text: &str) -> bool {
    let starts = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    starts && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !KEYWORDS.contains(&text)
}

/// Every parameter and state has a name of its own and a use.
fn check_names(
    expression: &Expression,
    rates: &[Expression],
    parameters: &[Parameter],
    states: &[CarriedState],
) -> Result<(), FormulaError> {
    let has = |name: &str| expression.has(name) || rates.iter().any(|rate| rate.has(name));
    for (i, CarriedState { name, .. }) in states.iter().enumerate() {
        if parameters.iter().any(|parameter| parameter.name == *name) {
            let found = format!("a state `{name}` beside a parameter of that name");
            return Err(FormulaError::new(None, found, "each name once").of_state(name, ""));
        }
        let of_others = rates.iter().enumerate().any(|(j, rate)| j != i && rate.has(name));
        if !expression.has(name) && !of_others {
            let found = format!("`{name}`, which the formula does not use");
            return Err(FormulaError::new(None, found, "states of the formula").of_state(name, ""));
        }
    }
    if parameters.len() > MOST_PARAMETERS {
        let found = format!("{} parameters", parameters.len());
        return Err(FormulaError::new(None, found, format!("at most {MOST_PARAMETERS}")));
    }
    for (i, Parameter { name, value, .. }) in parameters.iter().enumerate() {
        let refused = |found: &str, allowed: &str| Err(FormulaError::of_parameter(name, found, allowed));
        if let Some(problem) = problem_of_name(name) {
            return refused(&format!("a parameter `{name}`"), problem);
        }
        if i > 0 && parameters[i - 1].name == *name {
            return refused(&format!("`{name}` again"), "each parameter once");
        }
        if !value.is_finite() {
            return refused(&value.to_string(), "a finite number");
        }
        if !has(name) {
            return refused(
                &format!("`{name}`, which the formula does not use"),
                "parameters of the formula",
            );
        }
    }
    Ok(())
}

fn names<'a>(
    place: Place,
    parameters: &'a [Parameter],
    states: &'a [CarriedState],
    values: &BTreeMap<&'a str, f64>,
) -> Result<Names<'a>, FormulaError> {
    let mut dimensions: BTreeMap<&str, Dimension> =
        place.variables().into_iter().zip(place.dimensions()).collect();
    for Parameter { name, unit, .. } in parameters {
        let dimension = dimension_of(unit, values)
            .map_err(|e| FormulaError::of_parameter(name, e.found_at(), e.allowed))?;
        dimensions.insert(name, dimension);
    }
    for CarriedState { name, unit, .. } in states {
        let dimension = dimension_of(unit, values).map_err(|e| e.of_state(name, "unit"))?;
        dimensions.insert(name, dimension);
    }
    let [x, v, third] = place.variables();
    let own = states.iter().map(|s| &s.name).chain(parameters.iter().map(|p| &p.name));
    let own = own.map(|name| format!(", {name}")).collect::<String>();
    let known = format!("{x}, {v}, {third}{own}; a further name is a parameter to be given");
    Ok(Names { dimensions, values: values.clone(), known })
}

//! Where the value of a formula jumps, and which jumps a motion can be followed through.
//!
//! A force that jumps with the displacement is passed at a velocity: the motion goes on. One that jumps against
//! the motion where the velocity is zero is friction: the top sticks while the force that keeps it at rest lies
//! between both sides of the jump. Any other jump leaves open what comes next, and is refused.

use crate::error::FormulaError;
use crate::interval::Interval;
use crate::number::Number;
use crate::program::{Program, State, Tape, VARIABLES};
use crate::range::Over;
use crate::switch::{Branch, Branches, Switch, SwitchAt};

/// Halvings of the displacement one within another, to show that a jump is against the motion.
const MOST_HALVINGS: usize = 12;

/// Positions of the displacement and of the velocity among the variables of every place.
const DISPLACEMENT: usize = 0;
const VELOCITY: usize = 1;

/// What a jump at a switch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Jump {
    /// There is none.
    None,
    /// The force jumps at a displacement.
    AtDisplacement,
    /// The force jumps against the motion where it turns back: friction.
    AgainstMotion,
}

/// What each switch of a program does to the force, over a range of states around rest.
///
/// # Errors
/// A jump that cannot be followed.
pub(crate) fn jumps(program: &Program, names: &[&str], range: &Over) -> Result<Vec<Jump>, FormulaError> {
    let of = |(i, switch): (usize, &Switch)| jump(program, i, switch, names, range);
    program.switches.iter().enumerate().map(of).collect()
}

fn jump(
    program: &Program,
    index: usize,
    switch: &Switch,
    names: &[&str],
    range: &Over,
) -> Result<Jump, FormulaError> {
    if !switch.may_jump {
        return Ok(Jump::None);
    }
    if switch.depends_on_states() {
        let jumps = |terms: &[Tape]| steps_at(terms, index, switch, range) != Some(NO_STEP);
        return match jumps(&program.terms) || program.rates.iter().any(|rate| jumps(&rate.terms)) {
            true => Err(FormulaError::new(
                None,
                "`sign` or a comparison of what a carried state has a part in, where the force or a rate jumps",
                "what has no jump there, such as abs(z)**n*sign(z) with n above 0, or tanh(z/s) with a small s",
            )),
            false => Ok(Jump::None),
        };
    }
    for rate in &program.rates {
        rate_jump(&rate.tape, &rate.terms, (index, switch), names, range)?;
    }
    match &switch.at {
        SwitchAt::Line { variable: VELOCITY, value } => at_velocity(program, index, *value, names, range),
        // With the weight alone, which stays.
        _ if names[2] == "N" && !switch.depends_on(DISPLACEMENT) && !switch.depends_on(VELOCITY) => {
            Ok(Jump::None)
        }
        // The largest displacement grows with the displacement alone.
        _ if !switch.depends_on(VELOCITY) && (names[2] == "x_max" || !switch.depends_on(2)) => {
            at_displacement(program, index, switch, names, range)
        }
        SwitchAt::Line { .. } | SwitchAt::Surface(_) => Err(FormulaError::new(
            None,
            format!(
                "`sign` or a comparison of what {} has a part in, beside other variables",
                names[VELOCITY]
            ),
            format!(
                "jumps at {} = 0 or at values of {}; without a jump, as max(0, a - b) for (a - b)*(a > b)",
                names[VELOCITY], names[DISPLACEMENT]
            ),
        )),
    }
}

const NO_STEP: Interval = Interval { low: 0.0, high: 0.0 };

/// By how much a sum rises over a switch, where that is known.
fn steps_at(terms: &[Tape], index: usize, switch: &Switch, range: &Over) -> Option<Interval> {
    if !terms.iter().any(|term| term.uses(index)) {
        return Some(NO_STEP);
    }
    let SwitchAt::Line { variable, value } = switch.at else { return None };
    let mut at = *range;
    (at.low[variable], at.high[variable]) = (value, value);
    step_over(terms, index, &at, &at, MOST_HALVINGS)
}

/// A rate may jump where the displacement passes a value: the motion goes on. Where the top turns back or rests, a jump would
/// leave open what comes next.
fn rate_jump(
    tape: &Tape,
    terms: &[Tape],
    (index, switch): (usize, &Switch),
    names: &[&str],
    range: &Over,
) -> Result<(), FormulaError> {
    if steps_at(terms, index, switch, range) == Some(NO_STEP) {
        return Ok(());
    }
    let at_rest = [range.low[2], range.high[2]].into_iter().any(|third| {
        let rest = [0.0, 0.0, third, 0.0, 0.0];
        let [above, below] = sides(index).map(|side| tape.run(rest, &side));
        switch.argument(rest, &Branches::FREE) == 0.0 && above != below
    });
    if switch.depends_on(VELOCITY) || at_rest {
        let (x, v) = (names[DISPLACEMENT], names[VELOCITY]);
        return Err(FormulaError::new(
            None,
            format!("a rate that jumps where {v} passes a value, or at {x} = 0, where the wall rests"),
            format!("what has no jump there, such as abs({v})"),
        ));
    }
    Ok(())
}

/// A jump at a displacement must not be where the wall rests: nothing says which side it rests on.
fn at_displacement(
    program: &Program,
    index: usize,
    switch: &Switch,
    names: &[&str],
    range: &Over,
) -> Result<Jump, FormulaError> {
    for third in [range.low[2], range.high[2]] {
        let rest = [0.0, 0.0, third, 0.0, 0.0];
        let [above, below] = sides(index).map(|side| program.value(rest, &side));
        if switch.argument(rest, &Branches::FREE) == 0.0 && above != below {
            let x = names[DISPLACEMENT];
            return Err(FormulaError::new(
                None,
                format!("a force that jumps from {below} to {above} at {x} = 0, where the wall rests"),
                format!("a steep rise in its place, such as tanh({x}/s) with a small s"),
            ));
        }
    }
    Ok(Jump::AtDisplacement)
}

fn sides(index: usize) -> [Branches; 2] {
    [Branch::Positive, Branch::Negative].map(|side| Branches::FREE.with(index, side))
}

fn at_velocity(
    program: &Program,
    index: usize,
    value: f64,
    names: &[&str],
    range: &Over,
) -> Result<Jump, FormulaError> {
    let mut at = *range;
    (at.low[VELOCITY], at.high[VELOCITY]) = (value, value);
    let step = step_over(&program.terms, index, &at, &at, MOST_HALVINGS);
    let v = names[VELOCITY];
    match step {
        Some(Interval { low: 0.0, high: 0.0 }) => Ok(Jump::None),
        Some(step) if value == 0.0 && step.high <= 0.0 => Ok(Jump::AgainstMotion),
        _ if value == 0.0 => Err(FormulaError::new(
            None,
            format!("a force that jumps at {v} = 0, and not everywhere against the motion"),
            format!("friction: less for {v} above zero than below it, as in -F*sign({v}) with F above 0"),
        )),
        _ => Err(FormulaError::new(
            None,
            format!("a force that jumps at {v} = {value}, where the motion could stay"),
            format!("what has no jump there, such as max(0, {v} - {value}), or a jump at {v} = 0"),
        )),
    }
}

/// By how much the value rises over a switch, over a range in which it turns. `None` where its sign is not
/// known.
fn step_over(terms: &[Tape], index: usize, at: &Over, whole: &Over, halvings: usize) -> Option<Interval> {
    let over: State<Interval> = at.intervals();
    let [above, below] = sides(index);
    // Terms without the switch are the same on both sides.
    let using = terms.iter().filter(|term| term.uses(index));
    let step = using.map(|term| term.run(over, &above).sub(term.run(over, &below)));
    let step = step.fold(Interval::constant(0.0), |sum, step| step.add(sum));
    if step.high <= 0.0 {
        return Some(step);
    }
    if halvings == 0 || (0..VARIABLES).all(|i| whole.high[i] <= whole.low[i]) {
        return None;
    }
    let [first, second] = at.halves(whole);
    let [first, second] = [first, second].map(|half| step_over(terms, index, &half, whole, halvings - 1));
    let (first, second) = (first?, second?);
    Some(Interval::new(first.low.min(second.low), first.high.max(second.high)))
}

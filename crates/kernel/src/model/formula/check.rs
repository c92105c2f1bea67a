//! What a wall can reach, and whether its formulas are finite and can be followed there.

use std::borrow::Cow;

use mrbd_formula::{Formula, FormulaError, Jump, Place, Range};

use super::super::contact::Joint;
use super::super::wall::{G_M_S2, ImpossibleWall, Wall};
use super::carried::{Carried, check_count};
use super::law::{FormulaLaw, joint_of};

/// Speeds up to this many times that of a fall from the wall's own height. A wall that stands is far slower.
const FALLS: f64 = 2.0;

/// Below this share of such speeds, a millionth of a metre a second, roots of a rate go straight to zero. What creeps as slowly for a
/// minute goes as far as a mortar joint is rough.
const STRAIGHT_SHARE: f64 = 5e-8;

/// The laws of motion among the formulas of a wall, checked over all that the wall can reach before it counts as collapsed.
///
/// # Errors
/// [`ImpossibleWall`] with the key of the formula.
pub(in crate::model) fn checked(wall: &Wall) -> Result<Vec<FormulaLaw>, ImpossibleWall> {
    let formulas = wall.parameters().formulas.iter().enumerate();
    let of_motion = formulas.filter(|(_, formula)| formula.place() != Place::Impacts);
    let laws = of_motion.map(|(i, formula)| law(wall, formula).map_err(|e| refused(i, formula, e)));
    let laws = laws.collect::<Result<Vec<_>, _>>()?;
    check_count(&laws)?;
    Ok(laws)
}

pub(super) fn refused(i: usize, formula: &Formula, error: FormulaError) -> ImpossibleWall {
    let key = Cow::Owned(format!("formulas.{i}.{}", error.key(formula.place().key())));
    ImpossibleWall { key, found: error.found_at(), allowed: error.allowed }
}

fn law(wall: &Wall, formula: &Formula) -> Result<FormulaLaw, FormulaError> {
    let joint = joint_of(formula.place());
    if joint == Some(Joint::Crack) && !wall.is_cracked() {
        return Err(FormulaError::found(
            "a formula at the crack of a wall without one",
            "place = \"ground\"",
        ));
    }
    let mut range = reach(wall, formula.place());
    if formula.remembers() {
        range.high[2] = range.high[0];
    }
    let jumps = formula.check(&range)?;
    let friction = jumps.iter().position(|jump| *jump == Jump::AgainstMotion);
    let weight_n = if joint.is_some() { range.high[2] } else { 0.0 };
    let law = FormulaLaw::new(formula, weight_n, friction, Carried::of(wall, formula, &range)?)
        .straight_below(STRAIGHT_SHARE * range.high[1], range.high[0]);
    match joint {
        Some(_) if friction.is_some() => Err(FormulaError::found(
            "a moment that jumps at w = 0",
            "what is smooth there, such as tanh(w/s) with a small s: nothing holds a joint that is open",
        )),
        Some(joint) if !gives(wall, joint) && law.at_rest() != 0.0 => {
            let found = format!("a moment of {} N m at phi = 0 and w = 0", law.at_rest());
            let allowed = "no moment there: a closed joint on sharp edges bears what it must";
            Err(FormulaError::found(&found, allowed))
        }
        _ => Ok(law),
    }
}

fn gives(wall: &Wall, joint: Joint) -> bool {
    wall.joint_laws[joint as usize].is_some_and(|law| law.gives())
}

/// What the variables of a place can be: up to the rotations at which the wall has collapsed, and [`FALLS`].
pub(super) fn reach(wall: &Wall, place: Place) -> Range {
    let [h1, h2] = wall.height_m;
    let upright = |rotation: f64| rotation.min(std::f64::consts::FRAC_PI_2);
    let [r1, r2] = wall.collapse_rotation_rad().map(upright);
    let v = FALLS * (2.0 * G_M_S2 * (h1 + h2)).sqrt();
    let symmetric = |q: f64, rate: f64, third: f64| Range { low: [-q, -rate, third], high: [q, rate, third] };
    let [ground_n, crack_n] = wall.weights_n();
    match place {
        Place::Top => symmetric(h1 * r1.sin() + h2 * r2.sin() + wall.parameters().thickness_m, v, 0.0),
        Place::Ground => symmetric(r1, v / h1, ground_n),
        Place::Crack => symmetric(r1 + r2, v / h1 + v / h2, crack_n),
        // A joint closes at some rate, whichever joint it is.
        Place::Impacts => {
            let (upper, [b1, b2]) = (if wall.is_cracked() { v / h2 } else { 0.0 }, wall.width_m);
            let rate = v / h1 + upper;
            Range { low: [0.0, 0.0, crack_n], high: [rate * b1.max(b2), rate, ground_n] }
        }
    }
}

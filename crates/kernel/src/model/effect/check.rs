//! Which effects a wall can have.

use std::borrow::Cow;

use super::super::wall::{ImpossibleWall, WallParameters};
use super::{Effect, EffectSums};

/// Refuses effects that a wall cannot have: bounds of single values are checked already.
///
/// # Errors
/// [`ImpossibleWall`] with the key of the effect.
pub(in crate::model) fn check(p: &WallParameters, sums: &EffectSums) -> Result<(), ImpossibleWall> {
    for (i, effect) in p.effects.iter().enumerate() {
        let kind = effect.kind();
        let again = p.effects[..i].iter().any(|earlier| earlier.kind().name == kind.name);
        if again && !kind.may_repeat {
            let found = format!("{} again", kind.name);
            return Err(refused(i, found, "one effect of this kind: two have no common law".to_owned()));
        }
        if effect.variant().choice == Some("crack") && p.crack_height_m.is_none() {
            let found = format!("{} at the crack of a wall without one", kind.name);
            return Err(refused(i, found, "joint = \"ground\"".to_owned()));
        }
    }
    let widths = [("lower", p.lower_width_m), ("upper", p.upper_width_m)];
    for ((body, width_m), indentation_m) in widths.into_iter().zip(sums.indentation_m) {
        if indentation_m >= width_m {
            let found = format!("corners that lie {indentation_m} m inwards");
            let i = last(&p.effects, "corner_indentation");
            return Err(refused(i, found, format!("below corners.{body}_width_m = {width_m}")));
        }
    }
    for (c_l, factor) in p.restitution.coefficients.into_iter().zip(sums.impact_factors) {
        if c_l * factor > 2.0 {
            let i = last(&p.effects, "impact_dissipation");
            return Err(refused(i, format!("C_l times factor = {}", c_l * factor), "0 to 2".to_owned()));
        }
    }
    Ok(())
}

fn last(effects: &[Effect], name: &str) -> usize {
    effects.iter().rposition(|effect| effect.kind().name == name).unwrap_or(0)
}

fn refused(i: usize, found: String, allowed: String) -> ImpossibleWall {
    ImpossibleWall { key: Cow::Owned(format!("effects.{i}")), found, allowed }
}

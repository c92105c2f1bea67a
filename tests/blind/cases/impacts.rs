//! Cases of walls whose impacts keep the less the faster they are.

use super::draw::{Case, of_kind};
use super::kind::Kind;

/// What is hidden, in turn.
const KINDS: [Kind; 5] = [
    Kind::One("impact_fading"),
    Kind::Nothing,
    Kind::One("impact_fading"),
    Kind::One("impact_dissipation"),
    Kind::Pair("impact_fading", "viscous_damping"),
];

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let kind = kind_of(number);
    let before = (0..number).filter(|earlier| kind_of(*earlier).group() == kind.group()).count();
    of_kind(set, number, kind, before)
}

fn kind_of(number: u64) -> Kind {
    KINDS[number as usize % KINDS.len()]
}

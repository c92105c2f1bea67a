//! Cases of walls whose joints give: of five, two on beds, two on beds with an effect beside, and one with nothing hidden.

use super::draw::{Case, of_kind};
use super::kind::Kind;

/// Effects that are drawn beside a bed: neither impacts, which a bed has none of, nor dampers of joints, which it is itself.
const BESIDE: [&str; 7] = [
    "viscous_damping",
    "cubic_stiffness",
    "coulomb_friction",
    "carriage_mass",
    "one_sided_spring",
    "gap",
    "record_gain",
];

/// Of so many cases the last hides nothing, and every other one an effect beside the bed.
const NOTHING_EVERY: u64 = 5;

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let kind = kind_of(number);
    let before = (0..number).filter(|earlier| kind_of(*earlier).group() == kind.group()).count();
    let case = of_kind(set, number, kind, before);
    // A bed has no nominal size: how soft it is, is drawn.
    if matches!(kind, Kind::Pair(..)) { case } else { Case { size: 1.0, ..case } }
}

fn kind_of(number: u64) -> Kind {
    match number % NOTHING_EVERY {
        4 => Kind::Nothing,
        place if place % 2 == 1 => {
            let turn = (number / NOTHING_EVERY) * 2 + place / 2;
            Kind::Pair("compliant_joint", BESIDE[turn as usize % BESIDE.len()])
        }
        _ => Kind::One("compliant_joint"),
    }
}

//! Cases of walls whose joints give: of five, four on beds, and one with nothing hidden.

use super::draw::{Case, of_kind};
use super::kind::Kind;

/// Every so manyth case hides nothing.
const NOTHING_EVERY: u64 = 5;

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let nothing = |number: u64| number % NOTHING_EVERY == NOTHING_EVERY - 1;
    let kind = if nothing(number) { Kind::Nothing } else { Kind::One("compliant_joint") };
    let before = (0..number).filter(|earlier| nothing(*earlier) == nothing(number)).count();
    // A bed has no nominal size: how soft it is, is drawn.
    Case { size: 1.0, ..of_kind(set, number, kind, before) }
}

//! Everything that is tried.

use super::Addition;
use super::wall_number::wall_number;
use mrbd_kernel::model::{EffectKind, WallParameters};

/// Numbers of the wall that stand beside the effects as rivals: what a wrong drawing or a wrong weight would do.
const RIVAL_NUMBERS: [&str; 5] = [
    "diaphragm.stiffness_n_per_m",
    "diaphragm.mass_kg",
    "wall.mass_kg",
    "wall.crack_height_m",
    "diaphragm.eccentricity_m",
];

/// Every addition to a wall that is tried alone: the catalogue, the lumped carriage, numbers outside what was known of
/// them, and a placebo.
pub fn candidates(wall: &WallParameters) -> Vec<Addition> {
    let mut all =
        EffectKind::ALL.iter().flat_map(|kind| kind.variants()).map(Addition::Effect).collect::<Vec<_>>();
    if wall.diaphragm_mass_kg > 0.0 {
        all.push(Addition::LumpedCarriage);
    }
    let present = |number: &&super::wall_number::WallNumber| {
        (number.get)(wall) != 0.0 || number.key == "diaphragm.eccentricity_m"
    };
    all.extend(RIVAL_NUMBERS.iter().filter_map(|key| wall_number(key)).filter(present).map(Addition::Number));
    all.push(Addition::Placebo);
    all
}

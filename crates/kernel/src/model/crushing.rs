//! Crushed corners: how far the hinges move inwards (model section 8, the paper's section 4.1).

use super::wall::{G_M_S2, ImpossibleWall};

/// Share of the compressive strength in the rectangular stress block.
const BLOCK_STRENGTH: f64 = 0.85;

/// Widths b_1, b_2 between the rocking corners, m.
///
/// The weight N_i above a corner stands on a stress block of depth a = N_i / (0.85 f L), whose resultant lies at a/2
/// from the face on either side: b_i = b - a. `above_kg` are the masses above the ground and above the crack.
///
/// # Errors
/// A strength that is not positive, or so low that a corner crushes through the wall.
pub fn crushed_widths_m(
    thickness_m: f64,
    length_m: f64,
    above_kg: [f64; 2],
    strength_pa: f64,
) -> Result<[f64; 2], ImpossibleWall> {
    let key = "corners.compressive_strength_pa";
    let refuse =
        |allowed: String| ImpossibleWall { key: key.into(), found: strength_pa.to_string(), allowed };
    if !(strength_pa > 0.0 && strength_pa.is_finite()) {
        return Err(refuse("a finite number above 0".to_owned()));
    }
    let depth_m = above_kg.map(|mass_kg| mass_kg * G_M_S2 / (BLOCK_STRENGTH * strength_pa * length_m));
    let deepest_m = depth_m[0].max(depth_m[1]);
    if deepest_m.is_nan() || deepest_m >= thickness_m {
        let least = strength_pa * deepest_m / thickness_m;
        return Err(refuse(format!("above {least:.4e} Pa, below which the corner crushes through the wall")));
    }
    Ok(depth_m.map(|a| thickness_m - a))
}

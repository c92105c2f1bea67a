//! Largest rotations as charts show them: numbers over an axis, collapses in a zone of their own above it.

use super::chart::{Axis, CurvePoint, Layer, of_curve};
use crate::aggregate::Middle;

/// The rotation; `None` for a collapse.
pub fn number(middle: &Middle) -> Option<f64> {
    match middle {
        Middle::Rotation(rotation) => Some(*rotation),
        Middle::Collapsed => None,
    }
}

/// An axis that holds rotations and at least a value, with a zone if some are collapses.
pub fn axis(label: &str, shown: &[Middle], least: f64) -> Axis {
    let axis = Axis::holding(label, shown.iter().filter_map(number).chain([least]));
    if shown.contains(&Middle::Collapsed) { axis.with_zone("collapse") } else { axis }
}

/// The `index`-th of some curves; each has a height of its own in the zone, so that none hides another.
pub fn curve(index: usize, curves: usize, points: Vec<CurvePoint>) -> Layer {
    let (colour, mark) = of_curve(index);
    Layer::Curve { colour, mark, zone_share: (index as f64 + 0.5) / curves.max(1) as f64, points }
}

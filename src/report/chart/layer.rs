//! What is drawn over two axes.

use super::colours::{Colour, Mark};

/// A point with a value under the pointer.
#[derive(Debug, Clone, PartialEq)]
pub struct Dot {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// Text under the pointer, lines apart by `\n`.
    pub tip: String,
}

/// A point of a curve whose values may lie beyond all numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePoint {
    /// Abscissa.
    pub x: f64,
    /// Ordinate; `None` for one in the zone above the axis.
    pub y: Option<f64>,
    /// Whether it is drawn hollow.
    pub hollow: bool,
    /// Text under the pointer, lines apart by `\n`.
    pub tip: String,
}

/// A stretch of the abscissa in a colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Its colour.
    pub colour: Colour,
}

/// Something drawn over the axes. Points that are not finite leave gaps; those beyond the axes stand at their ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// Between two ordinates: an interval along the abscissa. Points are (x, lower y, upper y).
    Band { colour: Colour, points: Vec<(f64, f64, f64)> },
    /// Points joined by lines, with a name under the pointer.
    Line { colour: Colour, width: u32, dashed: bool, name: String, points: Vec<(f64, f64)> },
    /// From one point to another each, thick: an interval.
    Spans { colour: Colour, width: u32, spans: Vec<[(f64, f64); 2]> },
    /// Pale bars from zero: (from x, to x, height).
    Bars { colour: Colour, bars: Vec<(f64, f64, f64)> },
    /// Single points.
    Dots { colour: Colour, mark: Mark, size: i32, hollow: bool, dots: Vec<Dot> },
    /// Points with marks, joined by lines. Crosses stand at a share of the zone's height, 0 below.
    Curve { colour: Colour, mark: Mark, zone_share: f64, points: Vec<CurvePoint> },
    /// Stretches of the abscissa over the whole height.
    Stretches(Vec<Stretch>),
    /// A stretch of the abscissa that is shaded.
    Shade { from: f64, to: f64 },
    /// A line across at an ordinate, and its meaning.
    Threshold { y: f64, name: &'static str },
    /// A line upwards at an abscissa, and its meaning.
    Moment { x: f64, name: &'static str, colour: Colour },
}

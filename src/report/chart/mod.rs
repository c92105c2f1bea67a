//! The drawing system: one kind of chart, and one way from it to SVG and to pixels.
//!
//! | module | what |
//! | --- | --- |
//! | `axis` | where a value stands, and the round numbers beside it |
//! | `layer` | what is drawn over two axes: lines, points, bands, bars, stretches, thresholds |
//! | `plot` | axes and layers within a frame |
//! | `graph`, `stack` | one plot as a picture; several, one above the other over one abscissa |
//! | `thin` | no more points and stretches than a picture can show |
//! | `picture` | shapes, places with values, attributes |
//! | `svg`, `png` | a picture as SVG with values for the script, or as pixels |
//! | `colours` | a palette that colour-blind people tell apart, and marks of curves |

mod axis;
mod colours;
mod graph;
mod layer;
mod picture;
mod plot;
mod png;
mod stack;
mod svg;
mod thin;

pub use axis::Axis;
pub use colours::{COLLAPSE, Colour, INK, Mark, PALETTE, PATTERNS, of_curve};
pub use graph::{Format, Graph};
pub use layer::{CurvePoint, Dot, Layer, Stretch};
pub use stack::{Row, Stack, StackKey};

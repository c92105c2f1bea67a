//! Plots one above the other over one abscissa, under a legend: the histories of a run.

use super::axis::Axis;
use super::colours::{Colour, INK};
use super::layer::Layer;
use super::picture::{Across, Down, Pen, Picture};
use super::plot::{Frame, MostTicks, Plot};

/// Width, in units of its own.
const WIDTH: u32 = 2400;
/// Height of letters.
const TEXT: f64 = 31.0;
/// Room for legend, for the numbers at the left, at the right, between rows, and below the last.
const LEGEND: f64 = 72.0;
const LEFT: f64 = 190.0;
const RIGHT: f64 = 32.0;
const GAP: f64 = 12.0;
const BELOW: f64 = 104.0;

/// A plot of a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Height of its ordinate.
    pub height: f64,
    /// Ordinate.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub layers: Vec<Layer>,
}

/// A name of the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct StackKey {
    /// Name.
    pub label: String,
    /// Colour.
    pub colour: Colour,
    /// Whether it stands for a line rather than a surface.
    pub line: bool,
}

/// Plots over one abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    /// What a screen reader says.
    pub label: String,
    /// Names of curves and colours.
    pub legend: Vec<StackKey>,
    /// The abscissa.
    pub x: Axis,
    /// The plots, from above.
    pub rows: Vec<Row>,
}

impl Stack {
    /// The stack as SVG; the script finds the abscissa in its attributes.
    pub fn svg(&self) -> String {
        self.picture().svg()
    }

    /// The stack as PNG, 2400 pixels wide.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn png(&self) -> crate::error::Result<Vec<u8>> {
        self.picture().png()
    }

    fn picture(&self) -> Picture {
        let rows: f64 = self.rows.iter().map(|row| row.height + GAP).sum();
        let height = (LEGEND + rows + BELOW).round() as u32;
        let mut picture = Picture::new((WIDTH, height), self.label.clone());
        self.draw_legend(&mut picture);
        let mut top = LEGEND;
        for (index, row) in self.rows.iter().enumerate() {
            let frame = Frame { left: LEFT, right: f64::from(WIDTH) - RIGHT, top, bottom: top + row.height };
            let last = index + 1 == self.rows.len();
            let ticks = MostTicks { x: last.then_some(12), y: if row.height > 300.0 { 6 } else { 4 } };
            Plot { x: &self.x, y: &row.y, layers: &row.layers, frame, text: TEXT, ticks }.draw(&mut picture);
            top = frame.bottom + GAP;
        }
        picture.attributes = self.attributes();
        picture
    }

    fn attributes(&self) -> Vec<(&'static str, String)> {
        let [from, to] = self.x.ends();
        vec![
            ("data-left", LEFT.to_string()),
            ("data-right", (f64::from(WIDTH) - RIGHT).to_string()),
            ("data-from", from.to_string()),
            ("data-to", to.to_string()),
        ]
    }

    fn draw_legend(&self, picture: &mut Picture) {
        let (mut x, middle) = (LEFT, LEGEND / 2.0);
        for key in &self.legend {
            let sample = if key.line { 56.0 } else { 36.0 };
            if key.line {
                picture.path(vec![(x, middle), (x + sample, middle)], Pen::new(key.colour, 6.0));
            } else {
                picture.block([(x, middle - 16.0), (x + sample, middle + 16.0)], key.colour);
            }
            let words = super::picture::Words {
                at: (x + sample + 14.0, middle),
                text: key.label.clone(),
                size: TEXT,
                colour: INK,
                anchor: (Across::Start, Down::Middle),
                upwards: false,
            };
            picture.text(words);
            x += sample + 60.0 + 0.6 * TEXT * key.label.chars().count() as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::colours::PALETTE;
    use super::*;

    #[test]
    fn analytic_rows_share_their_abscissa() {
        let row = |height: f64| {
            let points = vec![(0.0, 0.0), (5.0, 1.0), (10.0, 0.5)];
            let line =
                Layer::Line { colour: PALETTE[0], width: 2, dashed: false, name: "line".into(), points };
            Row { height, y: Axis::holding("y", [1.0]), layers: vec![line] }
        };
        let x = Axis::linear("time s", 0.0, 10.0);
        let stack = Stack { label: "two".into(), legend: Vec::new(), x, rows: vec![row(400.0), row(200.0)] };
        let picture = stack.picture();
        let at: Vec<_> = picture.hits.iter().map(|hit| hit.at).collect();
        assert!((0..3).all(|k| at[k].0 == at[k + 3].0 && at[k].1 < at[k + 3].1), "{at:?}");
        assert_eq!((at[0].0, at[2].0), (LEFT, f64::from(WIDTH) - RIGHT));
        assert_eq!(picture.attributes[1], ("data-right", "2368".to_owned()));
    }
}

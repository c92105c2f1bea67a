//! A graph: bands, lines, bars and dots over two axes, the building block of most figures.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use super::colours::{Colour, INK, Mark};
use super::svg::{Drawn, Hit, Told, svg};
use crate::error::Result;

/// How large a graph is drawn, in its own units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Half as wide as the page.
    Half,
    /// As wide as the page.
    Wide,
    /// As wide and half as high.
    Low,
    /// As wide and low: a strip below another graph.
    Strip,
}

impl Format {
    /// Width and height.
    fn size(self) -> (u32, u32) {
        match self {
            Format::Half => (720, 460),
            Format::Wide => (2400, 900),
            Format::Low => (2400, 560),
            Format::Strip => (2400, 260),
        }
    }

    /// Height of text, so that both look the same on the page.
    fn text(self) -> i32 {
        match self {
            Format::Half => 21,
            Format::Wide | Format::Low | Format::Strip => 36,
        }
    }
}

/// A place with something to tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Dot {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// What it tells under the pointer.
    pub tip: String,
}

/// Something drawn over the axes. Points that are not finite leave gaps; those beyond the axes stand at their ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// Between two ordinates: an interval along the abscissa. Points are (x, lower y, upper y).
    Band { colour: Colour, points: Vec<(f64, f64, f64)> },
    /// Points joined by lines, with a name told under the pointer.
    Line { colour: Colour, width: u32, dashed: bool, name: String, points: Vec<(f64, f64)> },
    /// From one point to another each, thick: an interval.
    Spans { colour: Colour, width: u32, spans: Vec<[(f64, f64); 2]> },
    /// Bars from zero: (from x, to x, height); solid, or pale under lines.
    Bars { colour: Colour, solid: bool, bars: Vec<(f64, f64, f64)> },
    /// Single points.
    Dots { colour: Colour, mark: Mark, size: i32, hollow: bool, dots: Vec<Dot> },
}

/// A graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    /// Title above it; empty for none.
    pub title: String,
    /// Size.
    pub format: Format,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub layers: Vec<Layer>,
}

/// The place of the axes within the graph, units of the drawing.
struct Frame {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

/// Places under the pointer along a line.
const HITS: usize = 40;

impl Graph {
    /// The graph as SVG.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn svg(&self) -> Result<String> {
        let label = format!("{}: {} over {}", self.title, self.y.label, self.x.label);
        svg(self.format.size(), &label, |area| self.draw(area))
    }

    fn frame(&self) -> Frame {
        let ((width, height), text) = (self.format.size(), self.format.text());
        let widest = self.y_ticks().iter().map(|(_, name)| name.chars().count()).max().unwrap_or(0) as i32;
        Frame {
            // Graphs below each other begin at the same place; only long names need more room.
            left: if self.format == Format::Half { 3 * text } else { 9 * text / 2 }
                .max(2 * text + 11 * text * widest / 20),
            right: width as i32 - text,
            top: if self.title.is_empty() { text / 2 } else { 2 * text },
            bottom: height as i32 - 3 * text - text / 3,
        }
    }

    fn x_ticks(&self) -> Vec<(f64, String)> {
        self.x.ticks(if self.format == Format::Half { 7 } else { 12 })
    }

    fn y_ticks(&self) -> Vec<(f64, String)> {
        self.y.ticks(6)
    }

    fn place(&self, frame: &Frame, (x, y): (f64, f64)) -> (i32, i32) {
        let across = f64::from(frame.right - frame.left) * self.x.share(x);
        let down = f64::from(frame.bottom - frame.top) * (1.0 - self.y.share(y));
        (frame.left + across.round() as i32, frame.top + down.round() as i32)
    }

    fn text(&self, colour: Colour, h_pos: HPos, v_pos: VPos) -> TextStyle<'static> {
        ("sans-serif", self.format.text()).into_font().color(&colour.rgb()).pos(Pos::new(h_pos, v_pos))
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Drawn<Told, DB> {
        let frame = self.frame();
        self.draw_axes(area, &frame)?;
        let mut told = Told::default();
        for layer in &self.layers {
            self.draw_layer(area, &frame, layer, &mut told.hits)?;
        }
        Ok(told)
    }

    fn draw_axes<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>, frame: &Frame) -> Drawn<(), DB> {
        let Frame { left, right, top, bottom } = *frame;
        let (thin, text) = (self.format.text() / 18, self.format.text());
        let grid = INK.rgb().mix(0.12).stroke_width(thin as u32);
        let axis = INK.rgb().mix(0.6).stroke_width(thin as u32);
        for (value, name) in self.y_ticks() {
            let (_, y) = self.place(frame, (0.0, value));
            area.draw(&PathElement::new([(left, y), (right, y)], grid))?;
            area.draw(&Text::new(name, (left - text / 3, y), self.text(INK, HPos::Right, VPos::Center)))?;
        }
        for (value, name) in self.x_ticks() {
            let (x, _) = self.place(frame, (value, 0.0));
            area.draw(&PathElement::new([(x, bottom), (x, bottom + text / 4)], axis))?;
            area.draw(&Text::new(name, (x, bottom + text / 2), self.text(INK, HPos::Center, VPos::Top)))?;
        }
        area.draw(&PathElement::new([(left, top), (left, bottom), (right, bottom)], axis))?;
        let middle = (left + right) / 2;
        let place = (middle, self.format.size().1 as i32 - text / 3);
        area.draw(&Text::new(self.x.label.clone(), place, self.text(INK, HPos::Center, VPos::Bottom)))?;
        let upright = self.text(INK, HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
        area.draw(&Text::new(self.y.label.clone(), (text / 6, (top + bottom) / 2), upright))?;
        area.draw(&Text::new(self.title.clone(), (middle, text / 3), self.text(INK, HPos::Center, VPos::Top)))
    }

    fn draw_layer<DB: DrawingBackend>(
        &self,
        area: &DrawingArea<DB, Shift>,
        frame: &Frame,
        layer: &Layer,
        hits: &mut Vec<Hit>,
    ) -> Drawn<(), DB> {
        match layer {
            Layer::Band { colour, points } => {
                for part in
                    points.split(|(x, low, high)| !(x.is_finite() && low.is_finite() && high.is_finite()))
                {
                    let lower = part.iter().map(|&(x, low, _)| self.place(frame, (x, low)));
                    let upper = part.iter().rev().map(|&(x, _, high)| self.place(frame, (x, high)));
                    let outline: Vec<_> = lower.chain(upper).collect();
                    area.draw(&Polygon::new(outline, colour.rgb().mix(0.18).filled()))?;
                }
                Ok(())
            }
            Layer::Line { colour, width, dashed, name, points } => {
                let style = colour.rgb().stroke_width(*width);
                for part in points.split(|(x, y)| !(x.is_finite() && y.is_finite())) {
                    let path: Vec<_> = part.iter().map(|&point| self.place(frame, point)).collect();
                    if *dashed {
                        let unit = self.format.text() / 4;
                        area.draw(&DashedPathElement::new(path, 2 * unit, unit, style))?;
                    } else {
                        area.draw(&PathElement::new(path, style))?;
                    }
                }
                if !name.is_empty() {
                    let told = points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
                    let every = points.len().div_ceil(HITS).max(1);
                    hits.extend(told.step_by(every).map(|&(x, y)| {
                        let tip = format!("{name}\n{}: {:.4}\n{}: {:.4}", self.x.label, x, self.y.label, y);
                        Hit { at: self.place(frame, (x, y)), tip, colour: colour.hex() }
                    }));
                }
                Ok(())
            }
            Layer::Spans { colour, width, spans } => {
                let style = colour.rgb().stroke_width(*width);
                spans.iter().try_for_each(|ends| {
                    area.draw(&PathElement::new(ends.map(|end| self.place(frame, end)), style))
                })
            }
            Layer::Bars { colour, solid, bars } => bars.iter().try_for_each(|&(from, to, height)| {
                let corners = [self.place(frame, (from, 0.0)), self.place(frame, (to, height))];
                let opacity = if *solid { 1.0 } else { 0.45 };
                area.draw(&Rectangle::new(corners, colour.rgb().mix(opacity).filled()))
            }),
            Layer::Dots { colour, mark, size, hollow, dots } => dots.iter().try_for_each(|dot| {
                let at = self.place(frame, (dot.x, dot.y));
                hits.push(Hit { at, tip: dot.tip.clone(), colour: colour.hex() });
                draw_mark(area, *mark, at, *size, colour.rgb().filled())?;
                if *hollow { draw_mark(area, *mark, at, (*size - 3).max(1), WHITE.filled()) } else { Ok(()) }
            }),
        }
    }
}

fn draw_mark<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    mark: Mark,
    (x, y): (i32, i32),
    size: i32,
    style: ShapeStyle,
) -> Drawn<(), DB> {
    match mark {
        Mark::Circle => area.draw(&Circle::new((x, y), size, style)),
        Mark::Square => {
            let half = (size - 1).max(1);
            area.draw(&Rectangle::new([(x - half, y - half), (x + half, y + half)], style))
        }
        Mark::Triangle => area.draw(&TriangleMarker::new((x, y), size + 2, style)),
        Mark::None => Ok(()),
    }
}

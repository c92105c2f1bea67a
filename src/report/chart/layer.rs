//! What is drawn over two axes, and how.

use super::colours::{Colour, INK, Mark, WHITE};
use super::picture::{Across, Down, Hit, Ink, Pen, Picture, Place, Shape};
use super::plot::Plot;
use super::thin;

/// Places under the pointer along a line.
const HITS: usize = 40;
/// Size of the marks of a curve, units of the picture.
const CURVE_MARK: f64 = 6.0;

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

impl Plot<'_> {
    /// Draws a layer.
    pub(super) fn draw_layer(&self, picture: &mut Picture, layer: &Layer) {
        match layer {
            Layer::Band { colour, points } => self.draw_band(picture, *colour, points),
            Layer::Line { colour, width, dashed, name, points } => {
                let pen = Pen::new(*colour, f64::from(*width));
                let unit = (self.text / 4.0).floor();
                self.draw_line(picture, if *dashed { pen.dashed(2.0 * unit, unit) } else { pen }, points);
                self.add_hits(picture, *colour, name, points);
            }
            Layer::Spans { colour, width, spans } => {
                let ends = spans.iter().map(|ends| ends.map(|end| self.place(end)));
                let pen = Pen::new(*colour, f64::from(*width));
                thin::spans(ends).into_iter().for_each(|ends| picture.path(ends.to_vec(), pen));
            }
            Layer::Bars { colour, bars } => {
                for &(from, to, height) in bars {
                    picture.block([self.place((from, 0.0)), self.place((to, height))], colour.pale(0.45));
                }
            }
            Layer::Dots { colour, mark, size, hollow, dots } => {
                let size = f64::from(*size);
                dots.iter().for_each(|dot| self.draw_dot(picture, (*colour, *mark, size), *hollow, dot));
            }
            Layer::Curve { colour, mark, zone_share, points } => {
                self.draw_curve(picture, (*colour, *mark), *zone_share, points);
            }
            Layer::Stretches(stretches) => self.draw_stretches(picture, stretches),
            Layer::Shade { from, to } => {
                let (left, right) = (self.place((*from, 0.0)).0, self.place((*to, 0.0)).0);
                picture.block([(left, self.top()), (right, self.frame.bottom)], INK.pale(0.05));
            }
            Layer::Threshold { y, name } => self.draw_threshold(picture, *y, name),
            Layer::Moment { x, name, colour } => self.draw_moment(picture, *x, name, *colour),
        }
    }

    fn draw_band(&self, picture: &mut Picture, colour: Colour, points: &[(f64, f64, f64)]) {
        for part in points.split(|(x, low, high)| !(x.is_finite() && low.is_finite() && high.is_finite())) {
            let lower = part.iter().map(|&(x, low, _)| self.place((x, low)));
            let upper = part.iter().rev().map(|&(x, _, high)| self.place((x, high)));
            let outline: Vec<_> = lower.chain(upper).collect();
            if outline.len() > 2 {
                picture.shapes.push(Shape::Area { points: outline, ink: colour.pale(0.18) });
            }
        }
    }

    fn draw_line(&self, picture: &mut Picture, pen: Pen, points: &[(f64, f64)]) {
        for part in points.split(|(x, y)| !(x.is_finite() && y.is_finite())) {
            let places: Vec<Place> = part.iter().map(|&point| self.place(point)).collect();
            picture.path(thin::line(&places), pen);
        }
    }

    fn add_hits(&self, picture: &mut Picture, colour: Colour, name: &str, points: &[(f64, f64)]) {
        if name.is_empty() {
            return;
        }
        let finite = points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
        let every = points.len().div_ceil(HITS).max(1);
        picture.hits.extend(finite.step_by(every).map(|&(x, y)| {
            let tip = format!("{name}\n{}: {x:.4}\n{}: {y:.4}", self.x.label, self.y.label);
            Hit { at: self.place((x, y)), tip, colour }
        }));
    }

    fn draw_dot(
        &self,
        picture: &mut Picture,
        (colour, mark, size): (Colour, Mark, f64),
        hollow: bool,
        dot: &Dot,
    ) {
        let at = self.place((dot.x, dot.y));
        draw_mark(picture, mark, at, size, colour.into());
        if hollow {
            draw_mark(picture, mark, at, (size - 3.0).max(1.0), WHITE.into());
        }
        picture.hits.push(Hit { at, tip: dot.tip.clone(), colour });
    }

    fn draw_curve(
        &self,
        picture: &mut Picture,
        (colour, mark): (Colour, Mark),
        zone_share: f64,
        points: &[CurvePoint],
    ) {
        let place = |point: &CurvePoint| match point.y {
            Some(y) => self.place((point.x, y)),
            None => self.place_in_zone(point.x, zone_share),
        };
        for pair in points.windows(2) {
            let numbers = pair.iter().all(|point| point.y.is_some());
            // There are no numbers between a number and the zone.
            let pen = if numbers {
                Pen::new(colour, 2.0)
            } else {
                Pen::new(colour.pale(0.6), 2.0).dashed(6.0, 5.0)
            };
            picture.path(pair.iter().map(place).collect(), pen);
        }
        for point in points {
            let at = place(point);
            match point.y {
                Some(_) => draw_mark(picture, mark, at, CURVE_MARK, colour.into()),
                None => draw_cross(picture, at, colour),
            }
            if point.hollow && point.y.is_some() {
                draw_mark(picture, mark, at, CURVE_MARK / 2.0, WHITE.into());
            }
            picture.hits.push(Hit { at, tip: point.tip.clone(), colour });
        }
    }

    fn draw_stretches(&self, picture: &mut Picture, stretches: &[Stretch]) {
        let along = |stretch: &Stretch| {
            let [from, to] = [stretch.from, stretch.to].map(|x| self.place((x, 0.0)).0);
            (from, to, stretch.colour)
        };
        for (from, to, colour) in thin::stretches(stretches.iter().map(along)) {
            picture.block([(from, self.top()), (to, self.frame.bottom)], colour);
        }
    }

    fn draw_threshold(&self, picture: &mut Picture, y: f64, name: &str) {
        if !self.y.holds(y) {
            return;
        }
        let (left, right, at) = (self.frame.left, self.frame.right, self.place((0.0, y)).1);
        picture.path(vec![(left, at), (right, at)], Pen::new(INK.pale(0.55), 1.0).dashed(5.0, 4.0));
        // Between line and axis there must be room for its name; the caption names it too.
        if self.frame.bottom - at > 1.6 * self.text {
            let place = (right - self.text / 3.0, at + self.text / 4.0);
            picture.text(self.words(name, place, (Across::End, Down::Top), INK));
        }
    }

    fn draw_moment(&self, picture: &mut Picture, x: f64, name: &str, colour: Colour) {
        if !self.x.holds(x) {
            return;
        }
        let at = self.place((x, 0.0)).0;
        picture.path(vec![(at, self.top()), (at, self.frame.bottom)], Pen::new(colour, self.text / 6.0));
        let place = (at - self.text / 3.0, self.top() + self.text / 4.0);
        picture.text(self.words(name, place, (Across::End, Down::Top), colour));
    }
}

fn draw_cross(picture: &mut Picture, (x, y): Place, colour: Colour) {
    let (pen, arm) = (Pen::new(colour, 3.0), CURVE_MARK);
    picture.path(vec![(x - arm, y - arm), (x + arm, y + arm)], pen);
    picture.path(vec![(x - arm, y + arm), (x + arm, y - arm)], pen);
}

/// A mark; squares are smaller and triangles larger, so that all look alike in size.
pub(super) fn draw_mark(picture: &mut Picture, mark: Mark, (x, y): Place, size: f64, ink: Ink) {
    match mark {
        Mark::Circle => picture.shapes.push(Shape::Disc { at: (x, y), radius: size, ink }),
        Mark::Square => {
            let half = (size - 1.0).max(1.0);
            picture.block([(x - half, y - half), (x + half, y + half)], ink);
        }
        Mark::Triangle => {
            let reach = size + 2.0;
            let (wide, low) = (reach * 0.866, reach * 0.5);
            let points = vec![(x, y - reach), (x + wide, y + low), (x - wide, y + low)];
            picture.shapes.push(Shape::Area { points, ink });
        }
        Mark::None => {}
    }
}

//! A panel of curves over slenderness; collapses stand in a band of their own above all numbers.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::colours::{COLLAPSE, Colour, INK, Mark};
use super::svg::{Drawn, Hit, Told, svg};
use super::words::tick;
use crate::aggregate::Middle;
use crate::error::Result;

/// Size of a panel in its own units; text is set for panels half a page wide.
const SIZE: (u32, u32) = (720, 460);
/// Height of text.
const TEXT: i32 = 21;

/// Top of the band for collapses, over the largest number shown.
const BAND: f64 = 1.16;

/// A point of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePoint {
    /// Abscissa.
    pub x: f64,
    /// Ordinate: a number, or a collapse.
    pub y: Middle,
    /// Whether some of what it stands for collapsed although it did not: drawn hollow.
    pub partly_collapsed: bool,
    /// What it tells under the pointer.
    pub tip: String,
}

/// A curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Colour.
    pub colour: Colour,
    /// Shape of its points.
    pub mark: Mark,
    /// Points, abscissa increasing.
    pub points: Vec<CurvePoint>,
}

/// A panel of curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Abscissa with its unit.
    pub x_label: String,
    /// Ordinate with its unit.
    pub y_label: String,
    /// Abscissae shown.
    pub x: Range<f64>,
    /// Largest ordinate shown as a number.
    pub y_top: f64,
    /// Whether there is a band for collapses above.
    pub collapse_band: bool,
    /// A line across, and what it means.
    pub threshold: Option<(f64, &'static str)>,
    /// The curves.
    pub curves: Vec<Curve>,
}

type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl Panel {
    /// The panel as SVG.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn svg(&self) -> Result<String> {
        svg(SIZE, &format!("{}: {} over {}", self.title, self.y_label, self.x_label), |area| self.draw(area))
    }

    /// Draws it.
    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Drawn<Told, DB> {
        let top = if self.collapse_band { self.y_top * BAND } else { self.y_top };
        let mut chart = ChartBuilder::on(area)
            .margin_left(8)
            .margin_right(14)
            .margin_top(6)
            .margin_bottom(4)
            .caption(&self.title, ("sans-serif", TEXT + 3).into_font().color(&INK.rgb()))
            .x_label_area_size(58)
            .y_label_area_size(82)
            .build_cartesian_2d(self.x.clone(), 0.0..top)?;
        self.mesh(&mut chart)?;
        self.bands(&mut chart)?;
        let mut told = Told::default();
        for (index, curve) in self.curves.iter().enumerate() {
            self.curve(&mut chart, (index, curve), &mut told.hits)?;
        }
        Ok(told)
    }

    fn mesh<DB: DrawingBackend>(&self, chart: &mut Chart<DB>) -> Drawn<(), DB> {
        let text = ("sans-serif", TEXT).into_font().color(&INK.rgb());
        // The band above the numbers has no numbers.
        let y_text = |y: &f64| if *y > self.y_top * 1.0001 { String::new() } else { tick(*y) };
        let x_text = |x: &f64| tick(*x);
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(INK.rgb().mix(0.12))
            .axis_style(INK.rgb().mix(0.6))
            .x_labels(10)
            .y_labels(7)
            .x_label_formatter(&x_text)
            .y_label_formatter(&y_text)
            .label_style(text.clone())
            .axis_desc_style(text)
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .draw()
    }

    fn bands<DB: DrawingBackend>(&self, chart: &mut Chart<DB>) -> Drawn<(), DB> {
        let (left, right) = (self.x.start, self.x.end);
        let small = |colour: Colour, h_pos, v_pos| {
            ("sans-serif", TEXT - 3).into_font().color(&colour.rgb()).pos(Pos::new(h_pos, v_pos))
        };
        if self.collapse_band {
            let band = [(left, self.y_top), (right, self.y_top * BAND)];
            chart.draw_series([Rectangle::new(band, COLLAPSE.rgb().mix(0.09).filled())])?;
            let place = (left + 0.01 * (right - left), self.y_top * (1.0 + BAND) / 2.0);
            chart.draw_series([Text::new("collapse", place, small(COLLAPSE, HPos::Left, VPos::Center))])?;
        }
        if let Some((y, meaning)) = self.threshold.filter(|(y, _)| *y < self.y_top) {
            let style = INK.rgb().mix(0.55).stroke_width(1);
            chart.draw_series(DashedLineSeries::new([(left, y), (right, y)], 5, 4, style))?;
            // Between line and axis there must be room for its name; the caption names it too.
            if y > 0.12 * self.y_top {
                let place = (right - 0.01 * (right - left), y - 0.015 * self.y_top);
                chart.draw_series([Text::new(meaning, place, small(INK, HPos::Right, VPos::Top))])?;
            }
        }
        Ok(())
    }

    fn curve<DB: DrawingBackend>(
        &self,
        chart: &mut Chart<DB>,
        (index, curve): (usize, &Curve),
        hits: &mut Vec<Hit>,
    ) -> Drawn<(), DB> {
        let colour = curve.colour.rgb();
        for pair in curve.points.windows(2) {
            let ends = [0, 1].map(|i| (pair[i].x, self.height(pair[i].y, index)));
            let collapses = pair.iter().any(|point| point.y == Middle::Collapsed);
            if collapses {
                chart.draw_series(DashedLineSeries::new(ends, 6, 5, colour.mix(0.6).stroke_width(2)))?;
            } else {
                chart.draw_series(LineSeries::new(ends, colour.stroke_width(2)))?;
            }
        }
        for point in &curve.points {
            let at = (point.x, self.height(point.y, index));
            draw_mark(chart, curve, point, at)?;
            hits.push(Hit {
                at: chart.backend_coord(&at),
                tip: point.tip.clone(),
                colour: curve.colour.hex(),
            });
        }
        Ok(())
    }

    /// Where a value stands; collapses have no value, so within their band every curve has a height of its own.
    fn height(&self, y: Middle, index: usize) -> f64 {
        match y {
            Middle::Rotation(y) => y,
            Middle::Collapsed => {
                let share = (index as f64 + 0.5) / self.curves.len() as f64;
                self.y_top * (1.0 + (BAND - 1.0) * (0.1 + 0.8 * share))
            }
        }
    }
}

fn draw_mark<DB: DrawingBackend>(
    chart: &mut Chart<DB>,
    curve: &Curve,
    point: &CurvePoint,
    at: (f64, f64),
) -> Drawn<(), DB> {
    let colour = curve.colour.rgb();
    if point.y == Middle::Collapsed {
        chart.draw_series([Cross::new(at, 6, colour.stroke_width(3))])?;
        return Ok(());
    }
    draw_shape(chart, curve.mark, at, 6, colour.filled())?;
    if point.partly_collapsed {
        draw_shape(chart, curve.mark, at, 3, WHITE.filled())?;
    }
    Ok(())
}

fn draw_shape<DB: DrawingBackend>(
    chart: &mut Chart<DB>,
    mark: Mark,
    at: (f64, f64),
    size: i32,
    style: ShapeStyle,
) -> Drawn<(), DB> {
    let place = EmptyElement::at(at);
    match mark {
        Mark::Circle => chart.draw_series([place + Circle::new((0, 0), size, style)])?,
        Mark::Square => {
            let corners = [(1 - size, 1 - size), (size - 1, size - 1)];
            chart.draw_series([place + Rectangle::new(corners, style)])?
        }
        Mark::Triangle => chart.draw_series([place + TriangleMarker::new((0, 0), size + 2, style)])?,
        Mark::None => return Ok(()),
    };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        let point = |x, y| CurvePoint { x, y, partly_collapsed: false, tip: format!("at {x}") };
        let points = vec![
            point(8.0, Middle::Rotation(0.02)),
            point(10.0, Middle::Rotation(0.3)),
            point(12.0, Middle::Collapsed),
        ];
        Panel {
            title: "a < b".into(),
            x_label: "x".into(),
            y_label: "y".into(),
            x: 7.0..13.0,
            y_top: 0.4,
            collapse_band: true,
            threshold: Some((0.05, "line")),
            curves: vec![Curve { colour: Colour(0, 0x72, 0xB2), mark: Mark::Circle, points }],
        }
    }

    #[test]
    fn regress_a_collapse_stands_above_every_number() {
        let svg = panel().svg().expect("drawn");
        let heights: Vec<i32> = svg
            .split("<circle ")
            .filter(|part| part.contains("data-colour"))
            .filter_map(|part| part.split_once("cy=\"")?.1.split_once('"')?.0.parse().ok())
            .collect();
        // Downwards in SVG: the collapse first, then the large rotation, then the small one.
        assert!(heights.len() == 3 && heights[2] < heights[1] && heights[1] < heights[0], "{heights:?}");
        assert!(svg.contains("collapse") && svg.contains("a &lt; b") && !svg.contains("NaN"));
    }

    #[test]
    fn regress_the_same_panel_gives_the_same_bytes() {
        assert_eq!(panel().svg().expect("drawn"), panel().svg().expect("drawn"));
    }
}

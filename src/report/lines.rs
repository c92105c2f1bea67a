//! A panel of plain lines: spectra, convergence.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::colours::{Colour, INK};
use super::svg::{Drawn, Hit, Told, svg};
use super::words::tick;
use crate::error::Result;

/// Size of a panel in its own units: plotters rounds to whole ones, so they are fine.
const SIZE: (u32, u32) = (1800, 900);
/// Height of text.
const TEXT: i32 = 30;
/// Places under the pointer along a line.
const HITS: usize = 40;

/// A line.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Name, told under the pointer.
    pub name: String,
    /// Colour.
    pub colour: Colour,
    /// Width in units of the panel.
    pub width: u32,
    /// Points, abscissa increasing.
    pub points: Vec<(f64, f64)>,
}

/// A panel of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct LinePanel {
    /// What it shows, for screen readers.
    pub title: String,
    /// Abscissa with its unit.
    pub x_label: String,
    /// Ordinate with its unit.
    pub y_label: String,
    /// A stretch of the abscissa that is shaded.
    pub shaded: Option<(f64, f64)>,
    /// Largest ordinate.
    pub y_top: f64,
    /// The lines, the last on top.
    pub lines: Vec<Line>,
}

impl LinePanel {
    /// The panel as SVG.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn svg(&self) -> Result<String> {
        svg(SIZE, &format!("{}: {} over {}", self.title, self.y_label, self.x_label), |area| self.draw(area))
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Drawn<Told, DB> {
        let ends =
            self.lines.iter().flat_map(|line| line.points.first().into_iter().chain(line.points.last()));
        let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), (x, _)| (low.min(*x), high.max(*x)));
        let label = ("sans-serif", TEXT).into_font().color(&INK.rgb());
        let mut chart = ChartBuilder::on(area)
            .margin(16)
            .x_label_area_size(90)
            .y_label_area_size(130)
            .build_cartesian_2d(low..high, 0.0..self.y_top)?;
        if let Some((from, to)) = self.shaded {
            chart.draw_series([Rectangle::new(
                [(from, 0.0), (to, self.y_top)],
                INK.rgb().mix(0.05).filled(),
            )])?;
        }
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(INK.rgb().mix(0.12).stroke_width(2))
            .axis_style(INK.rgb().mix(0.6).stroke_width(2))
            .x_labels(10)
            .y_labels(7)
            .x_label_formatter(&|x| tick(*x))
            .y_label_formatter(&|y| tick(*y))
            .label_style(label.clone())
            .axis_desc_style(label)
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .draw()?;
        let mut told = Told::default();
        for line in &self.lines {
            chart.draw_series(LineSeries::new(
                line.points.iter().copied(),
                line.colour.rgb().stroke_width(line.width),
            ))?;
            let every = line.points.len().div_ceil(HITS).max(1);
            told.hits.extend(line.points.iter().step_by(every).map(|point| Hit {
                at: chart.backend_coord(point),
                tip: format!(
                    "{}\n{}: {}\n{}: {:.3}",
                    line.name,
                    self.x_label,
                    tick(point.0),
                    self.y_label,
                    point.1
                ),
                colour: line.colour.hex(),
            }));
        }
        Ok(told)
    }
}

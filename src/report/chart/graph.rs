//! A graph: one plot as a picture of its own, the building block of most figures.

use super::axis::Axis;
use super::colours::INK;
use super::layer::Layer;
use super::picture::{Across, Down, Picture};
use super::plot::{Frame, MostTicks, Plot};

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
            Format::Strip => (2400, 200),
        }
    }

    /// Height of letters, so that all look the same on the page.
    fn text(self) -> f64 {
        match self {
            Format::Half => 17.0,
            Format::Wide | Format::Low | Format::Strip => 30.0,
        }
    }

    /// Least room at the left: graphs below each other begin at the same place.
    fn least_room(self) -> f64 {
        match self {
            Format::Half => 3.6 * self.text(),
            Format::Wide | Format::Low | Format::Strip => 5.4 * self.text(),
        }
    }

    fn most_ticks(self) -> MostTicks {
        match self {
            Format::Half => MostTicks { x: Some(9), y: 6 },
            Format::Wide | Format::Low | Format::Strip => MostTicks { x: Some(12), y: 6 },
        }
    }
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

impl Graph {
    /// The graph as SVG.
    pub fn svg(&self) -> String {
        self.picture().svg()
    }

    fn picture(&self) -> Picture {
        let mut picture = Picture::new(self.format.size(), self.label());
        let plot = Plot {
            x: &self.x,
            y: &self.y,
            layers: &self.layers,
            frame: self.frame(),
            text: self.format.text(),
            ticks: self.format.most_ticks(),
        };
        plot.draw(&mut picture);
        let at = ((plot.frame.left + plot.frame.right) / 2.0, plot.text / 3.0);
        picture.text(plot.words(&self.title, at, (Across::Middle, Down::Top), INK));
        picture
    }

    fn label(&self) -> String {
        let axes = format!("{} over {}", self.y.label, self.x.label);
        if self.title.is_empty() { axes } else { format!("{}: {axes}", self.title) }
    }

    fn frame(&self) -> Frame {
        let ((width, height), text) = (self.format.size(), self.format.text());
        let room = Plot::room(&self.y, self.format.most_ticks().y, text);
        Frame {
            left: room.max(self.format.least_room()),
            right: f64::from(width) - 1.2 * text,
            top: if self.title.is_empty() { 0.6 * text } else { 1.9 * text },
            bottom: f64::from(height) - 3.2 * text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::colours::{Mark, PALETTE};
    use super::super::layer::CurvePoint;
    use super::*;

    fn graph() -> Graph {
        let point = |x: f64, y| CurvePoint { x, y, hollow: false, tip: format!("at {x}") };
        let points = vec![point(8.0, Some(0.02)), point(10.0, Some(0.39)), point(12.0, None)];
        Graph {
            title: "a < b".into(),
            format: Format::Half,
            x: Axis::linear("x", 7.0, 13.0),
            y: Axis::holding("y", [0.4]).with_zone("collapse"),
            layers: vec![
                Layer::Threshold { y: 0.05, name: "line" },
                Layer::Curve { colour: PALETTE[0], mark: Mark::Circle, zone_share: 0.0, points },
            ],
        }
    }

    #[test]
    fn analytic_a_collapse_stands_above_the_axis_and_every_number() {
        let picture = graph().picture();
        let heights: Vec<f64> = picture.hits.iter().map(|hit| hit.at.1).collect();
        // Downwards: the collapse first, then the axis of numbers, the large rotation, the small one.
        let top = graph().frame().top + 2.2 * Format::Half.text();
        assert!(heights[2] < top && top < heights[1] && heights[1] < heights[0], "{heights:?}, {top}");
        let svg = picture.svg();
        assert!(svg.contains("collapse") && svg.contains("a &lt; b") && !svg.contains("NaN"));
    }

    #[test]
    fn regress_a_point_beyond_the_axes_stands_at_their_end() {
        let mut graph = graph();
        let points = vec![(0.0, 0.1), (f64::NAN, 0.1), (20.0, 9.0)];
        graph.layers =
            vec![Layer::Line { colour: PALETTE[1], width: 2, dashed: false, name: "line".into(), points }];
        let picture = graph.picture();
        let frame = graph.frame();
        let [first, last] = [0, 1].map(|k| picture.hits[k].at.0);
        assert_eq!((first, last, picture.hits.len()), (frame.left, frame.right, 2));
    }

    #[test]
    fn regress_the_same_graph_gives_the_same_bytes() {
        assert_eq!(graph().svg(), graph().svg());
    }
}

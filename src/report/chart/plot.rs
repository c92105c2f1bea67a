//! Axes and layers within a frame of a picture.

use super::axis::Axis;
use super::colours::{COLLAPSE, Colour, INK};
use super::layer::Layer;
use super::picture::{Across, Down, Pen, Picture, Place, Words};

/// Height of the zone above the axis, and of the gap below it, over that of text.
const ZONE: f64 = 2.2;
const GAP: f64 = 0.7;

/// A rectangle of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Left edge.
    pub left: f64,
    /// Right edge.
    pub right: f64,
    /// Upper edge.
    pub top: f64,
    /// Lower edge.
    pub bottom: f64,
}

/// Room at the right of every axis, in heights of letters.
const BESIDE: f64 = 0.8;

/// Most ticks of the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MostTicks {
    /// Of the abscissa; `None` draws none, and no label: it is drawn below another plot.
    pub x: Option<usize>,
    /// Of the ordinate.
    pub y: usize,
}

/// Axes and layers within a frame.
#[derive(Debug, Clone, Copy)]
pub struct Plot<'a> {
    /// Abscissa.
    pub x: &'a Axis,
    /// Ordinate.
    pub y: &'a Axis,
    /// What is drawn, the last on top.
    pub layers: &'a [Layer],
    /// Where.
    pub frame: Frame,
    /// Height of letters.
    pub text: f64,
    /// Most ticks.
    pub ticks: MostTicks,
}

impl Plot<'_> {
    /// Room at the left that the texts of an axis need.
    pub fn room(y: &Axis, most_ticks: usize, text: f64) -> f64 {
        let ticks = y.ticks(most_ticks);
        let zone = y.zone().map(|name| 0.8 * name.chars().count() as f64);
        let widest =
            ticks.iter().map(|(_, name)| name.chars().count() as f64).chain(zone).fold(0.0, f64::max);
        text * (2.0 + 0.55 * widest)
    }

    /// Draws axes and layers.
    pub fn draw(&self, picture: &mut Picture) {
        // What is shaded lies below the grid.
        let below = |layer: &&Layer| matches!(layer, Layer::Shade { .. });
        self.layers.iter().filter(below).for_each(|layer| self.draw_layer(picture, layer));
        self.draw_zone(picture);
        self.draw_y_axis(picture);
        self.draw_x_axis(picture);
        self.layers.iter().filter(|layer| !below(layer)).for_each(|layer| self.draw_layer(picture, layer));
    }

    /// Upper end of the ordinate: below the zone, where there is one.
    pub(super) fn top(&self) -> f64 {
        self.frame.top + if self.y.zone().is_some() { (ZONE + GAP) * self.text } else { 0.0 }
    }

    /// Where a point stands.
    pub(super) fn place(&self, (x, y): (f64, f64)) -> Place {
        let Frame { left, right, bottom, .. } = self.frame;
        (left + (right - left) * self.x.share(x), bottom - (bottom - self.top()) * self.y.share(y))
    }

    /// Where a point of the zone stands, at a share of its height.
    pub(super) fn place_in_zone(&self, x: f64, share: f64) -> Place {
        (self.place((x, 0.0)).0, self.frame.top + ZONE * self.text * (0.9 - 0.8 * share))
    }

    /// A text beside a place.
    pub(super) fn words(&self, text: &str, at: Place, anchor: (Across, Down), colour: Colour) -> Words {
        Words { at, text: text.to_owned(), size: self.text, colour, anchor, upwards: false }
    }

    fn grid(&self) -> Pen {
        Pen::new(INK.pale(0.12), self.text / 16.0)
    }

    fn line(&self) -> Pen {
        Pen::new(INK.pale(0.6), self.text / 16.0)
    }

    /// The zone stands apart from the axis: what is in it has no number.
    fn draw_zone(&self, picture: &mut Picture) {
        let Some(name) = self.y.zone() else { return };
        let Frame { left, right, top, .. } = self.frame;
        picture.block([(left, top), (right, top + ZONE * self.text)], COLLAPSE.pale(0.09));
        let at = (left - self.text / 3.0, top + 0.5 * ZONE * self.text);
        let words = self.words(name, at, (Across::End, Down::Middle), COLLAPSE);
        picture.text(Words { size: 0.85 * self.text, ..words });
    }

    fn draw_y_axis(&self, picture: &mut Picture) {
        let (Frame { left, right, bottom, .. }, top, text) = (self.frame, self.top(), self.text);
        for (value, name) in self.y.ticks(self.ticks.y) {
            let y = self.place((0.0, value)).1;
            picture.path(vec![(left, y), (right, y)], self.grid());
            picture.text(self.words(&name, (left - text / 3.0, y), (Across::End, Down::Middle), INK));
        }
        picture.path(vec![(left, top), (left, bottom)], self.line());
        let middle = (top + bottom) / 2.0;
        if self.y.is_unmarked() {
            let at = (left - text / 2.0, middle);
            picture.text(self.words(&self.y.label, at, (Across::End, Down::Middle), INK));
        } else {
            let at = (text / 4.0, middle);
            let words = self.words(&self.y.label, at, (Across::Middle, Down::Top), INK);
            picture.text(Words { upwards: true, ..words });
        }
    }

    fn draw_x_axis(&self, picture: &mut Picture) {
        let (Frame { left, right, bottom, .. }, text) = (self.frame, self.text);
        picture.path(vec![(left, bottom), (right, bottom)], self.line());
        let Some(most) = self.ticks.x else { return };
        for (value, name) in self.x.ticks(most) {
            let x = self.place((value, 0.0)).0;
            picture.path(vec![(x, bottom), (x, bottom + text / 4.0)], self.line());
            // A long number at the end of the axis would be cut by the edge of the picture.
            let half = 0.3 * text * name.chars().count() as f64;
            let middle = x.min(right + BESIDE * text - half);
            picture.text(self.words(&name, (middle, bottom + text / 2.0), (Across::Middle, Down::Top), INK));
        }
        let at = ((left + right) / 2.0, bottom + 1.75 * text);
        picture.text(self.words(&self.x.label, at, (Across::Middle, Down::Top), INK));
    }
}

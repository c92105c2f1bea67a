//! A picture: shapes in the order they are drawn, and places that show a value under the pointer.

use super::colours::Colour;

/// A place in a picture: to the right and downwards from its upper left corner, units of the picture.
pub type Place = (f64, f64);

/// Colour and opacity of what is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ink {
    /// Colour.
    pub colour: Colour,
    /// 1 hides what is below, 0 is not seen.
    pub opacity: f64,
}

impl From<Colour> for Ink {
    fn from(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }
}

impl Colour {
    /// The colour, seen through.
    pub fn pale(self, opacity: f64) -> Ink {
        Ink { colour: self, opacity }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour and opacity.
    pub ink: Ink,
    /// Width.
    pub width: f64,
    /// Lengths of dash and gap; `None` for a whole line.
    pub dash: Option<[f64; 2]>,
}

impl Pen {
    /// A whole line.
    pub fn new(ink: impl Into<Ink>, width: f64) -> Self {
        Self { ink: ink.into(), width, dash: None }
    }

    /// A dashed line.
    pub fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }
}

/// Which part of a text stands at its place, from left to right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// Which part of a text stands at its place, from above to below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Down {
    /// Its top.
    Top,
    /// Its middle.
    Middle,
}

/// A text at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// Where.
    pub at: Place,
    /// The text.
    pub text: String,
    /// Height of its letters.
    pub size: f64,
    /// Colour.
    pub colour: Colour,
    /// What of it stands at the place.
    pub anchor: (Across, Down),
    /// Whether it runs upwards.
    pub upwards: bool,
}

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Lines from point to point.
    Path { points: Vec<Place>, pen: Pen },
    /// The area within a closed line.
    Area { points: Vec<Place>, ink: Ink },
    /// The area between two corners.
    Block { corners: [Place; 2], ink: Ink },
    /// A disc.
    Disc { at: Place, radius: f64, ink: Ink },
    /// A text.
    Text(Words),
}

/// A place that shows a value under the pointer.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    /// Where.
    pub at: Place,
    /// What it shows, lines apart by `\n`.
    pub tip: String,
    /// Colour of its curve: the legend picks curves by it.
    pub colour: Colour,
}

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height in units of its own.
    pub size: (u32, u32),
    /// What a screen reader says.
    pub label: String,
    /// What is drawn, the last on top.
    pub shapes: Vec<Shape>,
    /// Places with values.
    pub hits: Vec<Hit>,
    /// Attributes of the root element, for the script.
    pub attributes: Vec<(&'static str, String)>,
}

impl Picture {
    /// An empty picture.
    pub fn new(size: (u32, u32), label: String) -> Self {
        Self { size, label, shapes: Vec::new(), hits: Vec::new(), attributes: Vec::new() }
    }

    /// Lines from point to point.
    pub fn path(&mut self, points: Vec<Place>, pen: Pen) {
        if !points.is_empty() {
            self.shapes.push(Shape::Path { points, pen });
        }
    }

    /// The area between two corners.
    pub fn block(&mut self, corners: [Place; 2], ink: impl Into<Ink>) {
        self.shapes.push(Shape::Block { corners, ink: ink.into() });
    }

    /// A text.
    pub fn text(&mut self, words: Words) {
        if !words.text.is_empty() {
            self.shapes.push(Shape::Text(words));
        }
    }
}

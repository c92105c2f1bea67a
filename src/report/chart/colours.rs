//! Colours that colour-blind people tell apart, and marks that tell curves apart without colour.

/// A colour: red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

impl Colour {
    /// As SVG has it: the script finds the elements of a curve by it.
    pub fn hex(self) -> String {
        format!("#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

/// Blue, vermilion, green, purple, orange, sky blue, dark grey: the palette of Okabe and Ito (2008), its yellow and
/// black left out, the one too pale on white and the other kept for text.
pub const PALETTE: [Colour; 7] = [
    Colour(0x00, 0x72, 0xB2),
    Colour(0xD5, 0x5E, 0x00),
    Colour(0x00, 0x9E, 0x73),
    Colour(0xCC, 0x79, 0xA7),
    Colour(0xE6, 0x9F, 0x00),
    Colour(0x56, 0xB4, 0xE9),
    Colour(0x55, 0x55, 0x55),
];

/// Collapse, wherever it is drawn.
pub const COLLAPSE: Colour = Colour(0xA5, 0x0F, 0x15);

/// Paper, and what is hollow.
pub const WHITE: Colour = Colour(0xFF, 0xFF, 0xFF);

/// Axes and text.
pub const INK: Colour = Colour(0x22, 0x22, 0x22);

/// Colours of the contact states by `Contact::index`: rest pale, then purple, green, grey and ochre for 1 to 4, none of
/// them a body's blue or vermilion; a dark, b light.
pub const PATTERNS: [Colour; 9] = [
    Colour(0xF0, 0xF0, 0xF0),
    Colour(0x7B, 0x32, 0x94),
    Colour(0x00, 0x87, 0x6C),
    Colour(0x5A, 0x5A, 0x5A),
    Colour(0xA8, 0x79, 0x00),
    Colour(0xC9, 0xA9, 0xD6),
    Colour(0x8F, 0xD0, 0xBD),
    Colour(0xB8, 0xB8, 0xB8),
    Colour(0xF0, 0xD9, 0x8A),
];

/// Shape of the points of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mark {
    /// A disc.
    Circle,
    /// A square.
    Square,
    /// A triangle.
    Triangle,
    /// No point: a line or a surface.
    None,
}

/// Colour and mark of the `index`-th curve of a figure.
pub fn of_curve(index: usize) -> (Colour, Mark) {
    let marks = [Mark::Circle, Mark::Square, Mark::Triangle];
    (PALETTE[index % PALETTE.len()], marks[index % marks.len()])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness after Rec. 709, 0 to 255.
    fn lightness(c: Colour) -> f64 {
        0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2)
    }

    #[test]
    fn regress_a_and_b_of_a_pattern_differ_in_grey_too() {
        for a in 1..=4 {
            assert!(lightness(PATTERNS[a + 4]) - lightness(PATTERNS[a]) > 50.0, "pattern {a}");
        }
    }

    #[test]
    fn regress_no_two_curves_of_a_figure_look_alike() {
        let looks: Vec<_> = (0..PALETTE.len()).map(of_curve).collect();
        for (i, look) in looks.iter().enumerate() {
            assert!(!looks[..i].contains(look));
        }
    }
}

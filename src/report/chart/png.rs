//! A picture as pixels.
//!
//! The four chunks of a PNG are written here, over libraries that are in the tree already.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::picture::{Across, Down, Ink, Pen, Picture, Place, Shape, Words};
use crate::error::{Error, Result};

/// Bytes of a pixel: red, green, blue.
const CHANNELS: usize = 3;
/// The font's height of a line over the size of its letters: plotters takes the one, SVG the other.
const LINE_OVER_LETTERS: f64 = 1.24;

type Canvas<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Drawn =
    std::result::Result<(), DrawingAreaErrorKind<<BitMapBackend<'static> as DrawingBackend>::ErrorType>>;

impl Picture {
    /// The picture as PNG, one pixel a unit.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if plotters refuses.
    pub fn png(&self) -> Result<Vec<u8>> {
        register_font()?;
        let (width, height) = self.size;
        // White.
        let mut pixels = vec![0xFF; width as usize * height as usize * CHANNELS];
        {
            let canvas = BitMapBackend::with_buffer(&mut pixels, self.size).into_drawing_area();
            self.shapes.iter().try_for_each(|shape| draw(&canvas, shape)).map_err(failed)?;
            canvas.present().map_err(failed)?;
        }
        encoded(&pixels, width, height).map_err(failed)
    }
}

fn failed(error: impl std::fmt::Display) -> Error {
    Error::Picture { message: error.to_string() }
}

/// A font of our own: machines without any draw the same.
fn register_font() -> Result<()> {
    static FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");
    let refused = |_| Error::Picture { message: "the font of the program is none".into() };
    plotters::style::register_font("sans-serif", FontStyle::Normal, FONT).map_err(refused)
}

fn pixel((x, y): Place) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

fn rgba(Ink { colour, opacity }: Ink) -> RGBAColor {
    RGBColor(colour.0, colour.1, colour.2).mix(opacity)
}

fn draw(canvas: &Canvas, shape: &Shape) -> Drawn {
    match shape {
        Shape::Path { points, pen } => draw_path(canvas, points, pen),
        Shape::Area { points, ink } => {
            let outline: Vec<_> = points.iter().copied().map(pixel).collect();
            canvas.draw(&Polygon::new(outline, rgba(*ink).filled()))
        }
        Shape::Block { corners, ink } => {
            canvas.draw(&Rectangle::new(corners.map(pixel), rgba(*ink).filled()))
        }
        Shape::Disc { at, radius, ink } => {
            canvas.draw(&Circle::new(pixel(*at), *radius, rgba(*ink).filled()))
        }
        Shape::Text(words) => draw_text(canvas, words),
    }
}

fn draw_path(canvas: &Canvas, points: &[Place], Pen { ink, width, dash }: &Pen) -> Drawn {
    let path: Vec<_> = points.iter().copied().map(pixel).collect();
    let style = rgba(*ink).stroke_width(width.round().max(1.0) as u32);
    match dash {
        Some([dash, gap]) => {
            canvas.draw(&DashedPathElement::new(path, dash.round() as i32, gap.round() as i32, style))
        }
        None => canvas.draw(&PathElement::new(path, style)),
    }
}

fn draw_text(canvas: &Canvas, words: &Words) -> Drawn {
    let across = match words.anchor.0 {
        Across::Start => HPos::Left,
        Across::Middle => HPos::Center,
        Across::End => HPos::Right,
    };
    let down = match words.anchor.1 {
        Down::Top => VPos::Top,
        Down::Middle => VPos::Center,
    };
    let font = ("sans-serif", words.size * LINE_OVER_LETTERS).into_font();
    let font = if words.upwards { font.transform(FontTransform::Rotate270) } else { font };
    let style = font.color(&rgba(words.colour.into())).pos(Pos::new(across, down));
    canvas.draw(&Text::new(words.text.as_str(), pixel(words.at), style))
}
/// Pixels as PNG (ISO/IEC 15948): eight bits a channel, no filter, no interlacing.
fn encoded(pixels: &[u8], width: u32, height: u32) -> io::Result<Vec<u8>> {
    const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
    const EIGHT_BITS_RGB: [u8; 5] = [8, 2, 0, 0, 0];
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &EIGHT_BITS_RGB].concat();
    let mut rows = ZlibEncoder::new(Vec::new(), Compression::default());
    for row in pixels.chunks(width as usize * CHANNELS) {
        rows.write_all(&[0])?;
        rows.write_all(row)?;
    }
    let mut bytes = SIGNATURE.to_vec();
    chunk(&mut bytes, b"IHDR", &header);
    chunk(&mut bytes, b"IDAT", &rows.finish()?);
    chunk(&mut bytes, b"IEND", &[]);
    Ok(bytes)
}

/// Length, name, contents, and the checksum of name and contents.
fn chunk(bytes: &mut Vec<u8>, name: &[u8; 4], contents: &[u8]) {
    // A picture is far smaller than 4 GiB.
    bytes.extend((contents.len() as u32).to_be_bytes());
    let from = bytes.len();
    bytes.extend(name);
    bytes.extend(contents);
    let checksum = crc32fast::hash(&bytes[from..]);
    bytes.extend(checksum.to_be_bytes());
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::super::colours::COLLAPSE;
    use super::*;

    #[test]
    fn analytic_a_png_holds_its_pixels() {
        let mut picture = Picture::new((4, 2), String::new());
        // One unit wide and high is one pixel.
        picture.block([(1.0, 0.0), (2.0, 1.0)], COLLAPSE);
        let bytes = picture.png().expect("drawn");
        // Signature, then IHDR with the size; the checksum of an empty IEND is known.
        assert_eq!(&bytes[..16], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
        assert_eq!(&bytes[16..24], &[0, 0, 0, 4, 0, 0, 0, 2]);
        assert!(bytes.ends_with(b"IEND\xaeB`\x82"));
        let data = bytes.windows(4).position(|four| four == b"IDAT").expect("data") + 4;
        let mut rows = Vec::new();
        flate2::read::ZlibDecoder::new(&bytes[data..]).read_to_end(&mut rows).expect("zlib");
        let (white, red) = ([0xFF; 3], [COLLAPSE.0, COLLAPSE.1, COLLAPSE.2]);
        assert_eq!(rows, [&[0][..], &white, &red, &white, &white, &[0], &[0xFF; 12]].concat());
    }
}

//! A drawing of plotters made into PNG.
//!
//! The four chunks of a PNG are written here: deflate and a checksum are all that they need of other libraries.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::svg::{Drawn, Told, failed, register_font};
use crate::error::Result;

/// Bytes of a pixel: red, green, blue.
const CHANNELS: usize = 3;

/// Draws into PNG of this size in pixels.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn png<F>((width, height): (u32, u32), draw: F) -> Result<Vec<u8>>
where
    F: for<'a> FnOnce(&DrawingArea<BitMapBackend<'a>, Shift>) -> Drawn<Told, BitMapBackend<'a>>,
{
    register_font()?;
    // White.
    let mut pixels = vec![0xFF; width as usize * height as usize * CHANNELS];
    {
        let root = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        draw(&root).map_err(failed)?;
        root.present().map_err(failed)?;
    }
    encoded(&pixels, width, height).map_err(failed)
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

    use super::*;

    #[test]
    fn analytic_a_png_holds_its_pixels() {
        let bytes = png((4, 2), |area| {
            area.draw(&Pixel::new((1, 0), RED))?;
            Ok(Told::default())
        });
        let bytes = bytes.expect("drawn");
        // Signature, then IHDR with the size; the checksum of an empty IEND is known.
        assert_eq!(&bytes[..16], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR");
        assert_eq!(&bytes[16..24], &[0, 0, 0, 4, 0, 0, 0, 2]);
        assert!(bytes.ends_with(b"IEND\xaeB`\x82"));
        let data = bytes.windows(4).position(|four| four == b"IDAT").expect("data") + 4;
        let mut rows = Vec::new();
        flate2::read::ZlibDecoder::new(&bytes[data..]).read_to_end(&mut rows).expect("zlib");
        let white = [0xFF; 3];
        assert_eq!(rows, [&[0][..], &white, &[0xFF, 0, 0], &white, &white, &[0], &[0xFF; 12]].concat());
    }
}

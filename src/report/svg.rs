//! A drawing of plotters made into SVG that scales with the page and tells values to the script.

use std::fmt::{Debug, Display, Write};

use plotters::coord::Shift;
use plotters::prelude::*;

use super::page::escaped;
use crate::error::{Error, Result};

/// What plotters gives.
pub type Drawn<T, DB> = std::result::Result<T, DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// A place of a drawing that has something to tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    /// Place, units of the drawing.
    pub at: (i32, i32),
    /// What it tells, lines apart by `\n`.
    pub tip: String,
    /// Colour of its curve, as in the SVG.
    pub colour: String,
}

/// What a drawing tells about itself: places with values, and attributes for the script.
#[derive(Debug, Default)]
pub struct Told {
    /// Places with values.
    pub hits: Vec<Hit>,
    /// Attributes of the root element.
    pub attributes: Vec<(&'static str, String)>,
}

/// Draws into SVG of this size in its own units; `label` is what a screen reader says.
///
/// # Errors
/// [`Error::Picture`] if plotters refuses.
pub fn svg<F>(size: (u32, u32), label: &str, draw: F) -> Result<String>
where
    F: FnOnce(
        &DrawingArea<SVGBackend, Shift>,
    ) -> std::result::Result<Told, DrawingAreaErrorKind<std::io::Error>>,
{
    register_font()?;
    let mut text = String::new();
    let told = {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let told = draw(&root).map_err(failed)?;
        root.present().map_err(failed)?;
        told
    };
    Ok(dressed(&text, size, label, &told))
}

/// The font of pixels, by which plotters measures text of SVG too; machines without any font draw the same.
pub(super) fn register_font() -> Result<()> {
    static FONT: &[u8] = include_bytes!("fonts/DejaVuSans.ttf");
    let refused = |_| Error::Picture { message: "the font of the program is none".into() };
    plotters::style::register_font("sans-serif", FontStyle::Normal, FONT).map_err(refused)
}

/// What plotters said.
pub fn failed(error: impl Display + Debug) -> Error {
    Error::Picture { message: error.to_string() }
}

/// The drawing with a root element that scales, a label, and the places that tell values on top.
fn dressed(text: &str, (width, height): (u32, u32), label: &str, told: &Told) -> String {
    let body = text.split_once('>').map_or("", |(_, body)| body);
    let body = body.trim_end().strip_suffix("</svg>").unwrap_or(body);
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{}""#,
        escaped(label)
    );
    for (name, value) in &told.attributes {
        // Writing to a String cannot fail; the same holds below.
        let _ = write!(svg, r#" {name}="{}""#, escaped(value));
    }
    svg.push_str(">\n<rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>");
    svg.push_str(body);
    if !told.hits.is_empty() {
        svg.push_str("<g class=\"hits\" fill=\"transparent\">\n");
        for Hit { at: (x, y), tip, colour } in &told.hits {
            let (tip, colour) = (escaped(tip), escaped(colour));
            let _ = writeln!(
                svg,
                r#"<circle cx="{x}" cy="{y}" r="11" data-colour="{colour}"><title>{tip}</title></circle>"#
            );
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_a_drawing_scales_and_its_values_are_escaped() {
        let told = || Told {
            hits: vec![Hit { at: (3, 4), tip: "a < b & \"c\"".into(), colour: "#0072B2".into() }],
            attributes: vec![("data-x0", "1".into())],
        };
        let text = svg((100, 50), "a <label>", |area| {
            area.draw(&Circle::new((10, 10), 3, BLUE))?;
            Ok(told())
        });
        let text = text.expect("drawn");
        assert!(text.starts_with("<svg xmlns") && text.ends_with("</svg>\n"));
        assert!(text.contains(r#"viewBox="0 0 100 50""#) && text.contains(r#"data-x0="1""#));
        assert!(text.contains("a &lt;label&gt;") && text.contains("a &lt; b &amp; &quot;c&quot;"));
        assert_eq!(text.matches("<circle").count(), 2);
        assert_eq!(text.matches("</svg>").count(), 1);
    }
}

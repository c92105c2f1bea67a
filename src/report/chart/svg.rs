//! A picture as SVG that scales with the page and holds values for the script.

use std::fmt::Write;

use super::picture::{Across, Down, Hit, Ink, Pen, Picture, Place, Shape, Words};
use crate::text::escaped;

/// Radius of a place under the pointer, units of the picture.
const REACH: u32 = 11;

impl Picture {
    /// The picture as SVG that stands alone.
    pub fn svg(&self) -> String {
        let (width, height) = self.size;
        let mut svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" font-family="sans-serif" aria-label="{}""#,
            escaped(&self.label)
        );
        for (name, value) in &self.attributes {
            // Writing to a `String` cannot fail; the same holds below.
            let _ = write!(svg, r#" {name}="{}""#, escaped(value));
        }
        svg.push_str(">\n<rect width=\"100%\" height=\"100%\" fill=\"#FFFFFF\"/>\n");
        for shape in &self.shapes {
            svg.push_str(&element(shape));
        }
        if !self.hits.is_empty() {
            svg.push_str("<g class=\"hits\" fill=\"transparent\">\n");
            self.hits.iter().for_each(|hit| svg.push_str(&place_with_value(hit)));
            svg.push_str("</g>\n");
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn place_with_value(hit: &Hit) -> String {
    let ((x, y), colour, tip) = (texts(hit.at), hit.colour.hex(), escaped(&hit.tip));
    format!(
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"{REACH}\" data-colour=\"{colour}\"><title>{tip}</title></circle>\n"
    )
}

/// A length to a tenth of a unit, which is finer than a pixel.
fn length(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn texts((x, y): Place) -> (String, String) {
    (length(x), length(y))
}

fn points(places: &[Place]) -> String {
    let pair = |place: &Place| {
        let (x, y) = texts(*place);
        format!("{x},{y}")
    };
    places.iter().map(pair).collect::<Vec<_>>().join(" ")
}

fn fill(ink: &Ink) -> String {
    paint("fill", ink)
}

fn paint(what: &str, Ink { colour, opacity }: &Ink) -> String {
    let colour = colour.hex();
    if *opacity < 1.0 {
        format!(r#"{what}="{colour}" {what}-opacity="{opacity}""#)
    } else {
        format!(r#"{what}="{colour}""#)
    }
}

fn stroke(Pen { ink, width, dash }: &Pen) -> String {
    let dash = dash.map_or(String::new(), |[dash, gap]| {
        format!(r#" stroke-dasharray="{} {}""#, length(dash), length(gap))
    });
    format!(
        r#"fill="none" {} stroke-width="{}" stroke-linejoin="round"{dash}"#,
        paint("stroke", ink),
        length(*width)
    )
}

fn element(shape: &Shape) -> String {
    match shape {
        Shape::Path { points: places, pen } => {
            format!("<polyline points=\"{}\" {}/>\n", points(places), stroke(pen))
        }
        Shape::Area { points: places, ink } => {
            format!("<polygon points=\"{}\" {}/>\n", points(places), fill(ink))
        }
        Shape::Block { corners: [a, b], ink } => {
            let (x, y) = texts((a.0.min(b.0), a.1.min(b.1)));
            let (width, height) = texts(((a.0 - b.0).abs(), (a.1 - b.1).abs()));
            format!(r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" {}/>"#, fill(ink)) + "\n"
        }
        Shape::Disc { at, radius, ink } => {
            let (x, y) = texts(*at);
            format!(r#"<circle cx="{x}" cy="{y}" r="{}" {}/>"#, length(*radius), fill(ink)) + "\n"
        }
        Shape::Text(words) => text(words),
    }
}

fn text(Words { at, text, size, colour, anchor: (across, down), upwards }: &Words) -> String {
    let (x, y) = texts(*at);
    let anchor = match across {
        Across::Start => "start",
        Across::Middle => "middle",
        Across::End => "end",
    };
    let lowered = match down {
        Down::Top => "0.76em",
        Down::Middle => "0.5ex",
    };
    let turned = if *upwards { format!(r#" transform="rotate(270 {x} {y})""#) } else { String::new() };
    format!(
        "<text x=\"{x}\" y=\"{y}\" dy=\"{lowered}\" text-anchor=\"{anchor}\" font-size=\"{}\" fill=\"{}\"{turned}>{}</text>\n",
        length(*size),
        colour.hex(),
        escaped(text)
    )
}

#[cfg(test)]
mod tests {
    use super::super::colours::{COLLAPSE, PALETTE};
    use super::*;

    #[test]
    fn regress_a_picture_scales_and_its_texts_are_escaped() {
        let mut picture = Picture::new((100, 50), "a <label>".into());
        picture.attributes.push(("data-left", "1".into()));
        picture.shapes.push(Shape::Disc { at: (10.0, 10.25), radius: 3.0, ink: PALETTE[0].into() });
        picture.hits.push(Hit { at: (3.0, 4.0), tip: "a < b & \"c\"".into(), colour: COLLAPSE });
        let svg = picture.svg();
        assert!(svg.starts_with("<svg xmlns") && svg.ends_with("</svg>\n"));
        assert!(svg.contains(r#"viewBox="0 0 100 50""#) && svg.contains(r#"data-left="1""#));
        assert!(svg.contains("a &lt;label&gt;") && svg.contains("a &lt; b &amp; &quot;c&quot;"));
        assert!(svg.contains(r#"cy="10.2""#) && svg.matches("<circle").count() == 2);
    }

    #[test]
    fn analytic_lengths_have_no_idle_digits() {
        assert_eq!([0.0, -0.04, 3.0, 3.12, -2.5].map(length), ["0", "0", "3", "3.1", "-2.5"]);
    }
}

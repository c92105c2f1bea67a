//! A wall at rest, drawn from the side: bodies, crack, corners, what is at the top.

use std::fmt::Write;

use mrbd_files::description::Description;
use mrbd_kernel::model::Wall;

/// Height of the wall in the drawing, its own units.
const HEIGHT: f64 = 400.0;
/// Room left and right of the wall: labels of two numbers stand left of it.
const MARGIN: f64 = 140.0;
/// Room above it.
const ABOVE: f64 = 60.0;
/// Room below the wall.
const BELOW: f64 = 40.0;
/// Radius of a corner's mark, and its colour.
const CORNER: (f64, &str) = (3.5, "#d55e00");
/// Colours of line and masonry.
const INK: &str = "#333";
const MASONRY: &str = "#e9ddcf";
/// Teeth of the spring.
const TEETH: u8 = 6;

/// Places of the drawing.
struct Scale {
    /// Units of the drawing a metre.
    per_m: f64,
    /// The middle of the wall.
    middle: f64,
    /// The ground.
    ground: f64,
}

impl Scale {
    fn x(&self, x_m: f64) -> f64 {
        self.middle + x_m * self.per_m
    }

    fn y(&self, y_m: f64) -> f64 {
        self.ground - y_m * self.per_m
    }
}

/// The wall as SVG, to scale.
pub fn wall_svg(wall: &Wall, d: &Description) -> String {
    let per_m = HEIGHT / d.height_m;
    let (width, height) = (2.0 * MARGIN + d.thickness_m * per_m, HEIGHT + ABOVE + BELOW);
    let scale = Scale { per_m, middle: width / 2.0, ground: height - BELOW };
    let mut parts = vec![masonry(&scale, d)];
    parts.extend(joint(&scale, 0.0, d.lower.width_m));
    parts.extend(d.upper.iter().flat_map(|upper| joint(&scale, d.lower.height_m, upper.width_m)));
    parts.push(top(&scale, wall, d));
    parts.push(labels(&scale, d));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"11\" fill=\"{INK}\" stroke-width=\"1\" role=\"img\" \
         aria-label=\"the wall at rest, to scale\">\n{}\n</svg>\n",
        parts.join("\n")
    )
}

fn masonry(scale: &Scale, d: &Description) -> String {
    let (left, right, top) =
        (scale.x(-d.thickness_m / 2.0), scale.x(d.thickness_m / 2.0), scale.y(d.height_m));
    let (width, height, ground) = (right - left, scale.ground - top, scale.ground);
    let [from, to] = [left - MARGIN / 2.0, right + MARGIN / 2.0];
    format!(
        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{MASONRY}\" \
         stroke=\"{INK}\"/>\n<path d=\"M{from:.1} {ground:.1}H{to:.1}\" stroke=\"{INK}\" stroke-width=\"2\"/>"
    )
}

/// The line of a joint through the wall, and the corners it rocks about.
fn joint(scale: &Scale, height_m: f64, width_m: f64) -> [String; 3] {
    let [left, right] = [-0.5, 0.5].map(|side| scale.x(side * width_m));
    let (y, (radius, colour)) = (scale.y(height_m), CORNER);
    let corner = |x: f64| format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>");
    [format!("<path d=\"M{left:.1} {y:.1}H{right:.1}\" stroke=\"{colour}\"/>"), corner(left), corner(right)]
}

/// The top masses as a block, and the spring between them and a support.
fn top(scale: &Scale, wall: &Wall, d: &Description) -> String {
    let (x, y) = (scale.x(wall.parameters().eccentricity_m), scale.y(d.height_m));
    let mut text = String::new();
    if d.top.mass_kg + d.top.carriage_mass_kg > 0.0 {
        let (left, upper) = (x - 14.0, y - 20.0);
        text = format!(
            "<rect x=\"{left:.1}\" y=\"{upper:.1}\" width=\"28\" height=\"20\" fill=\"#9ab\" stroke=\"{INK}\"/>\n"
        );
    }
    if d.top.stiffness_n_per_m > 0.0 {
        let mut path = format!("M{:.1} {:.1}h8", x + 14.0, y - 10.0);
        for tooth in 0..TEETH {
            let up = if tooth % 2 == 0 { "-6" } else { "6" };
            // Writing to a String cannot fail.
            let _ = write!(path, "l3 {up}l3 {}", if tooth % 2 == 0 { "6" } else { "-6" });
        }
        path += "h8m0 -12v24";
        let _ = write!(text, "<path d=\"{path}\" fill=\"none\" stroke=\"{INK}\"/>");
    }
    text
}

fn labels(scale: &Scale, d: &Description) -> String {
    let mut lines =
        vec![(0.0, format!("b₁ {:.3} m", d.lower.width_m)), (d.height_m, format!("h {:.3} m", d.height_m))];
    if let Some(upper) = d.upper {
        lines.push((d.lower.height_m, format!("h₁ {:.3} m, b₂ {:.3} m", d.lower.height_m, upper.width_m)));
    }
    let right = scale.x(-d.thickness_m / 2.0) - 8.0;
    let text = |(height_m, words): (f64, String)| {
        format!(
            "<text x=\"{right:.1}\" y=\"{:.1}\" text-anchor=\"end\">{words}</text>",
            scale.y(height_m) - 4.0
        )
    };
    let beside = lines.into_iter().map(text).collect::<Vec<_>>().join("\n");
    let (x, y) = (scale.middle, scale.ground + 24.0);
    let below = format!("b {:.3} m, h/b {:.1}", d.thickness_m, d.slenderness);
    format!("{beside}\n<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{below}</text>")
}

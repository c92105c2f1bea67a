//! The mechanism that governs, drawn: bodies turned about their corners, weights and what pushes.

use std::fmt::Write;

use super::words::Words;
use crate::assessment::wall::Assessed;
use mrbd_assessment::{Governing, LIMIT_STATES};

/// Height of the wall in the drawing, its own units.
const HEIGHT: f64 = 420.0;
/// Room at the sides, above and below.
const MARGIN: [f64; 3] = [260.0, 60.0, 40.0];
/// Share of the height by which the point that moves most is drawn away.
const SHOWN: f64 = 0.16;
/// Colours: line, masonry, weights, what pushes.
const INK: &str = "#222222";
const MASONRY: &str = "#e9ddcf";
const WEIGHT: &str = "#0072B2";
const PUSH: &str = "#D55E00";

type Place = [f64; 2];

/// A body: a corner it turns about, its rotation, its outline and its centre, in metres.
struct Body {
    outline: [Place; 4],
    centre: Place,
}

/// The drawing as SVG.
pub fn svg(w: Words, assessed: &Assessed) -> String {
    let p = &assessed.wall;
    let per_m = HEIGHT / p.height_m;
    let (width, height) = (2.0 * MARGIN[0] + p.thickness_m * per_m, HEIGHT + MARGIN[1] + MARGIN[2]);
    let ground = height - MARGIN[2];
    let place = |[x, y]: Place| [width / 2.0 + x * per_m, ground - y * per_m];
    let (bodies, top) = turned(assessed);
    let mut parts = vec![
        format!("<path d=\"M20 {ground:.1}H{:.1}\" stroke=\"{INK}\" stroke-width=\"2\"/>", width - 20.0),
        at_rest(assessed, &place),
    ];
    for (k, body) in bodies.iter().enumerate() {
        parts.push(polygon(&body.outline.map(place), MASONRY));
        parts.push(arrows(place(body.centre), &format!("P{}", k + 1), true));
    }
    if p.diaphragm_mass_kg > 0.0 {
        parts.push(arrows(place(top), "P_C", true));
    }
    if p.carriage_mass_kg > 0.0 {
        let [x, y] = place(top);
        parts.push(arrows([x, y - 18.0], "Q_C", false));
    }
    if p.stiffness_n_per_m > 0.0 {
        let [x, y] = place(top);
        parts.push(format!(
            "<path d=\"M{x:.1} {y:.1}h-60m0 -12v24\" stroke=\"{INK}\" fill=\"none\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">k_d</text>",
            x - 66.0,
            y + 4.0
        ));
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" font-family=\"sans-serif\" font-size=\"14\" \
         fill=\"{INK}\" role=\"img\" aria-label=\"{}\">\n{}\n</svg>\n",
        w.governing(assessed.assessment.mechanism),
        parts.join("\n")
    )
}

/// The bodies turned about their corners as far as the drawing shows, and the top.
fn turned(assessed: &Assessed) -> (Vec<Body>, Place) {
    let p = &assessed.wall;
    let theta = rotations(assessed);
    let h_1 = p.crack_height_m.unwrap_or(p.height_m);
    let half = p.thickness_m / 2.0;
    let sides = [theta[0], theta[1] - theta[0]].map(|phi| if phi < 0.0 { -1.0 } else { 1.0 });
    let [o_x, q_x] = [0, 1].map(|i| sides[i] * p.width_m[i] / 2.0);
    let lower = |[x, y]: Place| {
        let [dx, dy] = rotated([x - o_x, y], theta[0]);
        [o_x + dx, dy]
    };
    let joint = lower([q_x, h_1]);
    let upper = |[x, y]: Place| {
        let [dx, dy] = rotated([x - q_x, y - h_1], theta[1]);
        [joint[0] + dx, joint[1] + dy]
    };
    let outline = |low: f64, high: f64| [[-half, low], [half, low], [half, high], [-half, high]];
    let mut bodies = vec![Body { outline: outline(0.0, h_1).map(lower), centre: lower([0.0, h_1 / 2.0]) }];
    if p.crack_height_m.is_some() {
        let centre = upper([0.0, (h_1 + p.height_m) / 2.0]);
        bodies.push(Body { outline: outline(h_1, p.height_m).map(upper), centre });
    }
    (bodies, upper([p.eccentricity_m, p.height_m]))
}

/// Rotations in the proportion of those at d_SLV, enlarged; towards the side of the fall.
fn rotations(assessed: &Assessed) -> [f64; 2] {
    let capacity = &assessed.assessment.capacity;
    let d_m = LIMIT_STATES[0] * capacity.d_0_m;
    let at = capacity.curve.partition_point(|point| point.d_m < d_m).min(capacity.curve.len() - 1);
    let [theta_1, theta_2] = capacity.curve[at].theta_rad;
    let of_wall = match capacity.mechanism {
        Governing::UpperBody => [0.0, theta_1],
        Governing::OneBlock => [theta_1; 2],
        _ => [theta_1, theta_2],
    };
    let most = of_wall[0].abs().max(of_wall[1].abs());
    let sign = if capacity.towards_positive { 1.0 } else { -1.0 };
    let crack =
        capacity.mechanism == Governing::VerticalBending || capacity.mechanism == Governing::Restrained;
    let shown = if crack { 1.6 * SHOWN } else { SHOWN };
    of_wall.map(|theta| sign * shown * theta / most)
}

fn rotated([x, y]: Place, theta: f64) -> Place {
    let (sin, cos) = theta.sin_cos();
    [x * cos + y * sin, y * cos - x * sin]
}

fn polygon(places: &[Place], fill: &str) -> String {
    let mut points = String::new();
    for [x, y] in places {
        // Writing to a String cannot fail.
        let _ = write!(points, "{x:.1},{y:.1} ");
    }
    format!("<polygon points=\"{}\" fill=\"{fill}\" stroke=\"{INK}\"/>", points.trim_end())
}

/// The wall at rest, by a broken line.
fn at_rest(assessed: &Assessed, place: &impl Fn(Place) -> Place) -> String {
    let p = &assessed.wall;
    let half = p.thickness_m / 2.0;
    let [[left, top], [right, bottom]] = [place([-half, p.height_m]), place([half, 0.0])];
    format!(
        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#999999\" stroke-dasharray=\"6 4\"/>",
        right - left,
        bottom - top
    )
}

/// A weight downwards where there is one, and α times it sideways.
fn arrows([x, y]: Place, name: &str, weight: bool) -> String {
    let head = |x: f64, y: f64, [dx, dy]: [f64; 2], colour: &str| {
        let (bx, by) = (x - 9.0 * dx, y - 9.0 * dy);
        format!(
            "<polygon points=\"{x:.1},{y:.1} {:.1},{:.1} {:.1},{:.1}\" fill=\"{colour}\"/>",
            bx - 4.0 * dy,
            by + 4.0 * dx,
            bx + 4.0 * dy,
            by - 4.0 * dx
        )
    };
    let mut text = String::new();
    if weight {
        let _ = write!(
            text,
            "<path d=\"M{x:.1} {y:.1}v40\" stroke=\"{WEIGHT}\" stroke-width=\"2\"/>{}<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{WEIGHT}\">{name}</text>",
            head(x, y + 44.0, [0.0, 1.0], WEIGHT),
            x + 6.0,
            y + 40.0
        );
    }
    let _ = write!(
        text,
        "<path d=\"M{x:.1} {y:.1}h70\" stroke=\"{PUSH}\" stroke-width=\"2\"/>{}<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{PUSH}\">α {name}</text>",
        head(x + 74.0, y, [1.0, 0.0], PUSH),
        x + 80.0,
        y + 4.0
    );
    text
}

//! Velocities after impacts over those of the model, by change of pattern.

use std::path::Path;

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark};
use super::super::page::{Figure, Link};
use super::columns::Columns;
use super::window_errors::CHANGES;
use super::{AFTER, BEFORE, MEASURED, key};
use crate::error::Result;
use mrbd_lab::diagnose::answer::Summary;

/// Ratios farther from 1 are drawn at the ends of the axis, and ratios nearer do not fill it.
const FARTHEST: f64 = 0.6;
const NEAREST: f64 = 0.1;
/// Ratios less sure than this, as a standard deviation, are left out of the picture.
const SURE: f64 = 0.1;
const BURST: &str = "several impacts";

struct Jump {
    wall: String,
    time_s: f64,
    kind: String,
    ratio: f64,
    sd: f64,
}

fn read(path: &Path) -> Result<Vec<Jump>> {
    let columns = Columns::read(path, &["wall", "time_s", "coefficient", "ratio", "ratio_sd"])?;
    let walls = columns.labels("wall")?;
    let [time_s, coefficient, ratio, sd] =
        ["time_s", "coefficient", "ratio", "ratio_sd"].map(|name| columns.numbers(name));
    let (time_s, coefficient, ratio, sd) = (time_s?, coefficient?, ratio?, sd?);
    let kind = |l: f64| match l.is_finite().then_some(l as usize) {
        Some(l) => CHANGES.get(l.wrapping_sub(1)).map_or(BURST.to_owned(), |c| format!("{c}, C_{l}")),
        None => BURST.to_owned(),
    };
    let jump = |k: usize| Jump {
        wall: walls[k].clone(),
        time_s: time_s[k],
        kind: kind(coefficient[k]),
        ratio: ratio[k],
        sd: sd[k],
    };
    Ok((0..walls.len()).map(jump).filter(|j| j.ratio.is_finite() && j.sd < SURE).collect())
}

/// The figure; none where no impact stands alone.
///
/// # Errors
/// Input errors for a file that is no such table; [`crate::Error::Picture`] if plotters refuses.
pub fn figure(path: &Path, summary: &Summary) -> Result<Option<Figure>> {
    let jumps = read(path)?;
    let mut kinds = jumps.iter().map(|j| j.kind.clone()).collect::<Vec<_>>();
    kinds.sort();
    kinds.dedup();
    if kinds.is_empty() {
        return Ok(None);
    }
    let rows = kinds.len() as f64 - 0.5;
    let one = Layer::Line {
        colour: MEASURED,
        width: 2,
        dashed: true,
        name: String::new(),
        points: vec![(1.0, -0.5), (1.0, rows)],
    };
    let mut layers = vec![one];
    let walls = [("given", BEFORE, Mark::Circle, -0.15), ("updated", AFTER, Mark::Square, 0.15)];
    for (wall, colour, mark, aside) in walls.into_iter().take(1 + usize::from(summary.has_updated_wall())) {
        let own = jumps.iter().filter(|j| j.wall == wall);
        let row = |j: &Jump| kinds.iter().position(|kind| *kind == j.kind).unwrap_or(0) as f64 + aside;
        let dot = |j: &Jump| Dot {
            x: j.ratio,
            y: row(j),
            tip: format!("{}, {:.2} s, wall as {wall}\nratio {:.3} ± {:.3}", j.kind, j.time_s, j.ratio, j.sd),
        };
        let dots = own.clone().map(dot).collect();
        let spans = own.map(|j| [(j.ratio - j.sd, row(j)), (j.ratio + j.sd, row(j))]).collect();
        layers.push(Layer::Spans { colour, width: 1, spans });
        layers.push(Layer::Dots { colour, mark, size: 4, hollow: false, dots });
    }
    let mut legend = vec![key("over the wall as given", BEFORE, Mark::Circle)];
    if summary.has_updated_wall() {
        legend.push(key("over the updated wall", AFTER, Mark::Square));
    }
    let farthest = jumps.iter().map(|j| (j.ratio - 1.0).abs() + j.sd).fold(NEAREST, f64::max).min(FARTHEST);
    let graph = Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::linear("velocity after it, measured over simulated", 1.0 - farthest, 1.0 + farthest),
        y: Axis::names("", kinds),
        layers,
    };
    Ok(Some(Figure {
        id: "jumps".into(),
        title: "Velocities after impacts".into(),
        legend,
        panels: vec![graph.svg()],
        caption: "From the measured state before an impact, or a burst of them, the model is run to where the measured pattern is clear again: 1 is the model’s impact law, C_l included. Bars are standard deviations by the noise of the velocities after it; a force missing meanwhile moves a ratio too. Ratios beyond the axis stand at its ends.".into(),
        links: vec![Link::to("jumps.parquet")],
        ..Figure::default()
    }))
}

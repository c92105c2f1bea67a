//! Where model and tests part: in time, by pattern, by impact.

use std::path::Path;

use super::super::chart::{Axis, Colour, Dot, Format, Graph, Layer, Mark};
use super::super::page::{Figure, Link, Section};
use super::columns::Columns;
use super::{AFTER, BEFORE, key};
use crate::error::Result;
use mrbd_lab::diagnose::answer::Summary;

const NAMES: [&str; 14] = [
    "test",
    "from_s",
    "to_s",
    "pattern",
    "error_before",
    "error_after",
    "impacts_c1",
    "impacts_c2",
    "impacts_c3",
    "impacts_c4",
    "impacts_c5",
    "impacts_c6",
    "impacts_c7",
    "impacts_c8",
];
/// Changes of pattern of Table 2.
pub const CHANGES: [&str; 8] = ["1a→2a", "2a→1a", "1a→2b", "2a→1b", "3a→1b", "3a→3b", "1a→3a", "2a→3a"];
/// Errors below this are drawn at it.
const LEAST: f64 = 0.7;

/// One window in which the wall moves.
struct Window {
    test: String,
    middle_s: f64,
    pattern: String,
    impacts: String,
    error: [f64; 2],
}

/// All of them.
pub struct Windows(Vec<Window>);

impl Windows {
    /// Reads them.
    ///
    /// # Errors
    /// Input errors for a file that is no such table.
    pub fn read(path: &Path) -> Result<Self> {
        let columns = Columns::read(path, &[&NAMES[..], &["impacts_other"]].concat())?;
        let numbers = |name: &str| columns.numbers(name);
        let (tests, patterns) = (columns.labels("test")?, columns.labels("pattern")?);
        let [from, to] = [numbers("from_s")?, numbers("to_s")?];
        let errors = [numbers("error_before")?, numbers("error_after")?];
        let counts = NAMES[6..]
            .iter()
            .chain(&["impacts_other"])
            .map(|name| numbers(name))
            .collect::<Result<Vec<_>>>()?;
        let window = |k: usize| Window {
            test: tests[k].clone(),
            middle_s: 0.5 * (from[k] + to[k]),
            pattern: patterns[k].clone(),
            impacts: impacts(&counts.iter().map(|count| count[k]).collect::<Vec<_>>()),
            error: [errors[0][k], errors[1][k]],
        };
        Ok(Self((0..tests.len()).map(window).collect()))
    }
}

/// The impacts of a window in a few letters.
fn impacts(counts: &[f64]) -> String {
    let total = counts.iter().sum::<f64>();
    match counts.iter().position(|&count| count == 1.0) {
        _ if total == 0.0 => "no impact".into(),
        Some(l) if total == 1.0 => {
            CHANGES.get(l).map_or("another impact".into(), |change| format!("{change}, C_{}", l + 1))
        }
        _ => "several impacts".into(),
    }
}

/// The section, without jumps.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn section(windows: &Windows, summary: &Summary) -> Result<Section> {
    let panels = summary.tests.iter().map(|test| in_time(windows, &test.name, summary));
    let mut legend = vec![key("wall as given", BEFORE, Mark::Circle)];
    if summary.has_updated_wall() {
        legend.push(key("updated wall", AFTER, Mark::Square));
    }
    let figures = vec![
        Figure {
            id: "windows-in-time".into(),
            title: "Error of every window, in time".into(),
            legend: legend.clone(),
            panels: panels.collect::<Result<_>>()?,
            caption: "Root mean square error of a window over the noise: 1 is a perfect model, below the dashed line is noise. A window that is followed badly by the true model too holds an impact that the noise decides.".into(),
            links: vec![Link::to("windows.parquet")],
            ..Figure::default()
        },
        Figure {
            id: "windows-by-kind".into(),
            title: "Error by pattern and by impact".into(),
            legend,
            panels: vec![
                by_kind(windows, summary, "pattern at the start of a window", |w| w.pattern.clone())?,
                by_kind(windows, summary, "impacts in a window", |w| w.impacts.clone())?,
            ],
            caption: "Medians, and from the lower to the upper tenth of the windows. Impacts are those of the updated wall.".into(),
            links: vec![Link::to("windows.parquet")],
            ..Figure::default()
        },
    ];
    Ok(Section { id: "parting".into(), title: "Where they part".into(), figures, ..Section::default() })
}

fn shown(error: f64) -> f64 {
    error.max(LEAST)
}

fn axis(windows: &[&Window]) -> Axis {
    let errors = windows.iter().flat_map(|w| w.error).filter(|e| e.is_finite()).map(shown);
    Axis::log_holding("error over the noise", errors.chain([LEAST, 3.0]))
}

fn noise(from: f64, to: f64, across: bool) -> Layer {
    let points = if across { vec![(from, 1.2), (to, 1.2)] } else { vec![(1.2, from), (1.2, to)] };
    Layer::Line { colour: super::MEASURED, width: 1, dashed: true, name: String::new(), points }
}

fn in_time(windows: &Windows, test: &str, summary: &Summary) -> Result<String> {
    let all = windows.0.iter().collect::<Vec<_>>();
    let own = windows.0.iter().filter(|w| w.test == test).collect::<Vec<_>>();
    let end_s = own.iter().map(|w| w.middle_s).fold(1.0, f64::max) + 0.5;
    let dots = |which: usize, colour: Colour, mark| {
        let dot = |w: &&Window| Dot {
            x: w.middle_s,
            y: shown(w.error[which]),
            tip: format!(
                "{test}, {:.2} s\nfrom pattern {}, {}\nerror {:.2} before, {:.2} after",
                w.middle_s, w.pattern, w.impacts, w.error[0], w.error[1]
            ),
        };
        let dots = own.iter().filter(|w| w.error[which].is_finite()).map(dot).collect();
        Layer::Dots { colour, mark, size: 4, hollow: false, dots }
    };
    let mut layers = vec![noise(0.0, end_s, true), dots(0, BEFORE, Mark::Circle)];
    if summary.has_updated_wall() {
        layers.push(dots(1, AFTER, Mark::Square));
    }
    let x = Axis::linear("time s", 0.0, end_s);
    Ok(Graph { title: test.to_owned(), format: Format::Half, x, y: axis(&all), layers }.svg())
}

fn by_kind(windows: &Windows, summary: &Summary, title: &str, of: fn(&Window) -> String) -> Result<String> {
    let mut kinds = windows.0.iter().map(of).collect::<Vec<_>>();
    kinds.sort();
    kinds.dedup();
    let errors = |kind: &str, which: usize| {
        let own = windows.0.iter().filter(|w| of(w) == kind).map(|w| w.error[which]);
        let mut own = own.filter(|e| e.is_finite()).map(shown).collect::<Vec<_>>();
        own.sort_by(f64::total_cmp);
        own
    };
    let mut layers = vec![noise(-0.5, kinds.len() as f64 - 0.5, false)];
    let both = [(BEFORE, Mark::Circle, -0.13), (AFTER, Mark::Square, 0.13)];
    for (which, (colour, mark, aside)) in
        both.into_iter().enumerate().take(1 + usize::from(summary.has_updated_wall()))
    {
        let (mut spans, mut dots) = (Vec::new(), Vec::new());
        for (row, kind) in (0..).map(f64::from).zip(&kinds) {
            let own = errors(kind, which);
            if own.is_empty() {
                continue;
            }
            let at = |share: f64| own[((own.len() - 1) as f64 * share).round() as usize];
            spans.push([(at(0.1), row + aside), (at(0.9), row + aside)]);
            let tip = format!("{kind}: {} windows\nmedian error {:.2}", own.len(), at(0.5));
            dots.push(Dot { x: at(0.5), y: row + aside, tip });
        }
        layers.push(Layer::Spans { colour, width: 3, spans });
        layers.push(Layer::Dots { colour, mark, size: 6, hollow: false, dots });
    }
    let x = axis(&windows.0.iter().collect::<Vec<_>>());
    Ok(Graph { title: title.to_owned(), format: Format::Half, x, y: Axis::names("", kinds), layers }.svg())
}

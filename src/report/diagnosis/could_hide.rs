//! How large an effect of each kind could still hide.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Link, Section, Table};
use super::words::{number, with_sd};
use super::{MEASURED, key};
use crate::error::Result;
use mrbd_lab::diagnose::answer::{CouldHide, Summary};
use mrbd_lab::diagnose::certainty::Confused;
use mrbd_lab::limits::{DETECTED_SD, WORTH_A_NAME};

/// Shares of a size that matters below and above which nothing is drawn more exactly.
const RANGE: [f64; 2] = [1e-4, 30.0];

/// Most kinds drawn, those that hide best; the others are in the table.
const DRAWN: usize = 14;

/// The section.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn section(summary: &Summary) -> Result<Section> {
    let mut powers = summary.could_hide.iter().filter(|p| p.sd.is_finite() && p.sd > 0.0).collect::<Vec<_>>();
    let share = |p: &CouldHide| p.named_from / p.matters;
    powers.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let blind =
        summary.could_hide.iter().filter(|p| !p.sd.is_finite() || p.sd <= 0.0 || share(p) > 1.0).count();
    let mut text = vec![format!(
        "For every kind, the smallest size that would have been named in these tests, had it been alone: it gains {WORTH_A_NAME} natural logarithms of likelihood, some {:.0} standard deviations. What is smaller may be there all the same, though from {DETECTED_SD} standard deviations on it differs from nothing by more than chance.",
        // An effect gains half of its squared size in standard deviations.
        (2.0 * WORTH_A_NAME).sqrt()
    )];
    if blind > 0 {
        text.push(format!("{blind} of them could hide at a size that matters."));
    }
    let confused = summary.confused.iter().filter(|c| c.told_apart > c.told_from_nothing).collect::<Vec<_>>();
    if !confused.is_empty() {
        text.push("Some are imitated by others, so that only a larger size is told from those; a measurement of another sort tells them by itself.".to_owned());
    }
    let drawn = &powers[..powers.len().min(DRAWN)];
    let figures = if powers.is_empty() { Vec::new() } else { vec![figure(drawn)?] };
    Ok(Section {
        id: "could-hide".into(),
        title: "What could still hide".into(),
        text,
        figures,
        tables: if confused.is_empty() {
            vec![table(&powers)]
        } else {
            vec![table(&powers), pairs(&confused)]
        },
        ..Section::default()
    })
}

fn figure(powers: &[&CouldHide]) -> Result<Figure> {
    let dot = |(row, p): (f64, &&CouldHide)| Dot {
        x: (p.named_from / p.matters).clamp(RANGE[0], RANGE[1]),
        y: row,
        tip: format!("{}\n{} from {} {}", p.name, p.parameter, number(p.named_from), p.unit),
    };
    let dots = (0..).map(f64::from).zip(powers).map(dot).collect::<Vec<_>>();
    let matters = Layer::Line {
        colour: MEASURED,
        width: 2,
        dashed: true,
        name: String::new(),
        points: vec![(1.0, -0.5), (1.0, powers.len() as f64 - 0.5)],
    };
    let x = Axis::log_holding("smallest named over what matters", dots.iter().map(|d| d.x).chain([1.5]));
    let graph = Graph {
        title: String::new(),
        format: Format::Half,
        x,
        y: Axis::names("", powers.iter().map(|p| p.name.clone()).collect()),
        layers: vec![
            matters,
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 7, hollow: false, dots },
        ],
    };
    Ok(Figure {
        id: "could-hide-figure".into(),
        title: "Smallest size that would be named".into(),
        legend: vec![key("smallest size named", PALETTE[0], Mark::Circle)],
        panels: vec![graph.svg()],
        caption: "A size that matters makes a force at the top as large as the floor’s spring at the largest displacement; for gains and factors, joints, corners, delays and offsets the table gives what it is. Right of the dashed line an effect that matters could hide.".into(),
        links: vec![Link::to("diagnosis.json")],
        ..Figure::default()
    })
}

fn pairs(confused: &[&Confused]) -> Table {
    let row = |c: &&Confused| {
        vec![
            c.effect.clone(),
            c.imitated_by.clone(),
            format!("{:.1} %", 100.0 * c.share),
            format!("{} {}", c.parameter, c.unit),
            number(c.told_from_nothing),
            number(c.told_apart),
            number(c.matters),
            c.told_by.clone(),
        ]
    };
    let head = [
        "effect",
        "imitated by",
        "of its trace",
        "by its",
        "told from nothing",
        "told apart",
        "would matter",
        "told by itself by",
    ];
    Table::of("Effects these tests hardly tell apart", &head, confused.iter().map(row))
}

fn table(powers: &[&CouldHide]) -> Table {
    let row = |p: &&CouldHide| {
        vec![
            p.name.clone(),
            format!("{} {}", p.parameter, p.unit),
            number(p.smallest_detectable),
            number(p.named_from),
            with_sd(p.estimate, Some(p.sd)),
            number(p.matters),
        ]
    };
    let head = ["effect", "by its", "told from nothing", "named", "fitted, less nothing", "would matter"];
    Table::of("Sizes", &head, powers.iter().map(row))
}

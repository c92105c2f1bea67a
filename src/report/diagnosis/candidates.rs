//! Everything that was tried, ranked: effects, and beside them numbers of the wall and the placebo.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Link, Section, Table};
use super::words::{at, parameters};
use super::{MEASURED, key};
use crate::error::Result;
use mrbd_lab::diagnose::answer::{Rival, Summary};
use mrbd_lab::limits::EQUIVALENT;

/// Most rows of a figure, and of a table.
const DRAWN: usize = 12;
const LISTED: usize = 25;
/// Colours of errors on tests to fit and held out.
const FIT: usize = 0;
const HELD_OUT: usize = 4;

/// Whether a hypothesis is an answer: an effect, neither a number of the wall nor the placebo.
fn is_effect(rival: &Rival) -> bool {
    rival.name.split(" + ").all(|part| {
        let number = ["wall.", "diaphragm.", "corners."].iter().any(|table| part.starts_with(table));
        !number && part != "placebo"
    })
}

/// The candidates of the catalogue.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn section(summary: &Summary) -> Result<Section> {
    let rivals = summary.rivals.iter().filter(|r| is_effect(r)).collect::<Vec<_>>();
    let text = format!(
        "Every effect of the catalogue, fitted to the tests; the first explains them best. What speaks against a hypothesis is half its squared error beyond noise, bounded window by window, on all tests, with a price for every number: natural logarithms of likelihood. {EQUIVALENT} less than every other is a name. WME is the error of whole runs (Eq. 8), in brackets its range over numbers that fit as well: where that is wide, it says little."
    );
    made(summary, ["candidates", "The candidates, ranked", &text], &rivals)
}

/// What else was tried.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn rivals_section(summary: &Summary) -> Result<Section> {
    let best = summary.rivals.iter().find(|r| is_effect(r));
    let others = summary.rivals.iter().filter(|r| !is_effect(r));
    let mut rivals = best.into_iter().chain(others).collect::<Vec<_>>();
    rivals.sort_by(|a, b| a.against.all.total_cmp(&b.against.all));
    let text = "Beside the best effect: numbers of the wall outside what was known of them, which a wrong drawing or weight would make, and a placebo, a vertical motion made of the record backwards, which shows what a term without meaning gains.";
    made(summary, ["rivals", "Rivals and placebo", text], &rivals)
}

fn made(summary: &Summary, [id, title, text]: [&str; 3], rivals: &[&Rival]) -> Result<Section> {
    let drawn = drawn(&answer(summary, rivals), rivals);
    Ok(Section {
        id: id.to_owned(),
        title: title.to_owned(),
        text: vec![text.to_owned()],
        figures: vec![figure(id, &drawn)?],
        tables: vec![table(rivals)],
        ..Section::default()
    })
}

/// The effects of the answer, or of the best where there is no answer.
fn answer<'s>(summary: &'s Summary, rivals: &[&'s Rival]) -> Vec<&'s str> {
    if summary.has_names() {
        return summary
            .effects
            .iter()
            .filter_map(|e| e.written_as.as_deref().or(e.name.as_deref()))
            .flat_map(|name| name.split(" + "))
            .collect();
    }
    rivals.first().map_or_else(Vec::new, |best| best.name.split(" + ").collect())
}

/// The answer, and what stands against it: that with something added to it is the answer again, and stays in the table.
fn drawn<'r>(answer: &[&str], rivals: &[&'r Rival]) -> Vec<&'r Rival> {
    let more_than_answer = |r: &&&Rival| {
        let parts = r.name.split(" + ").collect::<Vec<_>>();
        parts.len() > answer.len() && answer.iter().all(|part| parts.contains(part))
    };
    rivals.iter().filter(|r| !more_than_answer(r)).take(DRAWN).copied().collect()
}

fn figure(id: &str, rivals: &[&Rival]) -> Result<Figure> {
    let errors = rivals.iter().flat_map(|r| [r.windowed_error.fit, r.windowed_error.held_out]).flatten();
    let rows = rivals.len() as f64 - 0.5;
    let noise = Layer::Line {
        colour: MEASURED,
        width: 2,
        dashed: true,
        name: String::new(),
        points: vec![(1.0, -0.5), (1.0, rows)],
    };
    let mut layers = vec![noise];
    type Of = fn(&Rival) -> Option<f64>;
    let kinds: [(&str, usize, Mark, Of); 2] = [
        ("tests to fit", FIT, Mark::Circle, |r| r.windowed_error.fit),
        ("tests held out", HELD_OUT, Mark::Square, |r| r.windowed_error.held_out),
    ];
    for (what, colour, mark, of) in kinds {
        let dot = |(row, r): (f64, &&Rival)| {
            let x = of(r)?;
            Some(Dot {
                x,
                y: row,
                tip: format!("{}\nerror {x:.2}, {what}\n{}", r.name, parameters(&r.parameters)),
            })
        };
        let dots = (0..).map(f64::from).zip(rivals).filter_map(dot).collect();
        layers.push(Layer::Dots { colour: PALETTE[colour], mark, size: 7, hollow: false, dots });
    }
    let names = || Axis::names("", rivals.iter().map(|r| r.name.clone()).collect());
    let graph = Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::log_holding("error over noise", errors.chain([0.9, 3.0])),
        y: names(),
        layers,
    };
    let least = 1.0;
    let tall = |(row, r): (f64, &&Rival)| Dot {
        x: r.against.all.max(least),
        y: row,
        tip: format!("{}\n{:.1} against it", r.name, r.against.all),
    };
    let dots = (0..).map(f64::from).zip(rivals).map(tall).collect();
    let all = rivals.iter().map(|r| r.against.all.max(least));
    let against = Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::log_holding("ln of likelihood", all),
        y: names(),
        layers: vec![Layer::Dots { colour: PALETTE[2], mark: Mark::Triangle, size: 7, hollow: false, dots }],
    };
    Ok(Figure {
        id: format!("{id}-figure"),
        title: "How well each follows the tests, and what speaks against it".into(),
        legend: vec![
            key("tests to fit", PALETTE[FIT], Mark::Circle),
            key("tests held out", PALETTE[HELD_OUT], Mark::Square),
            key("on all tests", PALETTE[2], Mark::Triangle),
        ],
        panels: vec![graph.svg(), against.svg()],
        caption: "Windowed error in units of the noise; the dashed line is a perfect model. A name needs both near it. What is below 1 against a hypothesis stands at 1. The answer with something added to it stands in the table only.".into(),
        links: vec![Link::to("rivals.parquet")],
        ..Figure::default()
    })
}

/// An error over whole runs, and its range over the ensemble.
fn spread(value: Option<f64>, range: Option<[f64; 2]>) -> String {
    let range = range.map_or(String::new(), |[least, most]| format!(" ({least:.3} to {most:.3})"));
    value.map_or("–".to_owned(), |x| format!("{x:.3}{range}"))
}

fn table(rivals: &[&Rival]) -> Table {
    let row = |r: &&Rival| {
        let text = |x: Option<f64>, digits: usize| x.map_or("–".to_owned(), |x| format!("{x:.digits$}"));
        vec![
            r.name.clone(),
            r.place.as_deref().map_or("–".to_owned(), at),
            parameters(&r.parameters),
            format!("{:.1}", r.against.all),
            text(r.windowed_error.fit, 2),
            text(r.windowed_error.held_out, 2),
            spread(r.wme.fit, r.wme_range.fit),
            spread(r.wme.held_out, r.wme_range.held_out),
        ]
    };
    let head = [
        "added to the wall",
        "where",
        "fitted, ± sd",
        "against it",
        "error, fit",
        "held out",
        "WME, fit",
        "held out",
    ];
    let caption =
        if rivals.len() > LISTED { "The best of them; all are in rivals.parquet" } else { "In order" };
    Table::of(caption, &head, rivals.iter().take(LISTED).map(row))
}

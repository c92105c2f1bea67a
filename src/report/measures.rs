//! The page of intensity measures: how much scatter each leaves, and what explains the rest.

use std::path::Path;

use super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use super::words;
use crate::error::Result;
use crate::sensitivity::measures::{Measures, OfFloor, OfMeasure};

/// The page of a folder of `mrbd measures`.
///
/// # Errors
/// Input errors for files that are none of such measures.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let measures: Measures =
        read_json(&folder.join("measures.json"), "measures as `mrbd measures` writes them")?;
    let figure = Figure {
        id: "efficiency".into(),
        title: "Scatter that remains at a known intensity".into(),
        legend: vec![Key::new("90 % interval over draws of the records", PALETTE[0], Mark::Circle)],
        panels: measures.floors.iter().map(panel).collect(),
        caption: "Standard deviation of ln(θ/α) of one façade from record to record, walls that stood. Less is better.".into(),
        links: vec![Link::to("measures.json")],
        ..Figure::default()
    };
    Ok(Page {
        title: format!("Intensity measures for “{}” under “{}”", measures.study, measures.suite),
        lead: "Which measure of a ground motion foretells how far these façades rotate, and what it leaves to others.".into(),
        numbers: measures.floors.iter().filter_map(number).collect(),
        notes: notes(&note, &measures),
        sections: vec![Section {
            id: "efficiency".into(),
            title: "Efficiency and sufficiency".into(),
            text: vec!["Every façade is compared with itself under other records, so that how façades differ counts neither for a measure nor against it. Concordance: the share of the pairs of runs of a façade, one of which fell, in which that one was shaken the more. p: of the slope of the records’ mean residuals over magnitude, ln distance and ln duration; a small one speaks against the measure.".into()],
            figures: vec![figure],
            tables: measures.floors.iter().map(table).collect(),
            ..Section::default()
        }],
        provenance: note.pairs(),
        files: vec![Link::to("measures.json")],
        ..Page::default()
    })
}

fn number(floor: &OfFloor) -> Option<Number> {
    let best = floor.measures.first()?;
    let meaning = format!(
        "scatter by {}, the least, {} floor",
        words::intensity(&best.measure),
        floor.configuration.name()
    );
    Some(Number::new(format!("{:.2}", best.efficiency), meaning))
}

fn notes(note: &Note, measures: &Measures) -> Vec<String> {
    let told = measures.floors.iter().flat_map(|floor| [best(floor), of_falls(floor)]);
    note.generated_note().into_iter().chain(told.flatten()).collect()
}

/// Which measure tells walls that fall from those that stand.
fn of_falls(floor: &OfFloor) -> Option<String> {
    let told = floor.measures.iter().filter_map(|of| Some((of.concordance?, of)));
    let (concordance, of) = told.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(
        "Falls are told best by {}: right in {:.0} % of the pairs, {} floor.",
        words::intensity(&of.measure),
        (100.0 * concordance).floor(),
        floor.configuration.name()
    ))
}

/// Which measure is the best, or among which nobody can tell.
fn best(floor: &OfFloor) -> Option<String> {
    let mut by_share: Vec<&OfMeasure> = floor.measures.iter().collect();
    by_share.sort_by(|a, b| b.best_share.total_cmp(&a.best_share));
    let told = |of: &&OfMeasure| {
        format!("{} ({:.0} %)", words::intensity(&of.measure), (100.0 * of.best_share).floor())
    };
    let named = by_share.iter().filter(|of| of.best_share >= 0.05).map(told).collect::<Vec<_>>();
    let sure = by_share.first()?.best_share >= 0.9;
    let says =
        if sure { "The best measure" } else { "No measure is the best in 90 % of the draws; among the best" };
    Some(format!("{says} under the {} floor: {}.", floor.configuration.name(), named.join(", ")))
}

fn panel(floor: &OfFloor) -> String {
    let names: Vec<String> = floor.measures.iter().map(|of| words::intensity(&of.measure)).collect();
    let spans = |(place, of): (usize, &OfMeasure)| of.efficiency_interval.map(|end| (end, place as f64));
    let dot = |(place, of): (usize, &OfMeasure)| Dot {
        x: of.efficiency,
        y: place as f64,
        tip: format!(
            "{}\n{:.3}, best in {:.0} % of the draws",
            words::intensity(&of.measure),
            of.efficiency,
            100.0 * of.best_share
        ),
    };
    let all = floor.measures.iter().flat_map(|of| of.efficiency_interval);
    let graph = Graph {
        title: words::floor(floor.configuration).to_owned(),
        format: Format::Half,
        x: Axis::holding("standard deviation of ln(θ/α)", all.chain([0.0])),
        y: Axis::names("", names),
        layers: vec![
            Layer::Spans {
                colour: PALETTE[0],
                width: 3,
                spans: floor.measures.iter().enumerate().map(spans).collect(),
            },
            Layer::Dots {
                colour: PALETTE[0],
                mark: Mark::Circle,
                size: 6,
                hollow: false,
                dots: floor.measures.iter().enumerate().map(dot).collect(),
            },
        ],
    };
    graph.svg()
}

fn table(floor: &OfFloor) -> Table {
    let head = [
        "measure",
        "efficiency",
        "90 %",
        "best",
        "slope",
        "proficiency",
        "concordance",
        "p magnitude",
        "p distance",
        "p duration",
    ];
    let text = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.3}"));
    let row = |of: &OfMeasure| {
        let [low, high] = of.efficiency_interval;
        let told = [
            words::intensity(&of.measure),
            text(Some(of.efficiency)),
            format!("{low:.3} to {high:.3}"),
            format!("{:.0} %", (100.0 * of.best_share).floor()),
            text(Some(of.slope)),
        ];
        let sufficiency = of.sufficiency;
        let p_value = |p: Option<f64>| match p {
            Some(p) if p < 0.001 => "< 0.001".to_owned(),
            p => text(p),
        };
        let explained =
            [sufficiency.magnitude_p, sufficiency.distance_p, sufficiency.duration_p].map(p_value);
        let further = [of.proficiency, of.concordance].map(text);
        told.into_iter().chain(further).chain(explained).collect::<Vec<String>>()
    };
    Table::of(
        &format!("{} floor: {} runs, {} collapsed", floor.configuration.name(), floor.runs, floor.collapsed),
        &head,
        floor.measures.iter().map(row),
    )
}

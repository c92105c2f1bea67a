//! The page of a wall's margin: the factor on each record that takes it beyond a limit, and its fragility.

use std::path::Path;

use super::chart::{Axis, COLLAPSE, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use super::words;
use crate::assessment::margin::{Capacity, Curve, MEASURES, Margin, Status};
use crate::error::Result;
use crate::fragility::LogNormal;

/// Steps of a curve.
const STEPS: u32 = 80;

/// The page of a folder of `mrbd margin`.
///
/// # Errors
/// Input errors for files that are none of a margin; whatever drawing meets.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let margin: Margin = read_json(&folder.join("margin.json"), "a margin as `mrbd margin` writes it")?;
    let panels = margin.fragility.iter().filter_map(|curve| panel(curve, &margin)).collect();
    let figure = Figure {
        id: "fragility-curves".into(),
        title: "Share of the records that take the wall beyond the limit".into(),
        legend: vec![
            Key::new("exceeded", COLLAPSE, Mark::Square),
            Key::new("log-normal", PALETTE[0], Mark::None),
        ],
        panels,
        caption: "Each point is a record at the lowest intensity found to exceed the limit.".into(),
        links: vec![Link::to("margin.parquet")],
        ..Figure::default()
    };
    Ok(Page {
        title: format!("Margin of {} under “{}”", margin.wall, margin.suite),
        lead: format!(
            "The smallest factor on each record, as the suite has it, at which the wall exceeds its limit ({}).",
            margin.limit
        ),
        unfinished: None,
        numbers: numbers(&margin),
        notes: notes(&margin, &note),
        sections: vec![Section {
            id: "margin".into(),
            title: "Margin".into(),
            figures: vec![figure],
            tables: vec![records(&margin), fragility(&margin)],
            ..Section::default()
        }],
        provenance: note.pairs(),
        files: ["margin.json", "margin.parquet"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

/// A measure as people read it; the factor is on a record that the suite may have scaled already.
fn in_words(measure: &str) -> String {
    if measure == "scale" { "factor on the record".to_owned() } else { words::intensity(measure) }
}

fn text(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |value| format!("{value:.3}"))
}

fn numbers(margin: &Margin) -> Vec<Number> {
    let least = margin.records.iter().filter_map(|record| record.scale).reduce(f64::min);
    let median = margin.fragility.first().and_then(|curve| curve.median);
    vec![
        Number::new(text(least), "smallest factor found, over the records"),
        Number::new(text(median), "median factor"),
        Number::new(margin.records.len(), "records"),
    ]
}

fn notes(margin: &Margin, note: &Note) -> Vec<String> {
    let [from, to] = margin.range;
    let mut notes: Vec<String> = note.generated_note().into_iter().collect();
    notes.push(format!(
        "Factors from {from} to {to}, each {} times the one before, narrowed to {}. A wall may stand a larger factor again; the first one found on the way up counts.",
        margin.growth, margin.bracket
    ));
    let of = |status: Status| margin.records.iter().filter(move |record| record.status == status).count();
    for (status, meaning) in [
        (Status::Stood, "did not exceed the limit at the last factor; the curves know no more of them"),
        (Status::Always, "exceed the limit at however small a factor and are left out of the curves"),
        (Status::Failed, "could not be finished and are left out of the curves"),
    ] {
        if of(status) > 0 {
            notes.push(format!("{} records {meaning}.", of(status)));
        }
    }
    let beyond = margin.records.iter().filter(|record| !record.beyond_model.is_empty());
    notes.extend(beyond.map(|record| {
        format!("The model does not apply under {}: {}.", record.record, record.beyond_model.join("; "))
    }));
    notes
}

/// The curve of a measure over the records; `None` where there is none.
fn panel(curve: &Curve, margin: &Margin) -> Option<String> {
    let (_, measure) = MEASURES.iter().find(|(name, _)| *name == curve.measure)?;
    let normal = LogNormal::new(curve.median?.ln(), curve.beta?)?;
    let mut found: Vec<(f64, &Capacity)> = margin
        .records
        .iter()
        .filter(|record| record.status == Status::Exceeded)
        .filter_map(|record| Some((measure(record)?, record)))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [low, high] = [0.01, 0.99].map(|p| normal.intensity_at(p));
    let at = |step: u32| low * (high / low).powf(f64::from(step) / f64::from(STEPS));
    let points = (0..=STEPS).map(at).map(|x| (x, normal.probability_at_ln(x.ln()))).collect();
    let records = margin.records.len() as f64;
    let dot = |(index, (x, record)): (usize, &(f64, &Capacity))| Dot {
        x: *x,
        y: (index + 1) as f64 / records,
        tip: format!(
            "{}\n{} {x:.4}\nensemble beyond the limit: {}",
            record.record,
            in_words(&curve.measure),
            text(record.exceeding_share)
        ),
    };
    let dots = found.iter().enumerate().map(dot).collect();
    let graph = Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::log_holding(
            &in_words(&curve.measure),
            [low, high].into_iter().chain(found.iter().map(|(x, _)| *x)),
        ),
        y: Axis::linear("share of the records", 0.0, 1.0),
        layers: vec![
            Layer::Line { colour: PALETTE[0], width: 3, dashed: false, name: "log-normal".into(), points },
            Layer::Dots { colour: COLLAPSE, mark: Mark::Square, size: 6, hollow: false, dots },
        ],
    };
    Some(graph.svg())
}

fn records(margin: &Margin) -> Table {
    let head = ["record", "search", "factor", "stood at", "PGA, g", "PGV, m/s", "ensemble beyond the limit"];
    let row = |record: &Capacity| {
        let values = [record.scale, record.stood_scale, record.pga_g, record.pgv_m_s, record.exceeding_share];
        let named = [record.record.clone(), record.status.name().to_owned()];
        named.into_iter().chain(values.map(text)).collect::<Vec<String>>()
    };
    Table::of(
        "One row a record; factors are on the record as the suite has it, already scaled",
        &head,
        margin.records.iter().map(row),
    )
}

fn fragility(margin: &Margin) -> Table {
    let head = ["measure", "median", "95 % from", "to", "dispersion", "95 % from", "to"];
    let row = |curve: &Curve| {
        let ([low, high], [narrow, wide]) = (curve.median_interval, curve.beta_interval);
        let values = [curve.median, low, high, curve.beta, narrow, wide];
        std::iter::once(in_words(&curve.measure)).chain(values.map(text)).collect::<Vec<String>>()
    };
    Table::of(
        "The log-normal over the records; intervals by bootstrap",
        &head,
        margin.fragility.iter().map(row),
    )
}

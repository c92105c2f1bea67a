//! The page of shares of a variance: bars with intervals, floor by floor.

use std::path::Path;

use super::chart::{Axis, Dot, Format, Graph, INK, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use super::words;
use crate::error::Result;
use crate::sensitivity::variance::{MAIN, OfFloor, OfOutput, Output, Share, Shares};

/// How far the bars of the two indices stand from the place of their input.
const APART: f64 = 0.19;

/// Thickness of a bar, units of the picture.
const BAR: u32 = 8;

/// The page of a folder of `mrbd variance`.
///
/// # Errors
/// Input errors for files that are none of such shares.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let shares: Shares = read_json(&folder.join("variance.json"), "shares as `mrbd variance` writes them")?;
    Ok(Page {
        title: format!("Shares of the variance of “{}” under “{}”", shares.study, shares.suite),
        lead: "What the response of a façade varies with: record, façade, coefficients, assumptions, and what no input decides.".into(),
        numbers: numbers(&shares),
        notes: note.generated_note().into_iter().chain(notes(&shares)).collect(),
        sections: vec![
            section(&shares, "main", "Record, façade, coefficients, assumptions, chaos", |share| {
                MAIN.contains(&share.input.as_str())
            }),
            section(&shares, "parts", "Their parts", |share| !MAIN.contains(&share.input.as_str())),
        ],
        provenance: note.pairs(),
        files: ["variance.json", "indices.parquet", "indices.csv"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

fn numbers(shares: &Shares) -> Vec<Number> {
    let points: usize = shares.floors.iter().map(|floor| floor.points).max().unwrap_or(0);
    vec![
        Number::new(shares.runs, "runs"),
        Number::new(points, "points a floor"),
        Number::new(shares.records, "records, each point under all of them"),
    ]
}

fn notes(shares: &Shares) -> Vec<String> {
    let told = shares.floors.iter().filter(|floor| floor.left_out > 0).map(|floor| {
        let of = floor.points + floor.left_out;
        format!(
            "{} of {of} points are left out, {} floor: one of their runs failed.",
            floor.left_out,
            floor.configuration.name()
        )
    });
    let fallen = shares.floors.iter().map(|floor| {
        format!("{:.1} % of the walls fall, {} floor.", 100.0 * floor.fallen(), floor.configuration.name())
    });
    let rules = "Rotations are told by their ranks among all runs, in which walls that fell share the highest: a fallen wall has no largest rotation, and ranks choose nothing in its place. In the tables the same with θ/α cut off at 1.";
    let record = "The record is one of the suite’s, each as likely as another: its share says nothing of records unlike them.";
    fallen.chain(told).chain([rules.to_owned(), record.to_owned()]).collect()
}

fn section(shares: &Shares, id: &str, title: &str, shown: impl Fn(&Share) -> bool + Copy) -> Section {
    let outputs = [Output::Theta1Rank, Output::Theta2Rank, Output::Collapse];
    let panels = shares.floors.iter().flat_map(|floor| {
        let of = move |output: Output| floor.outputs.iter().find(|of| of.output == output);
        outputs.into_iter().filter_map(of).filter_map(move |of| panel(floor, of, shown))
    });
    let figure = Figure {
        id: id.into(),
        title: "Sobol’ indices".into(),
        legend: vec![
            Key::new("total: what would be left if all others were known", PALETTE[0], Mark::Circle),
            Key::new("first: what would go if it were known", PALETTE[1], Mark::Circle),
        ],
        panels: panels.collect(),
        caption: "Bars: shares of the variance; lines: 90 % intervals over draws of the points.".into(),
        links: vec![Link::to("indices.csv")],
        ..Figure::default()
    };
    Section {
        id: id.into(),
        title: title.into(),
        figures: vec![figure],
        tables: shares.floors.iter().map(|floor| table(floor, shown)).collect(),
        ..Section::default()
    }
}

fn panel(floor: &OfFloor, of: &OfOutput, shown: impl Fn(&Share) -> bool) -> Option<String> {
    let shares: Vec<&Share> = of.shares.iter().filter(|share| shown(share)).collect();
    if shares.is_empty() {
        return None;
    }
    let ends = shares.iter().flat_map(|share| [share.total_interval, share.first_interval]).flatten();
    let graph = Graph {
        title: format!("{}: {}", words::floor(floor.configuration), output(of.output)),
        format: Format::Half,
        x: Axis::holding("share of the variance", ends.chain([0.0])),
        y: Axis::names("", shares.iter().map(|share| input(&share.input)).collect()),
        layers: [
            bars(&shares, -APART, 0, |share| (share.total, share.total_interval)),
            bars(&shares, APART, 1, |share| (share.first, share.first_interval)),
        ]
        .concat(),
    };
    Some(graph.svg())
}

/// Bars of an index, their intervals, and their values under the pointer.
fn bars(
    shares: &[&Share],
    apart: f64,
    colour: usize,
    read: impl Fn(&Share) -> (f64, [f64; 2]),
) -> Vec<Layer> {
    let places =
        || shares.iter().enumerate().map(|(place, share)| (place as f64 + apart, read(share), share));
    let bar = |(y, (value, _), _): (f64, (f64, [f64; 2]), _)| [(0.0, y), (value, y)];
    let interval = |(y, (_, [low, high]), _): (f64, (f64, [f64; 2]), _)| [(low, y), (high, y)];
    let dot = |(y, (value, [low, high]), share): (f64, (f64, [f64; 2]), &&Share)| Dot {
        x: value,
        y,
        tip: format!("{}\n{value:.3}, {low:.3} to {high:.3}", input(&share.input)),
    };
    vec![
        Layer::Spans { colour: PALETTE[colour], width: BAR, spans: places().map(bar).collect() },
        Layer::Spans { colour: INK, width: 2, spans: places().map(interval).collect() },
        Layer::Dots {
            colour: PALETTE[colour],
            mark: Mark::Circle,
            size: 3,
            hollow: false,
            dots: places().map(dot).collect(),
        },
    ]
}

fn table(floor: &OfFloor, shown: impl Fn(&Share) -> bool) -> Table {
    let outputs: Vec<&OfOutput> = floor.outputs.iter().filter(|of| !of.shares.is_empty()).collect();
    let head = outputs
        .iter()
        .flat_map(|of| ["first", "total"].map(|index| format!("{} {index}", output(of.output))));
    let head: Vec<String> = std::iter::once("input".to_owned()).chain(head).collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let inputs =
        outputs.first().map_or(Vec::new(), |of| of.shares.iter().filter(|share| shown(share)).collect());
    let row = |share: &Share| {
        let of_output =
            |of: &&OfOutput| of.share(&share.input).map_or(["–", "–"].map(str::to_owned), Share::told);
        std::iter::once(input(&share.input))
            .chain(outputs.iter().flat_map(of_output))
            .collect::<Vec<String>>()
    };
    Table::of(
        &format!("{} floor: {} points", floor.configuration.name(), floor.points),
        &head,
        inputs.into_iter().map(row),
    )
}

fn output(output: Output) -> &'static str {
    match output {
        Output::Theta1Rank => "rank of θ₁/α₁",
        Output::Theta2Rank => "rank of θ₂/α₂",
        Output::Collapse => "collapse",
        Output::Theta1Clipped => "θ₁/α₁ up to 1",
        Output::Theta2Clipped => "θ₂/α₂ up to 1",
    }
}

/// An input in words.
fn input(name: &str) -> String {
    match name {
        "facade" => "façade, all of it",
        "wall" => "its wall: b, h/b, h₁, f",
        "floor" => "its floor: k_d, m_d, m_dp",
        "assumptions" => "assumptions",
        "coefficients" => "coefficients C₁ … C₈",
        "chaos" => "chaos: no input",
        "thickness_m" => "thickness b",
        "slenderness" => "slenderness h/b",
        "crack_height_ratio" => "height of the crack",
        "compressive_strength_pa" => "strength f",
        "stiffness_n_per_m" => "stiffness k_d",
        "diaphragm_mass_ratio" => "mass m_d",
        "carriage_mass_ratio" => "mass m_dp",
        "law" => "law of impact",
        "length_m" => "length L",
        "density_kg_m3" => "density ρ",
        "bed" => "stiffness of the joints",
        other => other,
    }
    .to_owned()
}

//! The page of sweeps under several suites: conclusions, how many records decide them, quartiles of the façades.

use std::path::Path;

use super::chart::{Axis, Format, Graph, Layer, Mark, PALETTE};
use super::page::{Cell, Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use super::words;
use crate::error::Result;
use crate::findings::{FINDINGS, Finding, SURE, sure_rules};
use crate::sensitivity::suites::{OfSuite, Quartiles, Suites, Told, short, title};
use crate::survey::Configuration;

/// The page of a folder of `mrbd suites`.
///
/// # Errors
/// Input errors for files that are none of such a comparison.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let Suites { suites } = read_json(&folder.join("suites.json"), "suites as `mrbd suites` writes them")?;
    Ok(Page {
        title: "The paper’s conclusions under several suites of records".into(),
        lead: "The same sweep of façades under each suite: what it says of each conclusion, how sure that is, and how many records it takes.".into(),
        numbers: suites.iter().map(number).collect(),
        notes: suites.iter().map(told_of).collect(),
        sections: vec![conclusions(&suites), by_records(&suites), quartiles(&suites)],
        provenance: note.pairs(),
        files: ["suites.json", "suites.csv"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

fn number(of: &OfSuite) -> Number {
    let holds = of.conclusions.iter().filter(|told| told.verdict == "holds").count();
    let decided = of.conclusions.iter().filter(|told| told.decided_from.is_some()).count();
    Number::new(
        format!("{holds} of {}", of.conclusions.len()),
        format!("conclusions hold under {}; {decided} are decided", title(of)),
    )
}

fn told_of(of: &OfSuite) -> String {
    let kind = if of.generated { "generated, not measured" } else { "measured" };
    format!(
        "Suite “{}”: {} records, {kind}; variant “{}”, {} runs of which {} collapsed, {} members of each; plan {}.",
        of.suite,
        of.records,
        of.variant,
        of.runs,
        of.collapsed,
        of.members,
        of.plan_sha256.get(..16).unwrap_or_default()
    )
}

fn cell(told: &Told) -> Cell {
    let class = match told.verdict.as_str() {
        "holds" => "holds",
        "does not" => "does-not",
        "undecided" => "undecided",
        _ => "not-asked",
    };
    Cell { text: short(told), class }
}

fn conclusions(suites: &[OfSuite]) -> Section {
    let row = |(index, finding): (usize, &Finding)| {
        let head = Cell::from(format!("{}. {}", index + 1, finding.label));
        std::iter::once(head).chain(suites.iter().map(|of| cell(&of.conclusions[index]))).collect()
    };
    Section {
        id: "conclusions".into(),
        title: "The paper’s conclusions".into(),
        text: vec![
            sure_rules(),
            "With the share of the draws that say so; undecided: those that hold, and those that do not. From N: the fewest records in a draw from which on it is decided so.".into(),
        ],
        tables: vec![Table {
            caption: "Verdicts, shares of the draws, and the fewest records that decide".into(),
            prose: true,
            head: std::iter::once("conclusion".to_owned()).chain(suites.iter().map(title)).collect(),
            rows: FINDINGS.iter().enumerate().map(row).collect(),
        }],
        ..Section::default()
    }
}

fn legend(suites: &[OfSuite]) -> Vec<Key> {
    suites.iter().zip(PALETTE).map(|(of, colour)| Key::new(title(of), colour, Mark::None)).collect()
}

fn by_records(suites: &[OfSuite]) -> Section {
    let most = suites.iter().map(|of| of.records).max().unwrap_or(1) as f64;
    let panel = |index: usize| {
        let layers = suites.iter().zip(PALETTE).flat_map(|(of, colour)| {
            let line = |dashed: bool, what: &str| Layer::Line {
                colour,
                width: 3,
                dashed,
                name: format!("{}: {what}", of.suite),
                points: of.conclusions[index]
                    .by_records
                    .iter()
                    .map(|by| (by.records as f64, if dashed { by.does_not_share } else { by.holds_share }))
                    .collect(),
            };
            [line(false, "holds"), line(true, "does not")]
        });
        let graph = Graph {
            title: format!("{}. {}", index + 1, FINDINGS[index].name),
            format: Format::Half,
            x: Axis::linear("records in a draw", 0.0, most + 1.0),
            y: Axis::linear("share of the draws", 0.0, 1.05),
            layers: std::iter::once(Layer::Threshold { y: SURE, name: "decided" }).chain(layers).collect(),
        };
        graph.svg()
    };
    let asked = |index: &usize| suites.iter().any(|of| !of.conclusions[*index].by_records.is_empty());
    let figure = Figure {
        id: "by-records".into(),
        title: "How many records until a conclusion is decided".into(),
        legend: legend(suites),
        panels: (0..FINDINGS.len()).filter(asked).map(panel).collect(),
        caption: "Whole lines: the share of the draws in which a conclusion holds; dashed: in which it does not. Above 0.9 it is decided. A draw can have no more different records than the suite.".into(),
        links: vec![Link::to("suites.csv")],
        ..Figure::default()
    };
    Section {
        id: "records".into(),
        title: "How many records it takes".into(),
        figures: vec![figure],
        ..Section::default()
    }
}

fn quartiles(suites: &[OfSuite]) -> Section {
    let bodies = [
        ("theta1_max_over_alpha1", "max |θ₁|/α₁", "lower body"),
        ("theta2_max_over_alpha2", "max |θ₂|/α₂", "upper body"),
    ];
    let panels = bodies.iter().flat_map(|body| {
        Configuration::ALL.into_iter().map(move |configuration| panel(suites, configuration, *body))
    });
    let figure = Figure {
        id: "quartiles".into(),
        title: "Reference façades: quartiles over the records".into(),
        legend: legend(suites),
        panels: panels.collect(),
        caption: "Lines: the median over the records; bands: from the 25 to the 75 % quantile. All parameters at their means. Both end where they are collapses.".into(),
        links: vec![Link::to("suites.json")],
        ..Figure::default()
    };
    Section {
        id: "quartiles".into(),
        title: "The response".into(),
        figures: vec![figure],
        ..Section::default()
    }
}

fn panel(
    suites: &[OfSuite],
    configuration: Configuration,
    (measure, label, body): (&str, &str, &str),
) -> String {
    let of = |of: &OfSuite| -> Vec<Quartiles> {
        let shown = |q: &&Quartiles| q.configuration == configuration && q.measure == measure;
        of.reference.iter().filter(shown).cloned().collect()
    };
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let shown: Vec<f64> = suites.iter().flat_map(of).filter_map(|q| q.q75.or(q.median)).collect();
    let slendernesses: Vec<f64> = suites.iter().flat_map(of).map(|q| q.slenderness).collect();
    let layers = suites.iter().zip(PALETTE).flat_map(|(suite, colour)| {
        let band = of(suite).iter().map(|q| (q.slenderness, number(q.q25), number(q.q75))).collect();
        let line = of(suite).iter().map(|q| (q.slenderness, number(q.median))).collect();
        let name = format!("{}, median", suite.suite);
        [
            Layer::Band { colour, points: band },
            Layer::Line { colour, width: 3, dashed: false, name, points: line },
        ]
    });
    let graph = Graph {
        title: format!("{}: {body}", words::floor(configuration)),
        format: Format::Half,
        x: Axis::holding("slenderness h/b", slendernesses),
        y: Axis::holding(label, shown.into_iter().chain([0.0])),
        layers: layers.collect(),
    };
    graph.svg()
}

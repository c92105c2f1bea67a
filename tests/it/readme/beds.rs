//! The paper's study with joints that give: what each softness says of its conclusions, and the medians beside.

use std::path::Path;

use mrbd::aggregate::{Measure, Medians, Middle, aggregate};
use mrbd::findings::{Conclusions, FINDINGS, Slender, View, conclusions};
use mrbd::survey::Configuration;

use super::ROOT;
use super::block::{Page, grouped, row};

/// Written by `make beds`; without it what stands in the page is kept.
fn medians() -> Option<Medians> {
    let folder = Path::new(ROOT).join("outputs/beds");
    folder.join("manifest.json").is_file().then(|| aggregate(&folder).expect("the study of beds"))
}

/// A softness in words.
fn softness(variant: &str) -> String {
    match variant.strip_prefix("bed ") {
        Some(of) => match of.split_once(", ") {
            Some((stiffness, damping)) => format!("{stiffness} Pa/m, {damping}"),
            None => format!("{of} Pa/m"),
        },
        None => "sharp edges".to_owned(),
    }
}

/// Heads of the columns, a softness each.
fn head(first: &str, all: &[Conclusions]) -> String {
    let names = all.iter().map(|under| softness(&under.variant));
    let cells = std::iter::once(first.to_owned()).chain(names).collect::<Vec<_>>();
    row(&cells) + &row(&vec!["---"; cells.len()])
}

/// The conclusions under each softness.
pub fn conclusion_block(page: &mut Page) {
    let Some(medians) = medians() else { return page.keep("beds") };
    let all = conclusions(&medians);
    let of = |(i, finding): (usize, &mrbd::findings::Finding)| {
        let cells = all.iter().map(|under| under.all[i].short());
        row(&std::iter::once(finding.label.to_owned()).chain(cells).collect::<Vec<_>>())
    };
    let rows = FINDINGS.iter().enumerate().map(of).collect::<String>();
    page.put_lines("beds", &(head("conclusion of the paper", &all) + &rows));
}

/// How many runs collapse on each softness.
pub fn collapse_block(page: &mut Page) {
    let Some(medians) = medians() else { return page.keep("collapses on beds") };
    let counts =
        medians.variants.iter().map(|note| format!("{} on {}", note.collapsed, softness(&note.name)));
    let runs = medians.variants.iter().map(|note| note.runs).max().expect("a variant");
    let counts = counts.collect::<Vec<_>>().join("; ");
    page.put_prose(
        "collapses on beds",
        &format!("Of {} runs each, so many collapse: {counts}.", grouped(runs)),
    );
}

/// Medians of the lower body of the reference façades under each softness, and how all runs ended.
pub fn median_block(page: &mut Page) {
    let Some(medians) = medians() else { return page.keep("medians on beds") };
    let all = conclusions(&medians);
    let slendernesses = View::new(&medians, &all[0].variant).slendernesses(Slender::Any);
    let mut table = head("median of θ₁/α₁, h/b", &all);
    for configuration in Configuration::ALL {
        for &slenderness in &slendernesses {
            let cell = |under: &Conclusions| {
                let row = View::new(&medians, &under.variant)
                    .reference(configuration, (slenderness, Measure::LowerOwn));
                match row.and_then(mrbd::aggregate::Median::middle) {
                    Some(Middle::Rotation(theta)) => format!("{theta:.3}"),
                    Some(Middle::Collapsed) => "falls".to_owned(),
                    None => "–".to_owned(),
                }
            };
            let name = format!("{slenderness}, {} floor", configuration.name());
            table += &row(&std::iter::once(name).chain(all.iter().map(cell)).collect::<Vec<_>>());
        }
    }
    let ended = |under: &Conclusions| {
        let note = medians.variants.iter().find(|note| note.name == under.variant).expect("a variant");
        format!("{} and {} of {}", note.collapsed, note.failed, note.runs)
    };
    let first = std::iter::once("collapsed and failed runs".to_owned());
    table += &row(&first.chain(all.iter().map(ended)).collect::<Vec<_>>());
    page.put_lines("medians on beds", &table);
}

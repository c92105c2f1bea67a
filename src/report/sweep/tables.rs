//! Findings and assumptions as tables; the reference façades under each record (Figures 18 and 19).

use super::super::chart::{CurvePoint, Graph, of_curve};
use super::super::page::{Cell, Figure, Key, Link, Section, Table};
use super::super::rotations;
use super::medians::{over_slenderness, y_label};
use crate::aggregate::{Measure, Middle, ReferenceRun, VariantNote};
use crate::findings::{Conclusion, Conclusions, FINDINGS, Finding, Verdict, View};
use crate::survey::Configuration;

/// The verdict, with the share of the draws that say so.
fn verdict(conclusion: &Conclusion) -> Cell {
    let class = match conclusion.verdict() {
        Verdict::Holds => "holds",
        Verdict::DoesNot => "does-not",
        Verdict::Undecided => "undecided",
        Verdict::NotAsked => "not-asked",
    };
    Cell { text: conclusion.short(), class }
}

fn heads(heads: &[&str]) -> Vec<String> {
    heads.iter().map(|&head| head.to_owned()).collect()
}

/// Every conclusion with its criterion, its verdict and the numbers that decide.
pub fn findings(conclusions: &Conclusions) -> Table {
    let row = |(index, (finding, conclusion)): (usize, (&Finding, &Conclusion))| {
        vec![
            Cell::from(format!("{}. {}", index + 1, finding.name)),
            verdict(conclusion),
            Cell::from(format!("{} ({})", finding.claim, finding.source)),
            Cell::from(conclusion.answer.numbers.clone()),
            Cell::from(finding.criterion.to_owned()),
        ]
    };
    Table {
        prose: true,
        caption: format!("Conclusions under variant “{}”", conclusions.variant),
        head: heads(&["conclusion", "verdict", "the paper says", "found", "holds if"]),
        rows: FINDINGS.iter().zip(&conclusions.all).enumerate().map(row).collect(),
    }
}

/// The verdicts under every set of assumptions.
pub fn by_variant(conclusions: &[Conclusions]) -> Table {
    let mut head = heads(&["conclusion"]);
    head.extend(conclusions.iter().map(|under| under.variant.clone()));
    let row = |(index, finding): (usize, &Finding)| {
        let mut row = vec![Cell::from(format!("{}. {}", index + 1, finding.name))];
        row.extend(conclusions.iter().map(|under| verdict(&under.all[index])));
        row
    };
    Table {
        caption: "The same conclusions under every variant of the assumptions".into(),
        prose: false,
        head,
        rows: FINDINGS.iter().enumerate().map(row).collect(),
    }
}

/// The assumptions of every variant and how its runs ended.
pub fn assumptions(variants: &[VariantNote]) -> Table {
    let row = |v: &VariantNote| {
        let residual = v.energy_residual.map_or("–".to_owned(), |residual| format!("{residual:.0e}"));
        [
            v.name.clone(),
            format!("{} m", v.length_m),
            format!("{} kg/m³", v.density_kg_m3),
            v.law.clone(),
            format!("{:e} rad/s", v.capture_velocity_rad_s),
            format!("{:e}", v.tolerance),
            v.runs.to_string(),
            v.collapsed.to_string(),
            v.failed.to_string(),
            residual,
        ]
        .map(Cell::from)
        .to_vec()
    };
    let names = [
        "variant",
        "length of strip",
        "density",
        "impact law",
        "capture velocity",
        "tolerance",
        "runs",
        "collapsed",
        "failed",
        "largest energy residual",
    ];
    Table {
        caption:
            "Energy residual: the energy of a run not accounted for, over the energy that passed through it"
                .into(),
        prose: false,
        head: heads(&names),
        rows: variants.iter().map(row).collect(),
    }
}

/// The section: a figure a body, a curve a record.
pub fn by_record(view: &View, runs: &[ReferenceRun], links: &[Link]) -> Section {
    let bodies = [(Measure::LowerOwn, "Fig. 18"), (Measure::UpperOwn, "Fig. 19")];
    let figures = bodies.map(|(body, number)| figure(view, runs, body, number, links));
    Section {
        id: "records".into(),
        title: "Record by record".into(),
        text: vec![
            "The reference façades, all parameters at their means, under each record. A cross in the red band above the axis: the wall collapsed. Press a record to see it alone.".into(),
        ],
        figures: figures.into(),
        ..Section::default()
    }
}

fn figure(view: &View, runs: &[ReferenceRun], body: Measure, number: &str, links: &[Link]) -> Figure {
    let panel = |configuration| panel(view, runs, configuration, body);
    let upper = body == Measure::UpperOwn;
    Figure {
        id: if upper { "records-upper" } else { "records-lower" }.into(),
        title: format!("{} body under each record", if upper { "Upper" } else { "Lower" }),
        paper: Some(number.into()),
        legend: legend(runs),
        panels: Configuration::ALL.map(|c| panel(c).svg()).into(),
        caption: "Largest rotation of the reference façades by slenderness h/b, one curve a record. Dashed line: 0.05, which the paper calls significant.".into(),
        links: links.to_vec(),
        ..Figure::default()
    }
}

/// Names of the records in the order of the suite, with their earthquakes.
fn records(runs: &[ReferenceRun]) -> Vec<(&str, &str)> {
    let mut names: Vec<(u64, &str, &str)> =
        runs.iter().map(|run| (run.record_id, run.record.as_str(), run.event.as_str())).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(|(_, name, event)| (name, event)).collect()
}

fn legend(runs: &[ReferenceRun]) -> Vec<Key> {
    let key = |(index, (name, event)): (usize, (&str, &str))| {
        let (colour, mark) = of_curve(index);
        let label = if event.is_empty() { name.to_owned() } else { format!("{name} ({event})") };
        Key::new(label, colour, mark)
    };
    records(runs).into_iter().enumerate().map(key).collect()
}

fn panel(view: &View, runs: &[ReferenceRun], configuration: Configuration, body: Measure) -> Graph {
    let of_body = |run: &ReferenceRun| run.rotation[usize::from(body == Measure::UpperOwn)];
    let shown: Vec<Middle> = runs.iter().filter_map(of_body).collect();
    let point = |run: &ReferenceRun| {
        let y = of_body(run)?;
        let value = match y {
            Middle::Rotation(rotation) => format!("{} = {rotation:.4}", y_label(body)),
            Middle::Collapsed => "collapsed".into(),
        };
        let tip = format!("{}\nh/b {}: {value}", run.record, run.slenderness);
        Some(CurvePoint { x: run.slenderness, y: rotations::number(&y), hollow: false, tip })
    };
    let records = records(runs);
    let curve = |(index, (name, _)): (usize, &(&str, &str))| {
        let own = |run: &&ReferenceRun| run.record == *name && run.configuration == configuration;
        rotations::curve(index, records.len(), runs.iter().filter(own).filter_map(point).collect())
    };
    let curves = records.iter().enumerate().map(curve).collect();
    over_slenderness(view, &shown, (configuration, body), curves)
}

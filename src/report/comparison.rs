//! The page of a comparison of models (Fig. 9): one wall as three models under the same records.

mod histories;

use std::path::Path;

use serde::Deserialize;

use super::chart::{Axis, CurvePoint, Format, Graph, of_curve};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{self, Note};
use super::rotations;
use crate::aggregate::Middle;
use crate::classics::comparison::MODELS;
use crate::error::{InputError, Result};
use histories::Histories;

/// A row of `comparison.csv`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Row {
    law: String,
    record: String,
    scale: f64,
    model: String,
    outcome: String,
    theta1_max_over_alpha1: f64,
    theta2_max_over_alpha2: f64,
}

impl Row {
    /// The larger rotation of the two bodies; none for a failed run.
    fn middle(&self) -> Option<Middle> {
        match self.outcome.as_str() {
            "collapsed" => Some(Middle::Collapsed),
            "failed" => None,
            _ => Some(Middle::Rotation(self.theta1_max_over_alpha1.max(self.theta2_max_over_alpha2))),
        }
    }
}

/// A row of `findings.json`.
#[derive(Debug, Deserialize)]
struct Finding {
    law: String,
    claim: String,
    holds: u64,
    of: u64,
}

/// The page of the comparison in a folder.
///
/// # Errors
/// Input errors for files that are none of a comparison; whatever drawing meets.
pub fn page(folder: &Path) -> Result<Page> {
    let rows = read_rows(&folder.join("comparison.csv"))?;
    let findings = read_findings(&folder.join("findings.json"))?;
    let note = Note::read(&folder.join("manifest.json"))?;
    let histories = Histories::read(folder)?;
    let mut sections = Vec::new();
    for law in distinct(rows.iter().map(|row| row.law.as_str())) {
        let mut section = section(&rows, law);
        if let Some(histories) = &histories {
            section.figures.extend(histories.figure(law));
        }
        sections.push(section);
    }
    sections.push(claims(&findings));
    let failed = rows.iter().filter(|row| row.outcome == "failed").count();
    let collapsed = rows.iter().filter(|row| row.outcome == "collapsed").count();
    Ok(Page {
        title: format!("Comparison “{}”", note.name),
        lead: "One wall as three models under the same records: calibrated (carriage mass and C_l of Table 2), updated (carriage mass, C_l = 1) and lumped (the carriage in m_d, C_l = 1).".into(),
        unfinished: None,
        numbers: vec![
            Number::new(rows.len(), "runs"),
            Number::new(collapsed, "collapsed"),
            Number::new(failed, "failed"),
        ],
        notes: note.generated_note().into_iter().collect(),
        sections,
        provenance: note.pairs(),
        files: ["manifest.json", "comparison.csv", "findings.json"]
            .into_iter()
            .chain(histories.is_some().then_some(histories::FILE))
            .map(Link::to)
            .collect(),
        ..Page::default()
    })
}

fn read_rows(path: &Path) -> Result<Vec<Row>> {
    let refuse = |e: csv::Error| {
        let line = e.position().map_or(1, |p| p.line() as usize);
        InputError::line(path, line, e.to_string(), "rows as `mrbd run` writes them")
    };
    let mut reader = csv::Reader::from_path(path).map_err(refuse)?;
    Ok(reader.deserialize().collect::<std::result::Result<_, _>>().map_err(refuse)?)
}

fn read_findings(path: &Path) -> Result<Vec<Finding>> {
    provenance::read_json(path, "findings as `mrbd run` writes them")
}

/// Each once, in order of appearance.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = Vec::new();
    names.for_each(|name| {
        if !seen.contains(&name) {
            seen.push(name)
        }
    });
    seen
}

/// The rows under one impact law: a panel a record.
fn section(rows: &[Row], law: &str) -> Section {
    let own: Vec<&Row> = rows.iter().filter(|row| row.law == law).collect();
    let records = distinct(own.iter().map(|row| row.record.as_str()));
    let panels = records.into_iter().map(|record| panel(&own, record).svg()).collect();
    let legend = MODELS.iter().enumerate().map(|(index, model)| {
        let (colour, mark) = of_curve(index);
        Key::new(*model, colour, mark)
    });
    Section {
        id: format!("law-{law}"),
        title: format!("Impact law “{law}”"),
        figures: vec![Figure {
            id: format!("models-{law}"),
            title: "Largest rotation of either body as the record is scaled".into(),
            paper: Some("Fig. 9".into()),
            legend: legend.collect(),
            panels,
            caption: "One panel a record. A cross in the red band above the axis: the wall collapsed. The paper finds that the calibrated model rotates least.".into(),
            links: vec![Link::to("comparison.csv")],
            ..Figure::default()
        }],
        ..Section::default()
    }
}

/// Rotations of a panel whose walls all collapse are shown up to here, over α.
const LEAST_SHOWN: f64 = 0.1;

fn panel(own: &[&Row], record: &str) -> Graph {
    let own: Vec<&Row> = own.iter().copied().filter(|row| row.record == record).collect();
    let middles: Vec<Middle> = own.iter().filter_map(|row| row.middle()).collect();
    let scales = own.iter().map(|row| row.scale);
    let (first, last) = scales.fold((f64::MAX, f64::MIN), |(a, b), scale| (a.min(scale), b.max(scale)));
    let room = (0.06 * (last - first)).max(0.05);
    let curve = |(index, model): (usize, &&str)| {
        let points = own.iter().filter(|row| row.model == **model).filter_map(|row| point(row)).collect();
        rotations::curve(index, MODELS.len(), points)
    };
    Graph {
        title: record.to_owned(),
        format: Format::Half,
        x: Axis::linear("factor on the record", first - room, last + room),
        y: rotations::axis("max |θᵢ|/αᵢ", &middles, LEAST_SHOWN),
        layers: MODELS.iter().enumerate().map(curve).collect(),
    }
}

fn point(row: &Row) -> Option<CurvePoint> {
    let y = row.middle()?;
    let value = match y {
        Middle::Rotation(rotation) => format!("max |θᵢ|/αᵢ = {rotation:.3}"),
        Middle::Collapsed => "collapsed".to_owned(),
    };
    let tip = format!("{} under {} × {}\n{value}", row.model, row.record, row.scale);
    Some(CurvePoint { x: row.scale, y: rotations::number(&y), hollow: false, tip })
}

fn claims(findings: &[Finding]) -> Section {
    let row = |f: &Finding| vec![f.claim.clone(), f.law.clone(), format!("{} of {}", f.holds, f.of)];
    Section {
        id: "claims".into(),
        title: "What the paper finds, counted here".into(),
        tables: vec![Table::of(
            "Cases in which the claim holds",
            &["claim", "impact law", "holds"],
            findings.iter().map(row),
        )],
        ..Section::default()
    }
}

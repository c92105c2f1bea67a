//! Figures 18 and 19: the reference façades under each record.

use super::super::chart::{CurvePoint, Graph, of_curve};
use super::super::page::{Figure, Key, Link, Section};
use super::super::rotations;
use super::medians::{over_slenderness, y_label};
use crate::aggregate::{Measure, Middle, ReferenceRun};
use crate::findings::View;
use crate::survey::Configuration;

/// The section: a figure a body, a curve a record.
pub fn section(view: &View, runs: &[ReferenceRun], links: &[Link]) -> Section {
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

//! The page of a slow push: force against displacement, the rigid line, and what was measured.

use std::path::Path;

use super::chart::{Axis, Dot, Format, Graph, INK, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use crate::assessment::push::{Measured, PushCurve, Pushed};
use crate::error::Result;

/// The page of a folder of `mrbd push`.
///
/// # Errors
/// Input errors for files that are none of a push.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let pushed: Pushed = read_json(&folder.join("push.json"), "a push as `mrbd push` writes it")?;
    let figure = Figure {
        id: "push-curve".into(),
        title: "Force against displacement".into(),
        legend: legend(&pushed),
        panels: vec![graph(&pushed).svg()],
        wide: true,
        caption: "Each point is a state of equilibrium under the displacement.".into(),
        links: vec![Link::to("push.csv")],
        ..Figure::default()
    };
    Ok(Page {
        title: format!("Push of {}", pushed.wall),
        lead: lead(&pushed),
        numbers: numbers(&pushed),
        notes: notes(&pushed),
        sections: vec![Section {
            id: "push".into(),
            title: "Push".into(),
            figures: vec![figure],
            tables: std::iter::once(curves(&pushed)).chain(pushed.measured.as_ref().map(measured)).collect(),
            ..Section::default()
        }],
        provenance: note.pairs(),
        files: ["push.json", "push.csv"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

/// The curves as one SVG that stands alone.
pub fn push_svg(pushed: &Pushed) -> String {
    graph(pushed).svg()
}

fn lead(pushed: &Pushed) -> String {
    let at = match pushed.at.as_str() {
        "crack" => "by a point force at the middle of its crack",
        "top" => "by a point force at its top",
        _ => "by a uniform acceleration of all its masses",
    };
    let top = match pushed.top.as_str() {
        "free" => "its top is free",
        "held" => "its top is held by a rigid support",
        _ => "its top is held by the springs of the wall file",
    };
    format!("The wall is pushed slowly {at}; {top}.")
}

fn numbers(pushed: &Pushed) -> Vec<Number> {
    let curve = &pushed.curve;
    let end = curve.end_m.map_or("–".to_owned(), |end_m| format!("{end_m:.4} m"));
    let mut numbers = vec![
        Number::new(format!("{:.4}", curve.largest_force_over_weight), "largest force over the weight"),
        Number::new(
            format!("{:.4}", pushed.rigid.largest_force_over_weight),
            "the same on sharp, full edges",
        ),
        Number::new(end, "displacement at which the force vanishes"),
    ];
    numbers.extend(pushed.measured.as_ref().map(|measured| {
        Number::new(
            format!("{:.4}", measured.rms_over_weight),
            "of the weight: difference from what was measured",
        )
    }));
    numbers
}

fn notes(pushed: &Pushed) -> Vec<String> {
    let [ground, crack] =
        [0, 1].map(|joint: usize| match (pushed.beds_pa_per_m[joint], &pushed.joint_laws[joint]) {
            (Some(bed), _) => format!("a bed of {bed:e} Pa/m"),
            (None, Some(kind)) => kind.clone(),
            (None, None) => "sharp edges".to_owned(),
        });
    vec![
        format!("Joints: {ground} at the ground, {crack} at the crack, loaded by what stands above them."),
        "Dampers and friction at the top do not count. The bodies are rigid and do not slide.".into(),
    ]
}

fn legend(pushed: &Pushed) -> Vec<Key> {
    let mut keys = vec![
        Key::new("the wall", PALETTE[0], Mark::None),
        Key::new("rigid line: sharp edges, full thickness", PALETTE[1], Mark::None),
    ];
    keys.extend(pushed.measured.as_ref().map(|measured| Key::new(&measured.file, INK, Mark::Circle)));
    keys
}

fn graph(pushed: &Pushed) -> Graph {
    let line = |curve: &PushCurve, colour, dashed, name: &str| {
        let points =
            curve.points.iter().map(|point| (point.displacement_m, point.force_over_weight)).collect();
        Layer::Line { colour, width: 5, dashed, name: name.into(), points }
    };
    let mut layers = vec![
        line(&pushed.rigid, PALETTE[1], true, "rigid line"),
        line(&pushed.curve, PALETTE[0], false, "the wall"),
    ];
    layers.extend(pushed.measured.as_ref().map(|measured| {
        let dot = |point: &crate::assessment::push::MeasuredPoint| Dot {
            x: point.displacement_m,
            y: point.force_over_weight,
            tip: format!(
                "{}\n{:.5} m\n{:.4} of the weight",
                measured.file, point.displacement_m, point.force_over_weight
            ),
        };
        let dots = measured.points.iter().map(dot).collect();
        Layer::Dots { colour: INK, mark: Mark::Circle, size: 9, hollow: true, dots }
    }));
    let all = |of: fn(&crate::assessment::push::PushPoint) -> f64| {
        pushed.curve.points.iter().chain(&pushed.rigid.points).map(of).collect::<Vec<_>>()
    };
    let measured = |of: fn(&crate::assessment::push::MeasuredPoint) -> f64| {
        pushed.measured.iter().flat_map(|measured| &measured.points).map(of).collect::<Vec<_>>()
    };
    let [x, y] = [
        [all(|p| p.displacement_m), measured(|p| p.displacement_m)].concat(),
        [all(|p| p.force_over_weight), measured(|p| p.force_over_weight)].concat(),
    ];
    Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::holding(&format!("displacement of the {}, m", pushed.displacement_of), x),
        y: Axis::holding("force over weight", y),
        layers,
    }
}

fn curves(pushed: &Pushed) -> Table {
    let row = |name: &str, curve: &PushCurve| {
        vec![
            name.to_owned(),
            format!("{:.4}", curve.largest_force_over_weight),
            format!("{:.5}", curve.largest_at_m),
            curve.end_m.map_or("–".to_owned(), |end_m| format!("{end_m:.5}")),
        ]
    };
    let head = ["curve", "largest force over weight", "at, m", "no force at, m"];
    let rows = [row("the wall", &pushed.curve), row("rigid line", &pushed.rigid)];
    Table::of("What the wall bears, and how far", &head, rows.into_iter())
}

fn measured(measured: &Measured) -> Table {
    let head = ["displacement, m", "measured", "the wall", "rigid line"];
    let row = |point: &crate::assessment::push::MeasuredPoint| {
        let forces = [point.force_over_weight, point.model_over_weight, point.rigid_over_weight];
        let forces = forces.map(|force| format!("{force:.4}"));
        std::iter::once(format!("{:.5}", point.displacement_m)).chain(forces).collect::<Vec<String>>()
    };
    Table::of("Force over weight, point by point", &head, measured.points.iter().map(row))
}

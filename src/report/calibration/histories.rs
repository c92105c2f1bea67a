//! Figures 7 and 8: measured rotations, and those of the calibrated wall in the same tests.

use super::super::chart::{Axis, Colour, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section};
use super::wme;
use crate::summary::TestRotations;
use mrbd_lab::calibrate::{Calibration, TestResult};

/// Measured rotations: dark grey under the simulated ones.
const MEASURED: Colour = PALETTE[6];

/// The section; a sentence where the tests are no longer at hand.
pub fn section(tests: Option<&[TestRotations]>, stored: &Calibration) -> Section {
    let mut section =
        Section { id: "histories".into(), title: "Measured against simulated".into(), ..Section::default() };
    let Some(tests) = tests else {
        section.text.push(
            "The experiment’s files are no longer where the calibration read them, or are other ones now: its histories cannot be drawn.".into(),
        );
        return section;
    };
    section.text.push(
        "The calibrated wall in every test, from rest; tests held out were not seen by the search.".into(),
    );
    let numbered = stored.tests.iter().zip(tests).enumerate();
    section.figures = numbered.map(|(index, (test, rotations))| figure(index, test, rotations)).collect();
    section
}

fn figure(index: usize, test: &TestResult, rotations: &TestRotations) -> Figure {
    let held = if test.purpose == "fit" { "to fit" } else { "held out" };
    let bodies = 0..rotations.simulated.len();
    let key = |label: &str, colour| Key::new(label, colour, Mark::None);
    Figure {
        id: format!("test-{}", index + 1),
        title: format!("{}, {held}", test.name),
        paper: Some("Figs. 7 and 8".into()),
        legend: vec![
            key("measured", MEASURED),
            key("simulated, lower body", PALETTE[0]),
            key("simulated, upper body", PALETTE[1]),
        ],
        panels: bodies.map(|body| panel(rotations, body).svg()).collect(),
        wide: true,
        caption: format!(
            "Rotations over slenderness angles; simulated up to the end of what counts. WME {} with the calibrated wall, {} before.",
            wme(test.wme_joint),
            wme(test.wme_before)
        ),
        links: vec![Link::to("calibration.json")],
    }
}

fn panel(rotations: &TestRotations, body: usize) -> Graph {
    let (measured, simulated) = (&rotations.measured[body], &rotations.simulated[body]);
    let end_s = simulated.iter().chain(measured).map(|point| point.0).fold(0.0, f64::max);
    let line = |name: &str, colour, width, points: &[(f64, f64)]| Layer::Line {
        colour,
        width,
        dashed: false,
        name: name.to_owned(),
        points: points.to_vec(),
    };
    Graph {
        title: String::new(),
        format: Format::Low,
        x: Axis::linear("time s", 0.0, end_s),
        y: Axis::holding(["θ₁/α₁", "θ₂/α₂"][body], measured.iter().chain(simulated).map(|point| point.1)),
        layers: vec![line("measured", MEASURED, 6, measured), line("simulated", PALETTE[body], 4, simulated)],
    }
}

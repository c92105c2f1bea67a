//! The tests: measured rotations beside the calibrated wall's (Figures 7 and 8), misfits before and after, impacts.

use super::super::chart::{Axis, Colour, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section, Table};
use super::wme;
use crate::summary::TestRotations;
use mrbd_lab::calibrate::{Calibration, TestResult};

/// The section.
pub fn section(stored: &Calibration) -> Section {
    let mut tables = vec![misfits(stored), transitions(stored)];
    if !stored.capture_study.is_empty() {
        tables.push(capture(stored));
    }
    Section { id: "tests".into(), title: "The tests".into(), tables, ..Section::default() }
}

fn misfits(stored: &Calibration) -> Table {
    let time = |s: Option<f64>| s.map_or("–".to_owned(), |s| format!("{s:.2} s"));
    let row = |test: &TestResult| {
        vec![
            test.name.clone(),
            if test.purpose == "fit" { "to fit" } else { "held out" }.to_owned(),
            wme(test.wme_before),
            wme(test.wme_joint),
            wme(test.wme_alone),
            time(test.measured_collapse_s),
            time(test.simulated_collapse_s),
        ]
    };
    let head = [
        "test",
        "use",
        "before",
        "calibrated",
        "best for it alone",
        "measured collapse",
        "simulated collapse",
    ];
    Table::of("WME of each test (Eq. 8)", &head, stored.tests.iter().map(row))
}

fn transitions(stored: &Calibration) -> Table {
    let row = |test: &TestResult| {
        let counts = test.transitions.iter().map(u64::to_string);
        std::iter::once(test.name.clone()).chain(counts).collect::<Vec<_>>()
    };
    let head = ["test", "C_1", "C_2", "C_3", "C_4", "C_5", "C_6", "C_7", "C_8"];
    Table::of(
        "Impacts that each coefficient scales, with the calibrated wall",
        &head,
        stored.tests.iter().map(row),
    )
}

fn capture(stored: &Calibration) -> Table {
    let rows = stored.capture_study.iter().map(|row| {
        let speed = format!("{:e} rad/s", row.capture_velocity_rad_s);
        vec![row.law.clone(), speed, wme(row.wme_of_joint), wme(row.wme_of_best)]
    });
    let head =
        ["impact law", "capture velocity", "mean WME of the calibrated wall", "mean WME of the best there"];
    Table::of("What law and capture velocity do: searches with fewer simulations", &head, rows)
}

/// Measured rotations: dark grey under the simulated ones.
const MEASURED: Colour = PALETTE[6];

/// Measured against simulated; a sentence where the tests are no longer at hand.
pub fn histories(tests: Option<&[TestRotations]>, stored: &Calibration) -> Section {
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

//! Figures 7 and 8: measured rotations, and those of the calibrated wall in the same tests, simulated again.

use std::path::Path;

use super::super::chart::{Axis, Colour, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section};
use super::super::provenance::{Note, found_again};
use super::wme;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::History;
use mrbd_lab::calibrate::{Calibration, Experiment, TestResult};
use mrbd_lab::experiment::Measured;

/// Measured rotations: dark grey under the simulated ones.
const MEASURED: Colour = PALETTE[6];
/// Rows of a simulated history, s.
const STEP_S: f64 = 0.01;

/// The experiment as it was calibrated, read again.
pub struct Again {
    experiment: Experiment,
    wall: Wall,
}

impl Again {
    /// The experiment, if its files are still where they were and still the same.
    pub fn of(folder: &Path, note: &Note, stored: &Calibration) -> Option<Self> {
        let path = found_again(folder, &note.inputs, "experiment")?;
        let experiment = Experiment::load(&path, Some(stored.seed)).ok()?;
        if experiment.request != stored.request_sha256 {
            return None;
        }
        let wall = experiment.space.wall(&stored.joint.values).ok()?;
        Some(Self { experiment, wall })
    }
}

/// The section; a sentence where the tests are no longer at hand.
pub fn section(again: Option<&Again>, stored: &Calibration) -> Section {
    let mut section =
        Section { id: "histories".into(), title: "Measured against simulated".into(), ..Section::default() };
    let Some(again) = again else {
        section.text.push(
            "The experiment’s files are no longer where the calibration read them, or are other ones now: its histories cannot be drawn.".into(),
        );
        return section;
    };
    section.text.push(
        "The calibrated wall in every test, from rest; tests held out were not seen by the search.".into(),
    );
    for (index, test) in stored.tests.iter().enumerate() {
        section.figures.push(figure(again, index, test));
    }
    section
}

fn figure(again: &Again, index: usize, test: &TestResult) -> Figure {
    let simulated = simulated(again, index);
    let alpha = again.wall.alpha_i_rad();
    let measured = &again.experiment.tests[index].measured;
    let mut panels = Vec::new();
    let bodies = if again.wall.is_cracked() { 2 } else { 1 };
    for (body, &alpha) in alpha.iter().enumerate().take(bodies) {
        let measured = measured_line(measured, body, alpha);
        let line = simulated.rows.iter().map(|row| (row.time_s, row.theta_rad[body] / alpha)).collect();
        panels.push(panel(body, measured, line));
    }
    let held = if test.purpose == "fit" { "to fit" } else { "held out" };
    Figure {
        id: format!("test-{}", index + 1),
        title: format!("{}, {held}", test.name),
        paper: Some("Figs. 7 and 8".into()),
        legend: vec![
            key("measured", MEASURED),
            key("simulated, lower body", PALETTE[0]),
            key("simulated, upper body", PALETTE[1]),
        ],
        panels,
        wide: true,
        caption: format!(
            "Rotations over slenderness angles; simulated up to the end of what counts. WME {} with the calibrated wall, {} before.",
            wme(test.wme_joint),
            wme(test.wme_before)
        ),
        links: vec![Link::to("calibration.json")],
    }
}

fn key(label: &str, colour: Colour) -> Key {
    Key::new(label, colour, Mark::None)
}

fn simulated(again: &Again, index: usize) -> History {
    again.experiment.tests[index].history(&again.wall, again.experiment.accuracy(), STEP_S)
}

/// Measured samples, broken where samples are missing; none for a channel that is lost.
fn measured_line(measured: &Measured, body: usize, alpha_rad: f64) -> Vec<(f64, f64)> {
    let Some(theta) = &measured.theta_rad[body] else { return Vec::new() };
    let mut line: Vec<(f64, f64)> = Vec::new();
    for (&time_s, theta) in measured.time_s.iter().zip(theta) {
        if line.last().is_some_and(|last| time_s - last.0 > measured.gap_s) {
            line.push((time_s, f64::NAN));
        }
        line.push((time_s, theta / alpha_rad));
    }
    line
}

fn panel(body: usize, measured: Vec<(f64, f64)>, simulated: Vec<(f64, f64)>) -> String {
    let end_s = simulated.iter().chain(&measured).map(|point| point.0).fold(0.0, f64::max);
    let label = ["θ₁/α₁", "θ₂/α₂"][body];
    let values = measured.iter().chain(&simulated).map(|point| point.1);
    let line = |name: &str, colour, width, points| Layer::Line {
        colour,
        width,
        dashed: false,
        name: name.to_owned(),
        points,
    };
    Graph {
        title: String::new(),
        format: Format::Low,
        x: Axis::linear("time s", 0.0, end_s),
        y: Axis::holding(label, values),
        layers: vec![line("measured", MEASURED, 6, measured), line("simulated", PALETTE[body], 4, simulated)],
    }
    .svg()
}

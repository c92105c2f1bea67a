//! Measured rotations against whole runs, before and after.

use std::path::Path;

use super::super::chart::{Axis, Colour, Format, Graph, Layer, Mark};
use super::super::page::{Figure, Link, Section, Table};
use super::columns::Columns;
use super::{AFTER, BEFORE, MEASURED, key};
use crate::error::Result;
use mrbd_kernel::model::PATTERN_NAMES;
use mrbd_lab::diagnose::answer::{BeforeAfter, Summary, TestErrors};
use mrbd_lab::experiment_file::Purpose;

/// Most tests drawn in one section.
const MOST: usize = 3;
/// Least time between drawn points, s.
const STEP_S: f64 = 0.01;
/// A motion is over where it stays below this share of its largest, but for as long after it, s.
const OVER: f64 = 0.03;
const AFTERWARDS_S: f64 = 1.0;
/// Times farther apart than this many of the usual distances leave a gap.
const GAP: f64 = 2.5;

const NAMES: [&str; 9] = [
    "pattern_measured",
    "test",
    "time_s",
    "theta1_measured_rad",
    "theta2_measured_rad",
    "theta1_before_rad",
    "theta2_before_rad",
    "theta1_after_rad",
    "theta2_after_rad",
];

/// The samples of all tests.
pub struct Histories {
    test: Vec<String>,
    time_s: Vec<f64>,
    /// Index into [`PATTERN_NAMES`], where the measured pattern is beyond doubt.
    pattern: Vec<Option<usize>>,
    /// Measured, before, after; lower and upper body; thousandths of a radian.
    theta_mrad: [[Vec<f64>; 2]; 3],
}

impl Histories {
    /// Reads them.
    ///
    /// # Errors
    /// Input errors for a file that is no such table.
    pub fn read(path: &Path) -> Result<Self> {
        let columns = Columns::read(path, &NAMES)?;
        let mrad =
            |name: &str| -> Result<Vec<f64>> { Ok(columns.numbers(name)?.iter().map(|x| 1e3 * x).collect()) };
        let both = |when: &str| -> Result<[Vec<f64>; 2]> {
            Ok([mrad(&format!("theta1_{when}_rad"))?, mrad(&format!("theta2_{when}_rad"))?])
        };
        let index = |name: String| PATTERN_NAMES.iter().position(|known| *known == name);
        Ok(Self {
            test: columns.labels("test")?,
            pattern: columns.labels("pattern_measured")?.into_iter().map(index).collect(),
            time_s: columns.numbers("time_s")?,
            theta_mrad: [both("measured")?, both("before")?, both("after")?],
        })
    }

    /// Stretches of a test in which the measured pattern is beyond doubt: index into [`PATTERN_NAMES`], from, to, s.
    pub fn patterns(&self, test: &str) -> Vec<(usize, f64, f64)> {
        let rows = (0..self.time_s.len()).filter(|&k| self.test[k] == test).collect::<Vec<_>>();
        let same = rows.chunk_by(|&a, &b| self.pattern[a] == self.pattern[b]);
        let stretch = |part: &[usize]| {
            let [first, last] = [part[0], part[part.len() - 1]];
            Some((self.pattern[first]?, self.time_s[first], self.time_s[last]))
        };
        same.filter_map(stretch).collect()
    }

    /// When the motion of a test begins and when it is over, s, with some rest about it.
    pub fn motion_s(&self, test: &str) -> [f64; 2] {
        let rows = (0..self.time_s.len()).filter(|&k| self.test[k] == test);
        let size = |k: usize| {
            let all = self.theta_mrad.iter().flatten().map(|theta| theta[k].abs());
            all.filter(|x| x.is_finite()).fold(0.0, f64::max)
        };
        let sizes = rows.map(|k| (self.time_s[k], size(k))).collect::<Vec<_>>();
        let largest = sizes.iter().map(|s| s.1).fold(0.0, f64::max);
        let mut moving = sizes.iter().filter(|s| s.1 > OVER * largest).map(|s| s.0);
        let [first, last] = [moving.next(), moving.next_back()].map(|t| t.unwrap_or(0.0));
        let end_s = sizes.last().map_or(0.0, |s| s.0);
        [(first - AFTERWARDS_S).max(0.0), (last.max(first) + AFTERWARDS_S).min(end_s)]
    }

    /// One line of one test, thinned.
    fn line(&self, test: &str, which: usize, body: usize) -> Vec<(f64, f64)> {
        let rows = (0..self.time_s.len()).filter(|&k| self.test[k] == test);
        let mut line: Vec<(f64, f64)> = Vec::new();
        let mut step_s = f64::INFINITY;
        for k in rows {
            let t = self.time_s[k];
            if let Some(last) = line.last() {
                let passed = t - last.0;
                if passed < STEP_S * (1.0 - 1e-6) {
                    continue;
                }
                if passed > GAP * step_s.min(passed).max(STEP_S) {
                    line.push((t, f64::NAN));
                }
                step_s = step_s.min(passed);
            }
            line.push((t, self.theta_mrad[which][body][k]));
        }
        line
    }

    fn figure(&self, test: &TestErrors, with_after: bool) -> Result<Figure> {
        let panels = [0, 1].map(|body| self.panel(&test.name, body, with_after));
        let mut legend =
            vec![key("measured", MEASURED, Mark::None), key("simulated, wall as given", BEFORE, Mark::None)];
        if with_after {
            legend.push(key("simulated, updated wall", AFTER, Mark::None));
        }
        let held = if test.purpose == Purpose::Fit { "to fit" } else { "held out" };
        Ok(Figure {
            id: format!("{}-{}", if with_after { "after" } else { "before" }, anchor(&test.name)),
            title: format!("{}, {held}", test.name),
            paper: Some("Figs. 7 and 8".into()),
            legend,
            panels: panels.into_iter().collect::<Result<_>>()?,
            wide: true,
            caption: format!(
                "Whole runs from rest; the quiet before and after the motion is left out. WME {}; windowed error {} times the noise.",
                told(&test.wme, with_after, 3),
                told(&test.windowed_error, with_after, 2)
            ),
            links: vec![Link::to("histories.parquet")],
        })
    }

    fn panel(&self, test: &str, body: usize, with_after: bool) -> Result<String> {
        let lines: Vec<_> = (0..if with_after { 3 } else { 2 }).map(|w| self.line(test, w, body)).collect();
        let [from_s, to_s] = self.motion_s(test);
        let shown = |p: &(f64, f64)| (from_s..=to_s).contains(&p.0);
        let lines = lines.into_iter().map(|line| line.into_iter().filter(shown).collect::<Vec<_>>());
        let lines = lines.collect::<Vec<_>>();
        let values = lines.iter().flatten().map(|p| p.1).filter(|y| y.is_finite());
        let layer = |name: &str, colour: Colour, width, points: &[(f64, f64)]| Layer::Line {
            colour,
            width,
            dashed: false,
            name: name.to_owned(),
            points: points.to_vec(),
        };
        let mut layers = vec![
            layer("measured", MEASURED, 7, &lines[0]),
            layer("simulated, wall as given", BEFORE, 3, &lines[1]),
        ];
        layers.extend(lines.get(2).map(|line| layer("simulated, updated wall", AFTER, 4, line)));
        Ok(Graph {
            title: String::new(),
            format: Format::Low,
            x: Axis::linear("time s", from_s, to_s),
            y: Axis::holding(["θ₁ mrad", "θ₂ mrad"][body], values),
            layers,
        }
        .svg())
    }
}

fn told(of: &BeforeAfter<Option<f64>>, with_after: bool, digits: usize) -> String {
    let text = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.digits$}"));
    match with_after {
        true => format!("{} before, {} after", text(of.before), text(of.after)),
        false => text(of.before),
    }
}

/// A name as an anchor.
fn anchor(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect()
}

/// Tests of a purpose, those followed worst first.
fn worst(summary: &Summary, purpose: Purpose) -> Vec<&TestErrors> {
    let mut tests = summary.tests.iter().filter(|test| test.purpose == purpose).collect::<Vec<_>>();
    let error = |test: &TestErrors| test.windowed_error.before.unwrap_or(0.0);
    tests.sort_by(|a, b| error(b).total_cmp(&error(a)));
    tests
}

/// The first section: the wall as given in the tests to fit.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn measured_section(histories: &Histories, summary: &Summary) -> Result<Section> {
    let tests = worst(summary, Purpose::Fit);
    let text = match tests.len() > MOST {
        true => format!("The wall as given, in the {MOST} tests it follows worst; all are in the table."),
        false => "The wall as given, in the tests it is fitted to.".to_owned(),
    };
    Ok(Section {
        id: "measured".into(),
        title: "Measured against simulated".into(),
        text: vec![text],
        figures: tests.into_iter().take(MOST).map(|t| histories.figure(t, false)).collect::<Result<_>>()?,
        tables: vec![table(summary)],
        ..Section::default()
    })
}

fn table(summary: &Summary) -> Table {
    let row = |test: &TestErrors| {
        let text = |x: Option<f64>, digits: usize| x.map_or("–".to_owned(), |x| format!("{x:.digits$}"));
        let [lower, upper] = test.noise_rad.map(|sd| format!("{:.1}", 1e6 * sd));
        vec![
            test.name.clone(),
            if test.purpose == Purpose::Fit { "to fit" } else { "held out" }.to_owned(),
            text(test.windowed_error.before, 2),
            text(test.windowed_error.after, 2),
            text(test.wme.before, 3),
            text(test.wme.after, 3),
            format!("{lower}, {upper}"),
        ]
    };
    let head = ["test", "use", "error before", "after", "WME before", "after", "noise of θ₁, θ₂, µrad"];
    Table::of(
        "The tests: windowed error in units of the noise, and WME (Eq. 8)",
        &head,
        summary.tests.iter().map(row),
    )
}

/// Before and after on tests held out; on the tests to fit where none was.
///
/// # Errors
/// [`crate::Error::Picture`] if plotters refuses.
pub fn held_out_section(histories: &Histories, summary: &Summary) -> Result<Section> {
    let mut tests = worst(summary, Purpose::HoldOut);
    let mut text = "The updated wall in tests that no fit has seen.".to_owned();
    if tests.is_empty() {
        tests = worst(summary, Purpose::Fit);
        text = "No test was held out; these are tests that were fitted.".into();
    }
    if !summary.has_updated_wall() {
        text = "The wall stays as it is: what follows is the wall as given.".into();
    }
    let with_after = summary.has_updated_wall();
    let figures = tests.into_iter().take(MOST).map(|t| histories.figure(t, with_after));
    Ok(Section {
        id: "held-out".into(),
        title: "Before and after on held-out tests".into(),
        text: vec![text],
        figures: figures
            .map(|f| f.map(|f| Figure { id: format!("held-{}", f.id), ..f }))
            .collect::<Result<_>>()?,
        ..Section::default()
    })
}

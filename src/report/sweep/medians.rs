//! Figures 12, 14 to 17 and 20: medians over the records against slenderness, a curve a level.

use super::super::chart::{Axis, CurvePoint, Format, Graph, Layer, of_curve};
use super::super::page::{Figure, Key, Link, Section};
use super::super::{rotations, words};
use crate::aggregate::{Measure, Median, Middle};
use crate::findings::{Slender, View};
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// θ/α the paper calls significant (sections 4.3 and 5).
pub(super) const SIGNIFICANT: (f64, &str) = (0.05, "significant, 0.05");

/// The section with a figure for each parameter.
pub fn section(view: &View, records: usize) -> Section {
    let (title, what) = match records {
        1 => ("Under the one record", "The largest rotation of each body under the one record"),
        _ => ("Medians over the records", "The median over the records of the largest rotation of each body"),
    };
    let hollow = match records {
        1 => "",
        _ => {
            " A hollow point: some records did, the median one did not. Bands: where the median lies in nine of ten draws of the records and of the ensembles of the runs; to the end of the axis where it may be a collapse."
        }
    };
    Section {
        id: "medians".into(),
        title: title.into(),
        text: vec![format!(
            "{what}, over the slenderness angle of that body. A cross in the red band above the axis: the wall collapsed under the median record.{hollow} Press a level to see it alone."
        )],
        figures: rows(view).iter().map(|row| figure(view, row, records)).collect(),
        ..Section::default()
    }
}

/// A figure's parameters, one a floor: the paper puts the two kinds of floor mass into one figure.
type Row = Vec<(Configuration, Parameter)>;

fn rows(view: &View) -> Vec<Row> {
    let place = |parameter| match parameter {
        Parameter::Thickness => 12,
        Parameter::CrackHeight => 14,
        Parameter::Strength => 15,
        Parameter::Stiffness => 16,
        Parameter::DiaphragmMass | Parameter::CarriageMass => 17,
        Parameter::Restitution => 20,
    };
    let of = |number: u32| -> Row {
        let parameters = |c: Configuration| view.parameters(c).into_iter().map(move |p| (c, p));
        Configuration::ALL.into_iter().flat_map(parameters).filter(|(_, p)| place(*p) == number).collect()
    };
    [12, 14, 15, 16, 17, 20].map(of).into_iter().filter(|row| !row.is_empty()).collect()
}

fn figure(view: &View, row: &Row, records: usize) -> Figure {
    let frame = Frame::of(view, row);
    let mut panels = Vec::new();
    for body in Measure::BODIES {
        for &(configuration, parameter) in row {
            panels.push(frame.panel(view, configuration, parameter, body).svg());
        }
    }
    let mut names: Vec<&str> = row.iter().map(|&(_, p)| words::parameter(p)).collect();
    names.dedup();
    let first = row[0].1;
    let number = match first {
        Parameter::Thickness => "Fig. 12",
        Parameter::CrackHeight => "Fig. 14",
        Parameter::Strength => "Fig. 15",
        // The paper takes the stiffness through one unscaled record too.
        Parameter::Stiffness if records == 1 => "Fig. 21",
        Parameter::Stiffness => "Fig. 16",
        Parameter::DiaphragmMass | Parameter::CarriageMass => "Fig. 17",
        Parameter::Restitution => "Fig. 20",
    };
    Figure {
        id: first.name().replace('_', "-"),
        title: format!("Influence of the {}", names.join(" and ")),
        paper: Some(number.into()),
        legend: legend(view, row),
        panels,
        caption: caption(view, row, records),
        links: vec![Link::to("medians.parquet")],
        ..Figure::default()
    }
}

fn caption(view: &View, row: &Row, records: usize) -> String {
    let what =
        if records == 1 { "Largest rotation" } else { "Median over the records of the largest rotation" };
    let mut caption = format!(
        "{what}, by slenderness h/b; the other parameters at their means. Dashed line: 0.05, which the paper calls significant."
    );
    let value = |of: &(Configuration, Parameter), level| of_level(view, of.0, of.1, level)?.parameter_value;
    if row.iter().any(|of| are_reversed(value(of, Level::Low), value(of, Level::High))) {
        caption
            .push_str(" The value at μ − σ is the larger one: the survey’s table has the two in this order.");
    }
    caption
}

/// Whether the value named μ − σ is larger than that named μ + σ.
fn are_reversed(low: Option<f64>, high: Option<f64>) -> bool {
    low.zip(high).is_some_and(|(low, high)| low > high)
}

/// One key a level; where the floors differ in its value, both are told.
fn legend(view: &View, row: &Row) -> Vec<Key> {
    let key = |level: Level| {
        let label = |&(configuration, parameter): &(Configuration, Parameter)| {
            let value = of_level(view, configuration, parameter, level).and_then(|row| row.parameter_value);
            words::level(parameter, level, value)
        };
        let mut labels: Vec<String> = row.iter().map(label).collect();
        labels.dedup();
        if let [a, b] = &labels[..] {
            let value = b.split_once(": ").map_or(b.as_str(), |(_, value)| value);
            labels = vec![format!("{a} (perpendicular), {value} (parallel)")];
        }
        let (colour, mark) = of_curve(level.index());
        Key::new(labels.concat(), colour, mark)
    };
    Level::ALL.map(key).to_vec()
}

fn of_level<'a>(
    view: &View<'a>,
    configuration: Configuration,
    parameter: Parameter,
    level: Level,
) -> Option<&'a Median> {
    let of = (configuration, parameter, level);
    view.rows().find(|row| (row.case.configuration, row.case.parameter, row.case.level) == of)
}

/// What the panels of a figure share, so that they can be compared by eye.
struct Frame {
    shown: Vec<Middle>,
}

impl Frame {
    fn of(view: &View, row: &Row) -> Self {
        let shown = |median: &&Median| {
            row.contains(&(median.case.configuration, median.case.parameter))
                && Measure::BODIES.contains(&median.measure)
        };
        Self { shown: view.rows().filter(shown).filter_map(Median::middle).collect() }
    }

    fn panel(&self, view: &View, configuration: Configuration, parameter: Parameter, body: Measure) -> Graph {
        let curve = |level: Level| {
            let point = |slenderness: f64| {
                let median = view.row(configuration, parameter, level, (slenderness, body))?;
                point(median, body)
            };
            let points = view.slendernesses(Slender::Any).into_iter().filter_map(point).collect();
            rotations::curve(level.index(), Level::ALL.len(), points)
        };
        let mut graph =
            over_slenderness(view, &self.shown, (configuration, body), Level::ALL.map(curve).to_vec());
        let rows = |level: Level| {
            let points = view.slendernesses(Slender::Any).into_iter();
            points
                .filter_map(move |slenderness| view.row(configuration, parameter, level, (slenderness, body)))
        };
        let top = graph.y.ends()[1];
        graph.layers.splice(0..0, Level::ALL.map(|level| band(level, top, rows(level))));
        graph
    }
}

/// Where the medians of a level lie in nine of ten draws; up to the end of the axis where they may be collapses.
fn band<'a>(level: Level, top: f64, rows: impl Iterator<Item = &'a Median>) -> Layer {
    let ends = |row: &Median| {
        let [low, high] = row.interval?.map(|end| rotations::number(&end).unwrap_or(top));
        Some((row.case.slenderness, low, high))
    };
    Layer::Band { colour: of_curve(level.index()).0, points: rows.filter_map(ends).collect() }
}

/// Curves of a body under a floor, over slenderness.
pub(super) fn over_slenderness(
    view: &View,
    shown: &[Middle],
    (configuration, body): (Configuration, Measure),
    curves: Vec<Layer>,
) -> Graph {
    let significant = Layer::Threshold { y: SIGNIFICANT.0, name: SIGNIFICANT.1 };
    Graph {
        title: title(configuration, body),
        format: Format::Half,
        x: slenderness_axis(view),
        y: rotations::axis(y_label(body), shown, SIGNIFICANT.0),
        layers: std::iter::once(significant).chain(curves).collect(),
    }
}

fn point(median: &Median, body: Measure) -> Option<CurvePoint> {
    let y = median.middle()?;
    let case = &median.case;
    let value = match y {
        Middle::Rotation(rotation) => format!("median {} = {rotation:.4}", y_label(body)),
        Middle::Collapsed => "the median record collapsed".into(),
    };
    let tip = format!(
        "{}\nh/b {}: {value}{}\n{} of {} records collapsed",
        words::level(case.parameter, case.level, median.parameter_value),
        case.slenderness,
        median.interval.map_or_else(String::new, of_draws),
        median.collapsed,
        median.runs - median.failed
    );
    Some(CurvePoint { x: case.slenderness, y: rotations::number(&y), hollow: median.collapsed > 0, tip })
}

fn of_draws(interval: [Middle; 2]) -> String {
    let [low, high] = interval.map(|end| match end {
        Middle::Rotation(rotation) => format!("{rotation:.4}"),
        Middle::Collapsed => "collapse".to_owned(),
    });
    format!("\n{low} to {high} in nine of ten draws")
}

fn title(configuration: Configuration, body: Measure) -> String {
    let body = if body == Measure::LowerOwn { "lower body" } else { "upper body" };
    format!("{}: {body}", words::floor(configuration))
}

pub(super) fn y_label(body: Measure) -> &'static str {
    if body == Measure::LowerOwn { "max |θ₁|/α₁" } else { "max |θ₂|/α₂" }
}

/// All slendernesses with room at both sides.
fn slenderness_axis(view: &View) -> Axis {
    let all = view.slendernesses(Slender::Any);
    let (first, last) = (all.first().copied().unwrap_or(0.0), all.last().copied().unwrap_or(1.0));
    let room = (0.06 * (last - first)).max(0.5);
    Axis::linear("slenderness h/b", first - room, last + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_levels_are_told_to_be_reversed_where_they_are() {
        assert!(are_reversed(Some(0.73), Some(0.52)) && !are_reversed(Some(0.2), Some(0.4)));
        // Coefficients of restitution have levels and no value.
        assert!(!are_reversed(None, None));
    }
}

//! The façades that were drawn, against the distributions of the survey.

use super::super::chart::{Axis, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section};
use super::titled;
use crate::summary::{FloorSamples, Samples};
use crate::survey::sampling::{Marginal, Variable};

/// Bars of a histogram.
const BARS: usize = 24;
/// Points of a density.
const POINTS: u32 = 160;

/// The section: a figure a floor, a panel a variable that varies.
pub fn section(samples: &Samples, links: &[Link]) -> Section {
    let mut section = titled("samples", "The façades drawn, against the survey");
    if !samples.has_survey {
        section.text.push(
            "The survey is no longer where the study read it, or is another one now: its distributions cannot be drawn.".into(),
        );
    }
    section.figures = samples.floors.iter().map(|floor| figure(floor, links)).collect();
    section
}

fn figure(floor: &FloorSamples, links: &[Link]) -> Figure {
    let key = |label: &str, index: usize| Key::new(label, PALETTE[index], Mark::None);
    let variables = floor.variables.iter();
    Figure {
        id: format!("samples-{}", floor.configuration.name()),
        title: format!("{} floor: {} façades", floor.configuration.name(), floor.facades),
        legend: vec![key("drawn", 5), key("survey", 1)],
        panels: variables.map(|(variable, values, survey)| panel(*variable, values, survey.as_ref())).collect(),
        caption: "Bars: density of the values that were drawn. Line: the log-normal distribution of the survey, cut where the study cuts it.".into(),
        links: links.to_vec(),
        ..Figure::default()
    }
}

/// How a variable is shown: its name with a unit that people use, and the factor to that unit.
fn shown(variable: Variable) -> (&'static str, f64) {
    match variable {
        Variable::Thickness => ("thickness b, m", 1.0),
        Variable::Slenderness => ("slenderness h/b", 1.0),
        Variable::CrackHeight => ("height of the crack h₁/h", 1.0),
        Variable::Strength => ("compressive strength f, MPa", 1e-6),
        Variable::Stiffness => ("stiffness of the floor k_d, MN/m", 1e-6),
        Variable::DiaphragmMass => ("mass of the floor m_d/m_tot", 1.0),
        Variable::CarriageMass => ("horizontal mass of the floor m_dp/m_tot", 1.0),
    }
}

fn panel(variable: Variable, values: &[f64], survey: Option<&Marginal>) -> String {
    let (label, factor) = shown(variable);
    let mut sorted: Vec<f64> = values.iter().map(|value| factor * value).collect();
    sorted.sort_by(f64::total_cmp);
    // The longest tail is not shown: it would press everything else together.
    let low = sorted[0];
    let high = sorted[(sorted.len() - 1).min(sorted.len() * 995 / 1000)];
    let width = ((high - low) / BARS as f64).max(f64::MIN_POSITIVE);
    let bar = |k: usize| {
        let (from, to) = (low + k as f64 * width, low + (k + 1) as f64 * width);
        let count = sorted.iter().filter(|v| **v >= from && **v < to).count();
        (from, to, count as f64 / sorted.len() as f64 / width)
    };
    let bars: Vec<_> = (0..BARS).map(bar).collect();
    let density = survey.map(|marginal| density(marginal, factor, [low, high])).unwrap_or_default();
    let heights = bars.iter().map(|bar| bar.2).chain(density.iter().map(|point| point.1));
    Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::linear(label, low, high),
        y: Axis::holding("density", heights),
        layers: vec![
            Layer::Bars { colour: PALETTE[5], bars },
            Layer::Line {
                colour: PALETTE[1],
                width: 3,
                dashed: false,
                name: "survey".into(),
                points: density,
            },
        ],
    }
    .svg()
}

/// The density of a distribution in the unit that is shown, from its quantiles.
fn density(marginal: &Marginal, factor: f64, [low, high]: [f64; 2]) -> Vec<(f64, f64)> {
    if !marginal.varies() {
        return Vec::new();
    }
    let step = 1.0 / f64::from(POINTS);
    let point = |k: u32| {
        let u = (f64::from(k) + 0.5) * step;
        let quantile = |u: f64| factor * marginal.quantile(u);
        (quantile(u), 0.8 * step / (quantile(u + 0.4 * step) - quantile(u - 0.4 * step)))
    };
    (0..POINTS).map(point).filter(|(x, _)| (low..=high).contains(x)).collect()
}

//! Figure 6: how the searches converged.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, of_curve};
use super::super::page::{Figure, Key, Link, Section, Table};
use super::wme;
use mrbd_lab::calibrate::{Calibration, MethodResult};

/// The section.
pub fn section(stored: &Calibration) -> Section {
    let mut names: Vec<&str> = searches(stored).map(|m| m.method.as_str()).collect();
    names.dedup();
    let mut seen: Vec<&str> = Vec::new();
    names.retain(|name| {
        !seen.contains(name) && {
            seen.push(name);
            true
        }
    });
    let mut groups: Vec<Option<&str>> = Vec::new();
    for method in searches(stored) {
        if !groups.contains(&method.test.as_deref()) {
            groups.push(method.test.as_deref());
        }
    }
    let panels = groups.into_iter().map(|test| panel(stored, &names, test)).collect();
    let legend = names.iter().enumerate().map(|(index, name)| {
        let (colour, mark) = of_curve(index);
        Key::new(*name, colour, mark)
    });
    Section {
        id: "convergence".into(),
        title: "How the searches converged".into(),
        figures: vec![Figure {
            id: "convergence-figure".into(),
            title: "Lowest cost by generation".into(),
            paper: Some("Fig. 6".into()),
            legend: legend.collect(),
            panels,
            caption: "Lowest cost found so far (WME, raised by what was known beforehand), by generation of each search. Searches that end in different valleys say that the misfit is rough.".into(),
            links: vec![Link::to("generations.parquet")],
            ..Figure::default()
        }],
        tables: vec![table(stored)],
        ..Section::default()
    }
}

/// Searches that went through generations.
fn searches(stored: &Calibration) -> impl Iterator<Item = &MethodResult> {
    stored.methods.iter().filter(|m| m.best_costs.iter().filter(|cost| cost.is_finite()).count() > 1)
}

fn panel(stored: &Calibration, names: &[&str], test: Option<&str>) -> String {
    let own: Vec<&MethodResult> = searches(stored).filter(|m| m.test.as_deref() == test).collect();
    let costs = || own.iter().flat_map(|m| &m.best_costs).copied().filter(|cost| cost.is_finite());
    let longest = own.iter().map(|m| m.best_costs.len()).max().unwrap_or(1);
    let mut layers = Vec::new();
    for method in &own {
        let index = names.iter().position(|name| *name == method.method).unwrap_or(0);
        let (colour, mark) = of_curve(index);
        let numbered = (0..).map(f64::from).zip(&method.best_costs);
        let finite = |cost: f64| if cost.is_finite() { cost } else { f64::NAN };
        let points: Vec<(f64, f64)> = numbered.map(|(g, cost)| (g, finite(*cost))).collect();
        let tip = |&(x, y): &(f64, f64)| Dot {
            x,
            y,
            tip: format!("{}, generation {x}\nlowest cost {y:.4}", method.method),
        };
        let dots = points.iter().filter(|point| point.1.is_finite()).map(tip).collect();
        layers.push(Layer::Line { colour, width: 2, dashed: false, name: String::new(), points });
        layers.push(Layer::Dots { colour, mark, size: 4, hollow: false, dots });
    }
    Graph {
        title: test.unwrap_or("all tests to fit").to_owned(),
        format: Format::Half,
        x: Axis::linear("generation", 0.0, (longest - 1).max(1) as f64),
        y: Axis::log_holding("lowest cost", costs()),
        layers,
    }
    .svg()
}

fn table(stored: &Calibration) -> Table {
    let row = |m: &MethodResult| {
        let test = m.test.clone().unwrap_or_else(|| "all, mean".to_owned());
        vec![m.method.clone(), test, wme(stored.wme_of(m)), m.simulations.to_string()]
    };
    Table::of("The searches", &["search", "test", "WME", "simulations"], stored.methods.iter().map(row))
}

//! The page of a survey's façades: ζ of the code's check beside ζ of the dynamics.

use std::path::Path;

use super::chart::{Axis, COLLAPSE, Colour, Dot, Format, Graph, INK, Layer, Mark, PALETTE};
use super::page::{Figure, Key, Link, Number, Page, Section, Table};
use super::provenance::{Note, read_json};
use super::words::floor;
use crate::assessment::portfolio::{ByFactor, LADDER, Portfolio, Row, agreement_name};
use crate::error::Result;
use crate::survey::Configuration;
use mrbd_assessment::Agreement;

/// The page of a folder of `mrbd assess-survey`.
///
/// # Errors
/// Input errors for files that are none of such results.
pub fn page(folder: &Path) -> Result<Page> {
    let note = Note::read(&folder.join("manifest.json"))?;
    let all: Portfolio =
        read_json(&folder.join("portfolio.json"), "assessments as `mrbd assess-survey` writes them")?;
    let mut notes: Vec<String> = note.generated_note().into_iter().collect();
    notes.push(format!(
        "ζ static has the confidence factor {} in it, ζ dynamic has none. Thickness and slenderness vary, all else is at μ.",
        all.confidence_factor
    ));
    Ok(Page {
        title: format!("Façades of the survey at {}", all.site),
        lead: "Every point is a façade that stands for the same share of the stock: the code's nonlinear check against the dynamics of the same wall.".into(),
        numbers: numbers(&all),
        notes,
        sections: vec![Section {
            id: "facades".into(),
            title: "Static and dynamic".into(),
            figures: vec![against(&all), along(&all), by_factor(&all)],
            tables: vec![shares(&all)],
            ..Section::default()
        }],
        provenance: note.pairs(),
        files: ["portfolio.json", "portfolio.parquet"].map(Link::to).to_vec(),
        ..Page::default()
    })
}

fn numbers(all: &Portfolio) -> Vec<Number> {
    let share = |agreement: Agreement| {
        let count = all.rows.iter().filter(|row| row.agreement == agreement).count();
        format!("{:.0} %", 100.0 * count as f64 / all.rows.len().max(1) as f64)
    };
    vec![
        Number::new(all.rows.len(), "façades"),
        Number::new(share(Agreement::StaticRefuses), "the code refuses, the dynamics accept"),
        Number::new(share(Agreement::DynamicRefuses), "the code accepts, the dynamics refuse"),
    ]
}

/// ζ dynamic against ζ static.
fn against(all: &Portfolio) -> Figure {
    Figure {
        id: "against".into(),
        title: "ζ dynamic against ζ static".into(),
        legend: vec![
            Key::new("both accept", PALETTE[2], Mark::Circle),
            Key::new("both refuse", PALETTE[6], Mark::Circle),
            Key::new("the code refuses what stands", PALETTE[0], Mark::Square),
            Key::new("the code accepts what falls", COLLAPSE, Mark::Triangle),
        ],
        panels: Configuration::ALL.map(|configuration| against_graph(all, configuration).svg()).to_vec(),
        caption: format!(
            "Façades that the dynamics accept at every factor stand at {}. Broken lines: ζ = 1, and equal ζ.",
            LADDER.range[1]
        ),
        links: vec![Link::to("portfolio.parquet")],
        ..Figure::default()
    }
}

/// ζ static and ζ dynamic; a façade that is always accepted stands at the last factor.
fn zetas(row: &Row) -> Option<(f64, f64)> {
    let always = row.always_accepted.then_some(LADDER.range[1]);
    Some((row.zeta_static?, row.zeta_dynamic.or(always)?))
}

fn against_graph(all: &Portfolio, configuration: Configuration) -> Graph {
    let dot = |row: &Row| {
        let (x, y) = zetas(row)?;
        let (b, slenderness, mechanism) = (row.thickness_m, row.slenderness, row.mechanism.replace('_', " "));
        let tip = format!("b {b:.2} m, h/b {slenderness:.1}\nζ static {x:.2}, dynamic {y:.2}\n{mechanism}");
        Some(Dot { x, y, tip })
    };
    let layer = |agreement, colour, mark| {
        let own =
            all.rows.iter().filter(|row| row.configuration == configuration && row.agreement == agreement);
        Layer::Dots { colour, mark, size: 6, hollow: false, dots: own.filter_map(dot).collect() }
    };
    let values: Vec<f64> = all.rows.iter().filter_map(zetas).flat_map(|(x, y)| [x, y]).collect();
    let axis = |label: &str| Axis::log_holding(label, values.iter().copied().chain([0.5, 2.0]));
    let [low, high] = axis("").ends();
    let line = |points| Layer::Line { colour: INK, width: 1, dashed: true, name: String::new(), points };
    Graph {
        title: floor(configuration).to_owned(),
        format: Format::Half,
        x: axis("ζ static"),
        y: axis("ζ dynamic"),
        layers: vec![
            line(vec![(low, low), (high, high)]),
            line(vec![(1.0, low), (1.0, high)]),
            line(vec![(low, 1.0), (high, 1.0)]),
            layer(Agreement::BothAccept, PALETTE[2], Mark::Circle),
            layer(Agreement::BothRefuse, PALETTE[6], Mark::Circle),
            layer(Agreement::StaticRefuses, PALETTE[0], Mark::Square),
            layer(Agreement::DynamicRefuses, COLLAPSE, Mark::Triangle),
        ],
    }
}

/// Name, colour and value of a curve of shares.
type ShareCurve = (&'static str, Colour, fn(&ByFactor) -> f64);

/// Shares refused by one check alone, by the factor on site and records.
fn by_factor(all: &Portfolio) -> Figure {
    let curves: [ShareCurve; 3] = [
        ("both refuse", PALETTE[6], |at| at.both_refuse),
        ("the code refuses what stands", PALETTE[0], |at| at.static_refuses),
        ("the code accepts what falls", COLLAPSE, |at| at.dynamic_refuses),
    ];
    let panel = |configuration: Configuration| {
        let own = all.by_factor.iter().filter(|at| at.configuration == configuration);
        let own: Vec<&ByFactor> = own.collect();
        let layer = |(name, colour, share): ShareCurve| Layer::Line {
            colour,
            width: 3,
            dashed: false,
            name: name.to_owned(),
            points: own.iter().map(|at| (at.factor, share(at))).collect(),
        };
        Graph {
            title: floor(configuration).to_owned(),
            format: Format::Half,
            x: Axis::log_holding("factor on a_g and on all records", own.iter().map(|at| at.factor)),
            y: Axis::linear("share of the façades", 0.0, 1.0),
            layers: curves.into_iter().map(layer).collect(),
        }
        .svg()
    };
    Figure {
        id: "by-factor".into(),
        title: "Where the two checks part, at stronger and weaker sites".into(),
        legend: curves.iter().map(|(name, colour, _)| Key::new(*name, *colour, Mark::None)).collect(),
        panels: Configuration::ALL.map(panel).to_vec(),
        caption: "A check refuses a façade where its ζ is below the factor.".into(),
        links: vec![Link::to("portfolio.json")],
        ..Figure::default()
    }
}

/// ζ along the slenderness, for each thickness.
fn along(all: &Portfolio) -> Figure {
    let most = LADDER.range[1];
    let mut thicknesses_m: Vec<f64> = all.rows.iter().map(|row| row.thickness_m).collect();
    thicknesses_m.sort_by(f64::total_cmp);
    thicknesses_m.dedup();
    let colour = |k: usize| PALETTE[k % PALETTE.len()];
    let panel = |configuration: Configuration| {
        let own: Vec<&Row> = all.rows.iter().filter(|row| row.configuration == configuration).collect();
        let line = |k: usize, thickness_m: f64, dashed: bool| {
            let rows = own.iter().filter(|row| row.thickness_m == thickness_m);
            let zeta = |row: &Row| if dashed { row.zeta_static } else { row.zeta_dynamic.or(Some(most)) };
            let points = rows.filter_map(|row| Some((row.slenderness, zeta(row)?))).collect();
            let name = format!("b {thickness_m:.2} m, {}", if dashed { "static" } else { "dynamic" });
            Layer::Line { colour: colour(k), width: 2, dashed, name, points }
        };
        let lines = thicknesses_m.iter().enumerate();
        let layers: Vec<Layer> = lines.flat_map(|(k, &b)| [line(k, b, true), line(k, b, false)]).collect();
        let zetas = all.rows.iter().flat_map(|row| [row.zeta_static, row.zeta_dynamic]).flatten();
        let most_slender = all.rows.iter().map(|row| row.slenderness).fold(0.0, f64::max);
        let least_slender = all.rows.iter().map(|row| row.slenderness).fold(f64::INFINITY, f64::min);
        Graph {
            title: floor(configuration).to_owned(),
            format: Format::Half,
            x: Axis::linear("h/b", least_slender, most_slender),
            y: Axis::log_holding("ζ", zetas.chain([0.5, 2.0])),
            layers: std::iter::once(Layer::Threshold { y: 1.0, name: "ζ = 1" }).chain(layers).collect(),
        }
        .svg()
    };
    let key = |(k, b): (usize, &f64)| Key::new(format!("b {b:.2} m"), colour(k), Mark::None);
    Figure {
        id: "along".into(),
        title: "ζ by slenderness and thickness".into(),
        legend: thicknesses_m.iter().enumerate().map(key).collect(),
        panels: Configuration::ALL.map(panel).to_vec(),
        caption: "Full lines: dynamics. Broken lines: the code's nonlinear check.".into(),
        links: vec![Link::to("portfolio.parquet")],
        ..Figure::default()
    }
}

fn shares(all: &Portfolio) -> Table {
    let agreements =
        [Agreement::BothAccept, Agreement::BothRefuse, Agreement::StaticRefuses, Agreement::DynamicRefuses];
    let names = agreements.map(|agreement| agreement_name(agreement).replace('_', " "));
    let head: Vec<&str> = ["floor"]
        .into_iter()
        .chain(names.iter().map(String::as_str))
        .chain(["median ζ dynamic/static"])
        .collect();
    let rows = all.shares.iter().map(|s| {
        let shares = [s.both_accept, s.both_refuse, s.static_refuses, s.dynamic_refuses];
        let shares = shares.map(|share| format!("{:.0} %", 100.0 * share));
        let ratio = s.median_ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        std::iter::once(s.configuration.name().to_owned()).chain(shares).chain([ratio]).collect()
    });
    Table::of("Shares of the façades at the records' own scale", &head, rows)
}

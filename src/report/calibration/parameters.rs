//! What the tests tell of each parameter: value, interval, and the misfit along it.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark, PALETTE};
use super::super::page::{Figure, Key, Link, Section, Table};
use mrbd_lab::calibrate::{Calibration, Estimate, Identifiability, likelihood};

/// The section.
pub fn section(stored: &Calibration) -> Section {
    let mut figures = vec![intervals(stored)];
    figures.extend(profiles(stored));
    Section {
        id: "parameters".into(),
        title: "What the tests tell".into(),
        text: vec![
            format!(
                "The vector for all tests is that of the search “{}”. An interval as wide as its bounds says that the tests do not tell the value.",
                stored.joint_from
            ),
            likelihood(stored.likelihood.as_ref()),
        ],
        figures,
        tables: vec![table(stored)],
        ..Section::default()
    }
}

/// Parameters have different units, so they are shown as shares of what was searched.
fn share(p: &Estimate, value: f64) -> f64 {
    (value - p.lower_bound) / (p.upper_bound - p.lower_bound)
}

fn intervals(stored: &Calibration) -> Figure {
    let rows = || stored.parameters.iter().zip((0..).map(f64::from));
    let names = stored.parameters.iter().map(|p| p.name.clone()).collect();
    let spans = rows().filter_map(|(p, row)| p.interval_95.map(|i| i.map(|end| (share(p, end), row))));
    let by_test = rows().flat_map(|(p, row)| {
        let each = p.by_test.iter().flatten();
        each.map(move |&value| Dot {
            x: share(p, value),
            y: row,
            tip: format!("{}\nbest in one test: {value:.4}", p.name),
        })
    });
    let values = rows().filter(|(p, _)| p.identifiability != Identifiability::NotFollowed);
    let values = values.filter_map(|(p, row)| {
        let [low, high] = p.interval_95?;
        let tip = format!("{} = {:.4}\n95 %: {low:.4} to {high:.4}", p.name, p.value);
        Some(Dot { x: share(p, p.value), y: row, tip })
    });
    let doubtful = [Identifiability::SearchesDisagree, Identifiability::NotFollowed];
    let distrusted = rows().filter(|(p, _)| doubtful.contains(&p.identifiability));
    let distrusted = distrusted.map(|(p, row)| Dot {
        x: share(p, p.value),
        y: row,
        tip: format!("{} = {:.4}\n{}", p.name, p.value, p.identifiability.words()),
    });
    let [values, distrusted] = [values.collect::<Vec<_>>(), distrusted.collect()];
    let graph = Graph {
        title: String::new(),
        format: Format::Wide,
        x: Axis::linear("share of what was searched: 0 the lower bound, 1 the upper", -0.02, 1.02),
        y: Axis::names("", names),
        layers: vec![
            Layer::Spans { colour: PALETTE[5], width: 26, spans: spans.collect() },
            Layer::Dots {
                colour: PALETTE[4],
                mark: Mark::Triangle,
                size: 12,
                hollow: false,
                dots: by_test.collect(),
            },
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 15, hollow: false, dots: values },
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 15, hollow: true, dots: distrusted },
        ],
    };
    let key = |label: &str, index: usize, mark| Key::new(label, PALETTE[index], mark);
    Figure {
        id: "intervals".into(),
        title: "Values and their intervals".into(),
        legend: vec![
            key("value for all tests", 0, Mark::Circle),
            key("95 % interval", 5, Mark::None),
            key("best in one test", 4, Mark::Triangle),
        ],
        panels: vec![graph.svg()],
        wide: true,
        caption: "Intervals are by likelihood where that follows the tests to their noise, else of a bootstrap over the tests’ samples. Hollow: not identified. The others without an interval never act, or have nothing to scale, and stay at 1.".into(),
        links: vec![Link::to("calibration.json"), Link::to("candidates.parquet")],
        ..Figure::default()
    }
}

/// The lowest misfit along each parameter that was told; `None` if no parameter was.
fn profiles(stored: &Calibration) -> Option<Figure> {
    let told = stored.parameters.iter().filter(|p| p.interval_95.is_some() && p.profile.len() > 1);
    let panels = told.map(profile).collect();
    let figure = Figure {
        id: "profiles".into(),
        title: "Lowest misfit along each parameter".into(),
        panels,
        caption: "Of all vectors that were simulated with the parameter in a stretch of its bounds, the lowest mean WME. A valley with steep sides: the tests tell the parameter.".into(),
        links: vec![Link::to("candidates.parquet")],
        ..Figure::default()
    };
    (!figure.panels.is_empty()).then_some(figure)
}

fn profile(p: &Estimate) -> String {
    let middle = |from: f64, to: f64| (from + to) / 2.0;
    let points: Vec<(f64, f64)> =
        p.profile.iter().map(|s| (middle(s.from, s.to), s.mean_wme.unwrap_or(f64::NAN))).collect();
    let lowest = points.iter().map(|point| point.1).filter(|y| y.is_finite()).fold(f64::INFINITY, f64::min);
    let dots = points.iter().filter(|point| point.1.is_finite());
    let dots =
        dots.map(|&(x, y)| Dot { x, y, tip: format!("{} near {x:.3}\nlowest mean WME {y:.3}", p.name) });
    let value = Dot { x: p.value, y: lowest, tip: format!("{} = {:.4}", p.name, p.value) };
    Graph {
        title: String::new(),
        format: Format::Half,
        x: Axis::linear(&p.name, p.lower_bound, p.upper_bound),
        y: Axis::holding("lowest mean WME", points.iter().map(|point| point.1)),
        layers: vec![
            Layer::Line {
                colour: PALETTE[5],
                width: 2,
                dashed: false,
                name: String::new(),
                points: points.clone(),
            },
            Layer::Dots {
                colour: PALETTE[5],
                mark: Mark::Circle,
                size: 4,
                hollow: false,
                dots: dots.collect(),
            },
            Layer::Dots { colour: PALETTE[0], mark: Mark::Circle, size: 7, hollow: false, dots: vec![value] },
        ],
    }
    .svg()
}

fn table(stored: &Calibration) -> Table {
    let row = |p: &Estimate| {
        let interval = p.interval_95.map_or("–".to_owned(), |[low, high]| format!("{low:.4} to {high:.4}"));
        let told = match p.identifiability {
            Identifiability::Identified => "told by the tests",
            Identifiability::NotToldByTheTests => "not told by the tests",
            left => left.words(),
        };
        let told = if p.on_bound { format!("{told}; on its bound") } else { told.to_owned() };
        let by_test: Vec<String> =
            p.by_test.iter().map(|v| v.map_or("–".to_owned(), |v| format!("{v:.4}"))).collect();
        vec![
            p.name.clone(),
            format!("{} to {}", p.lower_bound, p.upper_bound),
            format!("{:.4}", p.value),
            interval,
            by_test.join(", "),
            told,
        ]
    };
    let head = ["parameter", "searched", "value for all tests", "95 % interval", "best in each test", ""];
    Table::of("Values of the calibrated wall", &head, stored.parameters.iter().map(row))
}

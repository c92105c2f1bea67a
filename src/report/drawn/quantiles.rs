//! Quantiles of the response over façades, record by record; over records too, along the intensity of stripes.

use super::super::chart::{Axis, Dot, Format, Graph, INK, Layer, Mark, PALETTE, of_curve};
use super::super::page::{Figure, Key, Section, Table};
use super::super::words;
use super::{medians, titled};
use crate::aggregate::{CAPACITY, Distribution, Distributions};
use crate::study::pipeline::Kind;

/// Places of the 16, 50 and 84 % quantiles among those that are told.
pub(super) const LOW: usize = 1;
pub(super) const MIDDLE: usize = 3;
pub(super) const HIGH: usize = 5;

/// Quantities and their names in the legend.
pub(super) fn quantities(kind: Kind) -> &'static [(&'static str, &'static str)] {
    match kind {
        Kind::Incremental => &[(CAPACITY, "intensity that reaches the limit")],
        _ => &[
            ("theta1_max_over_alpha1", "|θ₁|/α₁, lower body"),
            ("theta2_max_over_alpha2", "|θ₂|/α₂, upper body"),
        ],
    }
}

/// The section: a panel a floor (and limit, or stripe).
pub fn section(study: &Distributions, base: &str) -> Section {
    let own: Vec<&Distribution> =
        study.rows.iter().filter(|row| row.variant == base && row.record.is_some()).collect();
    let mut groups: Vec<(String, String)> = Vec::new();
    for row in &own {
        let group = (row.configuration.clone(), row.stratum(study.measure.as_deref()));
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    let x = axis(study, &own);
    let all = groups.len();
    if study.kind == Kind::Stripes {
        groups = few_stripes(groups);
    }
    let panel = |(configuration, stratum): &(String, String)| {
        let own: Vec<&Distribution> = own
            .iter()
            .copied()
            .filter(|row| {
                row.configuration == *configuration && row.stratum(study.measure.as_deref()) == *stratum
            })
            .collect();
        panel(study.kind, &format!("{configuration} floor {}", in_words(stratum)), &own, &x)
    };
    let key = |(index, (_, label)): (usize, &(&str, &str))| Key::new(*label, PALETTE[index], Mark::Circle);
    let mut section = titled("quantiles", "The response");
    if study.kind == Kind::Stripes {
        section.figures.push(along(study, base));
    }
    if groups.len() < all {
        section
            .text
            .push("Record by record, two stripes of each floor; the others are in medians.parquet.".into());
    }
    section.figures.push(Figure {
        id: "quantiles-by-record".into(),
        title: "16, 50 and 84 % of the façades".into(),
        legend: quantities(study.kind).iter().enumerate().map(key).collect(),
        panels: groups.iter().map(panel).collect(),
        caption: "Bars from the 16 % to the 84 % quantile over the façades, points at the median, dark its 90 % interval over draws of the façades. A bar to the end of the axis: the quantile lies among walls that collapsed, or never reached the limit.".into(),
        links: medians(),
        ..Figure::default()
    });
    section.tables.push(table(study, base));
    section
}

/// The interval of the median, as it stands behind it; empty where nobody knows.
fn sure_of(row: &Distribution) -> String {
    let told = |end: Option<f64>| end.map_or("beyond".to_owned(), |value| format!("{value:.4}"));
    row.median_interval().map_or(String::new(), |[low, high]| format!(", {} to {}", told(low), told(high)))
}

/// Quantiles over façades and records, with their intervals.
fn table(study: &Distributions, base: &str) -> Table {
    let head = ["floor", "", "quantity", "16 %", "median", "84 %"];
    let told = |value: Option<f64>| value.map_or("beyond".to_owned(), |value| format!("{value:.4}"));
    let cell = |row: &Distribution, at: usize| match row.intervals[at] {
        Some([low, high]) => format!("{} ({} to {})", told(row.quantiles[at]), told(low), told(high)),
        None => told(row.quantiles[at]),
    };
    let shown = |name: &str| quantities(study.kind).iter().find(|(known, _)| *known == name);
    let line = |row: &Distribution| {
        let (_, label) = shown(row.quantity)?;
        let place = [row.configuration.clone(), in_words(&row.stratum(study.measure.as_deref()))];
        let cells = [LOW, MIDDLE, HIGH].map(|at| cell(row, at));
        Some(place.into_iter().chain([(*label).to_owned()]).chain(cells).collect::<Vec<String>>())
    };
    let own = study.rows.iter().filter(|row| row.variant == base && row.record.is_none());
    let caption = "Over façades and records, with 90 % intervals over draws of both";
    Table::of(caption, &head, own.filter_map(line))
}

/// A stripe by the name of its measure, where it begins with that of a column.
fn in_words(stratum: &str) -> String {
    let (column, rest) = stratum.split_once(' ').unwrap_or((stratum, ""));
    format!("{} {rest}", words::intensity(column)).trim_end().to_owned()
}

/// Of each floor, the stripes at a quarter of all and in the middle; at the strongest most walls have collapsed.
fn few_stripes(groups: Vec<(String, String)>) -> Vec<(String, String)> {
    let floors = groups.chunk_by(|a, b| a.0 == b.0);
    let few = |floor: &[(String, String)]| {
        let mut chosen = vec![floor.len() / 4, (floor.len() - 1) / 2];
        chosen.dedup();
        chosen.into_iter().map(|k| floor[k].clone()).collect::<Vec<_>>()
    };
    floors.flat_map(few).collect()
}

fn axis(study: &Distributions, own: &[&Distribution]) -> Axis {
    let label = match study.kind {
        Kind::Incremental => words::intensity(study.measure.as_deref().unwrap_or("intensity")),
        _ => "max |θᵢ|/αᵢ".to_owned(),
    };
    let shown = own.iter().filter(|row| quantities(study.kind).iter().any(|(name, _)| *name == row.quantity));
    // Rotations below a thousandth of α are rest.
    Axis::log_holding(
        &label,
        shown.flat_map(|row| row.quantiles[LOW..=HIGH].iter().flatten()).map(|v| v.max(1e-3)),
    )
}

fn panel(kind: Kind, title: &str, own: &[&Distribution], x: &Axis) -> String {
    let mut records: Vec<&str> = Vec::new();
    for row in own {
        let record = row.record.as_deref().unwrap_or("");
        if !records.contains(&record) {
            records.push(record);
        }
    }
    let quantities = quantities(kind);
    let mut layers = Vec::new();
    for (index, (name, label)) in quantities.iter().enumerate() {
        let offset = if quantities.len() > 1 { 0.36 * index as f64 - 0.18 } else { 0.0 };
        let rows = own.iter().filter(|row| row.quantity == *name);
        let place = |row: &Distribution| {
            let at = records.iter().position(|record| row.record.as_deref() == Some(record));
            at.unwrap_or(0) as f64 + offset
        };
        let end = x.ends()[1];
        let value = |quantile: Option<f64>| quantile.unwrap_or(end);
        let spans = rows.clone().map(|row| {
            let y = place(row);
            [(value(row.quantiles[LOW]), y), (value(row.quantiles[HIGH]), y)]
        });
        let told =
            |quantile: Option<f64>| quantile.map_or("beyond".to_owned(), |value| format!("{value:.4}"));
        let dots = rows.clone().map(|row| {
            let [low, middle, high] = [LOW, MIDDLE, HIGH].map(|at| told(row.quantiles[at]));
            let record = row.record.as_deref().unwrap_or("");
            let tip = format!(
                "{record}: {label}\n16 % {low}\nmedian {middle}{}\n84 % {high}\n{} of {} beyond",
                sure_of(row),
                row.beyond,
                row.runs
            );
            Dot { x: value(row.quantiles[MIDDLE]), y: place(row), tip }
        });
        let sure = rows.clone().filter_map(|row| {
            let [low, high] = row.median_interval()?;
            Some([(value(low), place(row)), (value(high), place(row))])
        });
        let colour = PALETTE[index];
        layers.push(Layer::Spans { colour, width: 4, spans: spans.collect() });
        layers.push(Layer::Spans { colour: INK, width: 2, spans: sure.collect() });
        layers.push(Layer::Dots { colour, mark: Mark::Circle, size: 6, hollow: false, dots: dots.collect() });
    }
    let names = records.iter().map(|&record| record.to_owned()).collect();
    Graph {
        title: title.trim().to_owned(),
        format: Format::Half,
        x: x.clone(),
        y: Axis::names("", names),
        layers,
    }
    .svg()
}

/// Least rotation drawn, over α: below it is rest.
const LEAST: f64 = 1e-3;

/// A panel a floor.
fn along(study: &Distributions, base: &str) -> Figure {
    let own = |row: &&Distribution| row.variant == base && row.record.is_none() && row.intensity.is_some();
    let rows = study.rows.iter().filter(own).collect::<Vec<_>>();
    let mut floors = rows.iter().map(|row| row.configuration.as_str()).collect::<Vec<_>>();
    floors.dedup();
    let label = words::intensity(study.measure.as_deref().unwrap_or("intensity"));
    let x = Axis::log_holding(&label, rows.iter().filter_map(|row| row.intensity));
    let values = rows.iter().flat_map(|row| &row.quantiles[LOW..=HIGH]).flatten();
    let y = Axis::log_holding("max |θᵢ|/αᵢ", values.map(|value| value.max(LEAST)));
    let panel = |floor: &str| {
        let own = rows.iter().copied().filter(|row| row.configuration == floor).collect::<Vec<_>>();
        Graph {
            title: format!("{floor} floor"),
            format: Format::Half,
            x: x.clone(),
            y: y.clone(),
            layers: quantities(Kind::Stripes)
                .iter()
                .enumerate()
                .flat_map(|(index, quantity)| curve(index, *quantity, &own, y.ends()[1], &label))
                .collect(),
        }
        .svg()
    };
    let key = |(index, (_, label)): (usize, &(&str, &str))| {
        let (colour, mark) = of_curve(index);
        Key::new(*label, colour, mark)
    };
    Figure {
        id: "quantiles-along".into(),
        title: "Along the intensity, all records together".into(),
        legend: quantities(Kind::Stripes).iter().enumerate().map(key).collect(),
        panels: floors.into_iter().map(panel).collect(),
        caption: "Median over façades and records, and the band from the 16 % to the 84 % quantile. At the upper end: the quantile lies among walls that collapsed.".into(),
        links: medians(),
        ..Figure::default()
    }
}

/// Band and median of one quantity; a quantile beyond all numbers stands at the end of the axis.
fn curve(
    index: usize,
    (name, told): (&str, &str),
    own: &[&Distribution],
    end: f64,
    label: &str,
) -> [Layer; 3] {
    let (colour, mark): (_, Mark) = of_curve(index);
    let rows = own.iter().filter(|row| row.quantity == name);
    let mut points = rows
        .filter_map(|row| {
            let of = |at: usize| row.quantiles[at].map_or(end, |value| value.max(LEAST));
            Some((row.intensity?, of(LOW), of(MIDDLE), of(HIGH)))
        })
        .collect::<Vec<_>>();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let dot = |&(x, low, middle, high): &(f64, f64, f64, f64)| {
        let value = |v: f64| if v >= end { "beyond".to_owned() } else { format!("{v:.4}") };
        let tip = format!(
            "{told}, {label} {x}\n16 % {}\nmedian {}\n84 % {}",
            value(low),
            value(middle),
            value(high)
        );
        Dot { x, y: middle, tip }
    };
    [
        Layer::Band { colour, points: points.iter().map(|p| (p.0, p.1, p.3)).collect() },
        Layer::Line {
            colour,
            width: 2,
            dashed: false,
            name: String::new(),
            points: points.iter().map(|p| (p.0, p.2)).collect(),
        },
        Layer::Dots { colour, mark, size: 5, hollow: false, dots: points.iter().map(dot).collect() },
    ]
}

//! Quantiles of the response over façades and records, along the intensity of stripes.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, Mark, of_curve};
use super::super::page::{Figure, Key};
use super::super::words;
use super::medians;
use super::quantiles::{HIGH, LOW, MIDDLE, quantities};
use crate::aggregate::{Distribution, Distributions};
use crate::study::pipeline::Kind;

/// Least rotation drawn, over α: below it is rest.
const LEAST: f64 = 1e-3;

/// A panel a floor.
pub fn figure(study: &Distributions, base: &str) -> Figure {
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

//! Fragility curves with their intervals and the data behind them.

use super::super::chart::{Axis, Dot, Format, Graph, Layer, of_curve};
use super::super::page::{Figure, Key, Link, Section, Table};
use super::super::words;
use super::titled;
use crate::aggregate::Distributions;
use crate::fragility::{Analysis, Interval, Known, Method};
use crate::summary::{DEFAULT_INTENSITY, LEVEL, LimitFragility};

/// Bins of data points, and steps of a curve.
const BINS: usize = 10;
const STEPS: u32 = 80;

/// The section: a panel a floor, a curve a limit.
pub fn section(study: &Distributions, all: &[LimitFragility], links: &[Link]) -> Section {
    let mut limits: Vec<String> = Vec::new();
    let mut floors: Vec<String> = Vec::new();
    for one in all {
        if !limits.contains(&one.limit) {
            limits.push(one.limit.clone());
        }
        if !floors.contains(&one.configuration) {
            floors.push(one.configuration.clone());
        }
    }
    let x = axis(study, all);
    let panel = |floor: &String| {
        let own: Vec<&LimitFragility> = all.iter().filter(|one| one.configuration == *floor).collect();
        panel(floor, &own, &limits, &x)
    };
    let legend = limits.iter().enumerate().map(|(index, limit)| {
        let (colour, mark) = of_curve(index);
        Key::new(limit.clone(), colour, mark)
    });
    let mut section = titled("fragility", "Fragility");
    section.text.push(format!(
        "The probability that a façade of the survey reaches a limit at an intensity, as a log-normal curve. Bands: {:.0} % intervals over records and façades, which outcomes share; with few records they are wide, and where the data set no bound there is none.",
        100.0 * LEVEL
    ));
    section.figures.push(Figure {
        id: "fragility-curves".into(),
        title: "Probability of reaching a limit".into(),
        legend: legend.collect(),
        panels: floors.iter().map(panel).collect(),
        caption: format!("Points: shares of the runs in bins of intensity, of incremental analyses shares of the walls that reached the limit up to there. Intensity: column {} of the data.", measure(study)),
        links: links.to_vec(),
        ..Figure::default()
    });
    section.tables.push(table(study, all));
    section
}

/// Column of the intensity.
fn measure(study: &Distributions) -> &str {
    study.measure.as_deref().unwrap_or(DEFAULT_INTENSITY)
}

/// An axis of intensity that all panels share.
fn axis(study: &Distributions, all: &[LimitFragility]) -> Axis {
    Axis::log_holding(
        &words::intensity(measure(study)),
        all.iter().flat_map(|one| one.analysis.range).flatten(),
    )
}

fn panel(floor: &str, own: &[&LimitFragility], limits: &[String], x: &Axis) -> String {
    let mut layers = Vec::new();
    for one in own {
        let index = limits.iter().position(|limit| *limit == one.limit).unwrap_or(0);
        layers.extend(curve(one, index, x));
        let (colour, mark) = of_curve(index);
        layers.push(Layer::Dots { colour, mark, size: 5, hollow: false, dots: points(one) });
    }
    Graph {
        title: format!("{floor} floor"),
        format: Format::Half,
        x: x.clone(),
        y: Axis::linear("probability", 0.0, 1.0),
        layers,
    }
    .svg()
}

/// Band and line of a fragility that is known.
fn curve(one: &LimitFragility, index: usize, x: &Axis) -> Vec<Layer> {
    let Ok(known) = &one.analysis.result else { return Vec::new() };
    let colour = of_curve(index).0;
    let [low, high] = x.ends().map(f64::ln);
    let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(STEPS);
    let interval =
        |ln: f64| known.bootstrap.as_ref().map_or(Interval::default(), |b| b.probability_at_ln(ln));
    let band = (0..=STEPS).map(at).map(|ln| {
        let Interval { lower, upper } = interval(ln);
        (ln.exp(), lower.unwrap_or(f64::NAN), upper.unwrap_or(f64::NAN))
    });
    let line = (0..=STEPS).map(at).map(|ln| (ln.exp(), known.fitted.probability_at_ln(ln)));
    let name = one.limit.clone();
    vec![
        Layer::Band { colour, points: band.collect() },
        Layer::Line { colour, width: 2, dashed: false, name, points: line.collect() },
    ]
}

/// Shares of the data: in bins of equal numbers, or at each intensity where there are few.
fn points(one: &LimitFragility) -> Vec<Dot> {
    let (x, failures, trials) = (one.sample.ln_intensity(), one.sample.failures(), one.sample.trials());
    let mut rows: Vec<usize> = (0..x.len()).collect();
    rows.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    if one.method == Method::Incremental {
        return reached(&rows, x, failures, &one.limit);
    }
    let mut bins: Vec<&[usize]> = rows.chunk_by(|&a, &b| x[a] == x[b]).collect();
    if bins.len() > BINS {
        bins = rows.chunks(rows.len().div_ceil(BINS)).collect();
    }
    let dot = |bin: &[usize]| {
        let sum = |of: &[f64]| bin.iter().map(|&row| of[row]).sum::<f64>();
        let (k, n) = (sum(failures), sum(trials));
        let intensity = (sum(x) / bin.len() as f64).exp();
        Dot { x: intensity, y: k / n, tip: format!("{}\n{k} of {n} near {intensity:.4}", one.limit) }
    };
    bins.into_iter().map(dot).collect()
}

/// Shares of the walls that reached the limit, by the intensities at which they did.
fn reached(rows: &[usize], x: &[f64], failures: &[f64], limit: &str) -> Vec<Dot> {
    let total = rows.len();
    let failed: Vec<f64> = rows.iter().filter(|&&row| failures[row] > 0.0).map(|&row| x[row].exp()).collect();
    let every = failed.len().div_ceil(4 * BINS).max(1);
    let dot = |(k, &intensity): (usize, &f64)| {
        let tip = format!("{limit}\n{} of {total} walls up to {intensity:.4}", k + 1);
        Dot { x: intensity, y: (k + 1) as f64 / total as f64, tip }
    };
    failed.iter().enumerate().step_by(every).map(dot).collect()
}

fn table(study: &Distributions, all: &[LimitFragility]) -> Table {
    let measure = words::intensity(measure(study));
    let row = |one: &LimitFragility| {
        let Analysis { failures, trials, result, .. } = &one.analysis;
        let mut row =
            vec![format!("{} floor: {}", one.configuration, one.limit), format!("{failures} of {trials}")];
        row.extend(match result {
            Ok(known) => told(known, one.analysis.extrapolates()),
            Err(unknown) => [format!("unknown: {unknown}"), String::new(), String::new()],
        });
        row
    };
    let head = ["limit", "reached it", &format!("median {measure}"), "dispersion β", "shares of variance"];
    Table::of("Fragilities with their intervals; ? where the data set no bound", &head, all.iter().map(row))
}

fn told(known: &Known, extrapolates: bool) -> [String; 3] {
    let bound = |value: Option<f64>| value.map_or("?".to_owned(), |value| format!("{value:.3}"));
    let range = |i: Interval| format!("({} to {})", bound(i.lower), bound(i.upper));
    let (median, beta) =
        known.best().map_or((String::new(), String::new()), |(_, b)| (range(b.median), range(b.beta)));
    let curve = known.fitted.curve;
    let beyond = if extrapolates { ", beyond the data" } else { "" };
    let shares = known.shares.iter().flatten().map(|s| format!("{} {:.0} %", s.name, 100.0 * s.share));
    [
        format!("{:.4} {median}{beyond}", curve.median()),
        format!("{:.3} {beta}", curve.beta()),
        shares.collect::<Vec<_>>().join(", "),
    ]
}

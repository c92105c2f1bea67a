//! Fragility curves with their intervals and the data behind them.

use std::path::Path;

use super::super::chart::{Axis, Dot, Format, Graph, Layer, of_curve};
use super::super::page::{Figure, Key, Link, Section, Table};
use super::titled;
use crate::aggregate::{Distributions, VariantNote};
use crate::error::{InputError, Result};
use crate::fragility::{
    Analysis, Bootstrap, Columns, EXPRESSION_ALLOWED, Expression, Group, Interval, Known, Method,
    NotAnExpression, Outcomes, Sample, Settings, analyse, read_groups,
};
use crate::study::pipeline::Kind;

/// The rotation over α_i that the paper calls significant.
const SIGNIFICANT: f64 = 0.05;
/// Intensity of studies that were not scaled to one: in rocking, velocity tells more than acceleration.
const DEFAULT_INTENSITY: &str = "pgv_m_s";
/// Replicates behind the intervals of the page; `mrbd fragility` takes any number.
const REPLICATES: u32 = 500;
const LEVEL: f64 = 0.95;
/// Bins of data points, and steps of a curve.
const BINS: usize = 10;
const STEPS: u32 = 80;

/// The fragility of one limit under one floor.
struct Fragility {
    configuration: String,
    limit: String,
    sample: Sample,
    analysis: Analysis,
    method: Method,
}

/// The section: a panel a floor, a curve a limit.
///
/// # Errors
/// Whatever reading the runs and drawing meet.
pub fn section(folder: &Path, study: &Distributions, base: &VariantNote, links: &[Link]) -> Result<Section> {
    let all = fragilities(folder, study, base)?;
    let mut limits: Vec<String> = Vec::new();
    let mut floors: Vec<String> = Vec::new();
    for one in &all {
        if !limits.contains(&one.limit) {
            limits.push(one.limit.clone());
        }
        if !floors.contains(&one.configuration) {
            floors.push(one.configuration.clone());
        }
    }
    let x = axis(study, &all);
    let panel = |floor: &String| {
        let own: Vec<&Fragility> = all.iter().filter(|one| one.configuration == *floor).collect();
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
        caption: "Points: shares of the runs in bins of intensity, of incremental analyses shares of the walls that reached the limit up to there.".into(),
        links: links.to_vec(),
        ..Figure::default()
    });
    section.tables.push(table(study, &all));
    Ok(section)
}

fn fragilities(folder: &Path, study: &Distributions, base: &VariantNote) -> Result<Vec<Fragility>> {
    let intensity = if study.measure.is_some() { "intensity" } else { DEFAULT_INTENSITY };
    let slip = |e: NotAnExpression| InputError::file(folder, e.to_string(), EXPRESSION_ALLOWED);
    let expression = Expression::parse(intensity).map_err(slip)?;
    let columns = |outcome: Outcomes, groups: &[&str]| Columns {
        intensity: expression.clone(),
        stood: (study.kind == Kind::Incremental).then(|| "stood_intensity".to_owned()),
        outcome,
        demand: None,
        groups: groups.iter().map(|&name| name.to_owned()).collect(),
        clusters: ["record", "draw"].map(str::to_owned).to_vec(),
    };
    let of =
        |columns: &Columns, method: Method, limit: &dyn Fn(&Group) -> String| -> Result<Vec<Fragility>> {
            let groups = read_groups(folder, columns)?.into_iter().filter(|group| group.key[0] == base.name);
            Ok(groups.map(|group| fragility(group, method, limit)).collect())
        };
    if study.kind == Kind::Incremental {
        let columns =
            columns(Outcomes::Words("limit_exceeded".into()), &["variant", "configuration", "limit"]);
        return of(&columns, Method::Incremental, &|group| match group.key[2].as_str() {
            "collapse" => "collapse".to_owned(),
            rotation => format!("|θᵢ|/αᵢ > {rotation}"),
        });
    }
    let groups = ["variant", "configuration"];
    let turned = columns(Outcomes::Above("theta_max_over_own_alpha".into(), SIGNIFICANT), &groups);
    let mut all = of(&turned, Method::Outcomes, &|_| format!("|θᵢ|/αᵢ > {SIGNIFICANT}"))?;
    let fell = columns(Outcomes::Words("outcome".into()), &groups);
    all.extend(of(&fell, Method::Outcomes, &|_| "collapse".to_owned())?);
    Ok(all)
}

fn fragility(group: Group, method: Method, limit: &dyn Fn(&Group) -> String) -> Fragility {
    let bootstrap = Bootstrap { replicates: REPLICATES, seed: 1 };
    let analysis = analyse(&group.sample, &Settings { method, bootstrap, level: LEVEL });
    Fragility {
        configuration: group.key[1].clone(),
        limit: limit(&group),
        sample: group.sample,
        analysis,
        method,
    }
}

/// An axis of intensity that all panels share.
fn axis(study: &Distributions, all: &[Fragility]) -> Axis {
    let label = study.measure.as_deref().unwrap_or(DEFAULT_INTENSITY);
    Axis::log_holding(label, all.iter().flat_map(|one| one.analysis.range).flatten())
}

fn panel(floor: &str, own: &[&Fragility], limits: &[String], x: &Axis) -> String {
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
fn curve(one: &Fragility, index: usize, x: &Axis) -> Vec<Layer> {
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
fn points(one: &Fragility) -> Vec<Dot> {
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

fn table(study: &Distributions, all: &[Fragility]) -> Table {
    let measure = study.measure.as_deref().unwrap_or(DEFAULT_INTENSITY);
    let row = |one: &Fragility| {
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

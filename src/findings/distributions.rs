//! What a study of drawn façades says, for people: assumptions, and quantiles over façades and records.

use std::io::{self, Write};

use super::report::{assumptions, heading, unfinished};
use crate::aggregate::{CAPACITY, Distribution, Distributions, MOVED_SHARE, Moved};
use crate::study::pipeline::Kind;
use crate::text::{TERMINAL, aligned, wrapped};

/// Rows of a table by record that still can be read; more are in the file of medians.
const MOST_ROWS: usize = 60;

/// Prints everything; the first variant is the one whose quantiles are shown.
///
/// # Errors
/// What the stream says.
pub fn report_distributions(out: &mut dyn Write, study: &Distributions) -> io::Result<()> {
    let Some(base) = study.variants.first() else { return Ok(()) };
    assumptions(out, &study.variants)?;
    unfinished(out, study.completeness)?;
    let what = match (study.kind, &study.measure) {
        (Kind::Incremental, Some(measure)) => format!("{measure} at which limits are exceeded"),
        _ => "Largest rotations over slenderness angles".to_owned(),
    };
    heading(out, &format!("{what}: quantiles over façades and records, variant {:?}", base.name))?;
    writeln!(out, "{}", wrapped(&legend(study.kind), 0, TERMINAL))?;
    let rows = |by_record: bool| {
        let rows = study.rows.iter().filter(|row| row.variant == base.name);
        rows.filter(|row| row.record.is_some() == by_record).collect::<Vec<_>>()
    };
    writeln!(out, "\n{}", table(study, &rows(false)))?;
    if let Some(sure) = sure(study, &rows(false)) {
        heading(out, "90 % intervals of the medians, over draws of façades and records")?;
        writeln!(out, "{sure}")?;
    }
    let by_record = rows(true);
    match by_record.iter().filter(|row| row.quantity == shown(study.kind)[0].0).count() {
        0..=MOST_ROWS => {
            heading(out, "The same by record")?;
            writeln!(out, "{}", table(study, &by_record))?;
        }
        more => writeln!(out, "\n{more} rows by record are in medians.parquet")?,
    }
    if study.moved.is_empty() { Ok(()) } else { moved(out, &study.moved, &base.name) }
}

fn legend(kind: Kind) -> String {
    match kind {
        Kind::Incremental => "never: share of the finished analyses that did not exceed the limit at the highest \
                              intensity; they rank above all numbers, and a quantile among them is >",
        _ => "fell: share of the finished runs that collapsed; they rank above all that stood, and a quantile among \
              them is fell",
    }
    .to_owned()
}

/// Quantities that are shown, and their symbols.
fn shown(kind: Kind) -> &'static [(&'static str, &'static str)] {
    match kind {
        Kind::Incremental => &[(CAPACITY, "")],
        _ => &[("theta1_max_over_alpha1", "θ1/α1 "), ("theta2_max_over_alpha2", "θ2/α2 ")],
    }
}

fn table(study: &Distributions, rows: &[&Distribution]) -> String {
    let quantities = shown(study.kind);
    let (beyond, cell) = match study.kind {
        Kind::Incremental => ("never", ">"),
        _ => ("fell", "fell"),
    };
    let mut head = vec!["floor".to_owned(), String::new(), "runs".into(), "failed".into(), beyond.into()];
    for (_, symbol) in quantities {
        head.extend(["16 %".to_owned(), format!("{symbol}50 %"), "84 %".to_owned()]);
    }
    let mut lines = vec![head];
    let firsts = rows.iter().filter(|row| row.quantity == quantities[0].0);
    for first in firsts {
        let record = first.record.as_deref().unwrap_or("");
        let place = [record, &first.stratum(study.measure.as_deref())].join(" ").trim().to_owned();
        let share = first.share_beyond().map_or("-".into(), |share| format!("{:.1} %", 100.0 * share));
        let mut line =
            vec![first.configuration.clone(), place, first.runs.to_string(), first.failed.to_string(), share];
        for (quantity, _) in quantities {
            let same = |row: &&&Distribution| {
                row.quantity == *quantity
                    && (&row.configuration, &row.record, row.intensity, &row.limit)
                        == (&first.configuration, &first.record, first.intensity, &first.limit)
            };
            let quantiles = rows.iter().find(same).map_or([None; 7], |row| row.quantiles);
            line.extend([1, 3, 5].map(|level| told(quantiles[level], first.beyond, cell)));
        }
        lines.push(line);
    }
    aligned(&lines)
}

/// A quantile in a table, or what stands for one beyond all numbers.
fn told(value: Option<f64>, beyond: u64, cell: &str) -> String {
    match (value, beyond) {
        (Some(value), _) => format!("{value:.4}"),
        (None, 0) => "-".to_owned(),
        (None, _) => cell.to_owned(),
    }
}

/// The medians with their intervals; `None` where none is told.
fn sure(study: &Distributions, rows: &[&Distribution]) -> Option<String> {
    let cell = if study.kind == Kind::Incremental { ">" } else { "fell" };
    let line = |row: &&Distribution| {
        let (_, symbol) = shown(study.kind).iter().find(|(name, _)| *name == row.quantity)?;
        let [low, high] = row.median_interval()?;
        let place =
            [row.configuration.clone(), row.stratum(study.measure.as_deref()), (*symbol).trim().to_owned()];
        let told = |value: Option<f64>| told(value, row.beyond, cell);
        let interval = format!("{} to {}", told(low), told(high));
        Some(place.into_iter().chain([told(row.median()), interval]).collect::<Vec<String>>())
    };
    let lines: Vec<Vec<String>> = rows.iter().filter_map(line).collect();
    let head = ["floor", "", "", "50 %", "90 % interval"].map(str::to_owned).to_vec();
    (!lines.is_empty()).then(|| aligned(&[vec![head], lines].concat()))
}

fn moved(out: &mut dyn Write, moved: &[Moved], base: &str) -> io::Result<()> {
    heading(out, &format!("Runs that come out differently from variant {base:?}"))?;
    let mut rows = vec![["variant", "floor", "runs", "moved"].map(str::to_owned).to_vec()];
    rows.extend(moved.iter().map(|m| {
        let share = format!("{:.1} %", 100.0 * m.moved as f64 / m.runs as f64);
        vec![m.variant.clone(), m.configuration.clone(), m.runs.to_string(), share]
    }));
    writeln!(out, "{}", aligned(&rows))?;
    let note =
        format!("moved: another outcome, or a result that differs by more than {} %", 100.0 * MOVED_SHARE);
    writeln!(out, "{}", wrapped(&note, 0, TERMINAL))
}

//! Suites of records: read, generated, selected.

use std::path::{Path, PathBuf};

use mrbd_records::{
    Criteria, ReadOptions, RecordTable, Site, Suite, SuiteSource, generate, select, write_suite,
};
use pyo3::prelude::*;

use crate::errors::{argument, files, input};
use crate::record::Record;

/// The paper's Table 4, so that the calls work anywhere.
const TABLE_4: &str = include_str!("../../../inputs/table4.toml");

/// Name of a suite, its records, and their vertical components where every record has one.
type Read = (String, Vec<Record>, Option<Vec<Record>>);

/// The records of a suite file, scaled as it says.
#[pyfunction]
pub fn read_suite(py: Python<'_>, path: PathBuf) -> PyResult<Read> {
    let suite = py.detach(|| Suite::load(&path)).map_err(files)?;
    let horizontal =
        suite.records.iter().map(|r| Record { name: r.name.clone(), motion: r.horizontal.clone() });
    let vertical = suite
        .records
        .iter()
        .map(|r| r.vertical.clone().map(|motion| Record { name: format!("{} vertical", r.name), motion }));
    let (horizontal, vertical) = (horizontal.collect(), vertical.collect());
    Ok((suite.name, horizontal, vertical))
}

/// Records with the peaks of a published table, that stand in for its rows; written as a suite where a folder is given.
#[pyfunction]
#[pyo3(signature = (table, site, seed, name, out))]
pub fn generate_suite(
    py: Python<'_>,
    table: Option<PathBuf>,
    site: Option<PathBuf>,
    seed: u64,
    name: &str,
    out: Option<PathBuf>,
) -> PyResult<Vec<Record>> {
    if let Some(out) = out.as_ref().filter(|out| out.join("suite.toml").exists()) {
        let found = format!("{}, which holds a suite", out.display());
        return Err(argument("records.generate", "out", found, "a folder without a suite.toml"));
    }
    let table = match &table {
        Some(path) => RecordTable::load(path).map_err(files)?,
        None => RecordTable::parse(Path::new("table4.toml"), TABLE_4).map_err(files)?,
    };
    let site = site.map(|path| Site::load(&path)).transpose().map_err(files)?;
    let motions = py.detach(|| generate(&table, site.as_ref(), seed));
    if let Some(out) = out {
        write_suite(&out, name, &table, &motions, seed).map_err(files)?;
    }
    let named = |(row, motion): (&mrbd_records::TableRow, _)| Record { name: row.archive_id.clone(), motion };
    Ok(table.records.iter().zip(motions).map(named).collect())
}

/// A suite that fits: names and factors of its records, and how far its mean lies from the code spectrum.
type Fits = (Vec<String>, Vec<f64>, f64, [f64; 2]);

/// Suites of a folder or a suite file whose mean spectrum fits the code spectrum of a site, the best first.
#[pyfunction]
#[pyo3(signature = (from_records, site, count, periods_s, deviation, scale, most_of_event, candidates, best, step_s))]
#[allow(clippy::too_many_arguments)]
pub fn select_suite(
    py: Python<'_>,
    from_records: PathBuf,
    site: PathBuf,
    count: usize,
    periods_s: (f64, f64),
    deviation: (f64, f64),
    scale: (f64, f64),
    most_of_event: usize,
    candidates: usize,
    best: usize,
    step_s: Option<f64>,
) -> PyResult<Vec<Fits>> {
    let refuse =
        |key: &str, found: String, allowed: &str| Err(argument("records.select", key, found, allowed));
    if !(scale.0 > 0.0 && scale.0 <= scale.1 && scale.1 <= 100.0) {
        return refuse("scale", format!("{scale:?}"), "0 < from <= to <= 100");
    }
    if !(periods_s.0 > 0.0 && periods_s.0 < periods_s.1 && periods_s.1.is_finite()) {
        return refuse("periods_s", format!("{periods_s:?}"), "0 < from < to");
    }
    if !(1..=30).contains(&count) {
        return refuse("count", count.to_string(), "1 to 30");
    }
    let site = Site::load(&site).map_err(files)?;
    let options = ReadOptions { step_s, ..ReadOptions::default() };
    let suite =
        SuiteSource::open(&from_records, &options, 0).and_then(|source| source.load()).map_err(files)?;
    let criteria =
        Criteria { count, periods_s, deviation, scale, most_of_event, candidates, best: best.max(1) };
    let found = py.detach(|| select(&suite.records, &site, &criteria));
    if found.is_empty() {
        let among = format!("no suite of {count} among {} records", suite.records.len());
        let fault = mrbd_files::InputError::file(&from_records, among, "wider bounds, or more records");
        return Err(input(fault));
    }
    let fits = |s: mrbd_records::Selection| {
        let names = s.members.iter().map(|&member| suite.records[member].name.clone()).collect();
        (names, s.scales, s.deviation_rms, [s.lowest_deviation, s.highest_deviation])
    };
    Ok(found.into_iter().map(fits).collect())
}

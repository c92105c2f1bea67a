//! The paper's Fig. 9: one wall as three models under the same records.
//!
//! `calibrated`: with the carriage and the C_l of Table 2; `updated`: with the carriage, C_l = 1; `lumped`: the carriage
//! lumped into m_d, which acts vertically too, C_l = 1. The findings checked are those of the paper's section 3.2:
//! the calibrated model rotates least; the lumped model opens its crack less than the updated one.

mod histories;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::{InputError, Result};
use crate::study::pipeline::check_name;
use mrbd_files::FileNote;
use mrbd_files::coefficients::CoefficientSets;
use mrbd_files::{load_wall, toml_file};
use mrbd_kernel::model::{Contact, ImpactLaw, Pair, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Observer, Shaking, simulate_observed};
use mrbd_kernel::solver::Quintic;
use mrbd_records::{Accelerogram, Suite};

pub use histories::{HistoryPoint, write_histories};

/// A pipeline file with a `[comparison]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct ComparisonFile {
    name: String,
    wall: PathBuf,
    coefficients: PathBuf,
    suite: PathBuf,
    comparison: ComparisonTable,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct ComparisonTable {
    scales: Vec<f64>,
    laws: Vec<ImpactLaw>,
    tail_s: f64,
    tolerance: f64,
}

/// Kind of results, by which a report tells the folder of a comparison from others.
pub const KIND: &str = "comparison";

/// Names of the models.
pub const MODELS: [&str; 3] = ["calibrated", "updated", "lumped"];

/// The name of a comparison, and of the folder of its results.
///
/// # Errors
/// Input errors of the pipeline file.
pub fn name(path: &Path) -> Result<String> {
    let file: ComparisonFile = toml_file::load(path)?;
    check_name(path, &file.name)?;
    Ok(file.name)
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonRow {
    /// Impact law.
    pub law: &'static str,
    /// Record.
    pub record: String,
    /// Factor on the record.
    pub scale: f64,
    /// One of [`MODELS`].
    pub model: &'static str,
    /// How the run ended.
    pub outcome: &'static str,
    /// When it collapsed, s.
    pub collapse_time_s: Option<f64>,
    /// Largest rotations over α_i; to be read with the outcome, since a collapse ends them at its rotation.
    pub theta1_max_over_alpha1: f64,
    /// The same of the upper body.
    pub theta2_max_over_alpha2: f64,
    /// Largest opening of the crack |θ_2 - θ_1| while all three models stand, rad.
    pub crack_opening_while_all_stand_rad: f64,
}

/// A claim of the paper and in how many cases it holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Impact law.
    pub law: &'static str,
    /// What is claimed.
    pub claim: &'static str,
    /// Cases in which it holds.
    pub holds: usize,
    /// Cases in which it can be judged: those in which the models differ at all.
    pub of: usize,
}

impl Finding {
    /// ✓ where the claim holds in every case that can be judged, ✗ where it fails in one, - where none can be.
    pub fn mark(&self) -> &'static str {
        match (self.holds, self.of) {
            (_, 0) => "-",
            (holds, of) if holds == of => "✓",
            _ => "✗",
        }
    }
}

/// Rows and findings.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelComparison {
    /// Name of the study.
    pub name: String,
    /// Suite of records.
    pub suite: String,
    /// Whether it is generated rather than recorded.
    pub generated: bool,
    /// Files that were read.
    pub inputs: Vec<FileNote>,
    /// One a run.
    pub rows: Vec<ComparisonRow>,
    /// The claims.
    pub findings: Vec<Finding>,
    /// The runs under one record, in time.
    pub histories: Vec<HistoryPoint>,
}

/// Whether a pipeline file is a comparison of models.
///
/// # Errors
/// Input errors for a file that is no TOML.
pub fn is_comparison(path: &Path) -> Result<bool> {
    Ok(toml_file::load::<toml::Table>(path)?.contains_key("comparison"))
}

/// Reads a comparison and runs it; `suite` replaces the file's.
///
/// # Errors
/// Input errors of the file and of what it names.
pub fn compare(path: &Path, suite: Option<&Path>) -> Result<ModelComparison> {
    let file: ComparisonFile = toml_file::load(path)?;
    check(path, &file.comparison)?;
    let beside = |name: &Path| path.parent().unwrap_or(Path::new("")).join(name);
    let suite_path = suite.map_or_else(|| beside(&file.suite), Path::to_path_buf);
    let files = [
        ("pipeline", path.to_path_buf()),
        ("wall", beside(&file.wall)),
        ("coefficients", beside(&file.coefficients)),
        ("suite", suite_path.clone()),
    ];
    let inputs = files.iter().map(|(role, path)| FileNote::of(role, path)).collect::<Result<_, _>>()?;
    let wall = load_wall(&files[1].1)?;
    let best_fit = CoefficientSets::load(&files[2].1)?.best_fit;
    let suite = Suite::load(&suite_path)?;
    let mut cases = Vec::new();
    for &law in &file.comparison.laws {
        let models = models(path, wall.parameters(), law, best_fit)?;
        for record in &suite.records {
            for &scale in &file.comparison.scales {
                let name = record.name.clone();
                cases.push(Case { law, models: models.clone(), name, record: &record.horizontal, scale });
            }
        }
    }
    let settings = &file.comparison;
    let rows = cases.par_iter().map(|case| case.run(settings)).collect::<Vec<_>>();
    let findings = settings.laws.iter().flat_map(|law| findings(law.name(), &rows)).collect();
    Ok(ModelComparison {
        name: file.name,
        suite: suite.name.clone(),
        generated: suite.generated,
        inputs,
        histories: histories::histories(&cases, &rows, settings),
        rows: rows.into_iter().flatten().collect(),
        findings,
    })
}

fn check(path: &Path, table: &ComparisonTable) -> Result<(), InputError> {
    let require = |key: &str, found: String, holds: bool, allowed: &str| {
        let error = || InputError::key(path, format!("comparison.{key}"), found, allowed);
        if holds { Ok(()) } else { Err(error()) }
    };
    let scales_hold = !table.scales.is_empty() && table.scales.iter().all(|s| s.is_finite() && *s > 0.0);
    require("scales", format!("{:?}", table.scales), scales_hold, "one or more numbers above 0")?;
    require("laws", format!("{:?}", table.laws), !table.laws.is_empty(), "\"whole\", \"contact\" or both")?;
    let tail_holds = table.tail_s.is_finite() && table.tail_s >= 0.0;
    require("tail_s", table.tail_s.to_string(), tail_holds, "a finite number of seconds, 0 or more")?;
    let tolerance_holds = Accuracy::TOLERANCES.contains(&table.tolerance);
    require("tolerance", table.tolerance.to_string(), tolerance_holds, Accuracy::ALLOWED)
}

/// The wall as the three models, in the order of [`MODELS`].
fn models(
    path: &Path,
    wall: &WallParameters,
    law: ImpactLaw,
    best_fit: [f64; 8],
) -> Result<[Wall; 3], InputError> {
    let with = |coefficients: [f64; 8]| {
        let mut parameters = wall.clone();
        parameters.restitution.law = law;
        parameters.restitution.coefficients = coefficients;
        parameters
    };
    let mut lumped = with([1.0; 8]);
    lumped.diaphragm_mass_kg += lumped.carriage_mass_kg;
    lumped.carriage_mass_kg = 0.0;
    let made = |p: WallParameters| Wall::new(p).map_err(|e| InputError::key(path, e.key, e.found, e.allowed));
    Ok([made(with(best_fit))?, made(with([1.0; 8]))?, made(lumped)?])
}

/// One record at one scale.
struct Case<'a> {
    law: ImpactLaw,
    models: [Wall; 3],
    name: String,
    record: &'a Accelerogram,
    scale: f64,
}

impl Case<'_> {
    fn run(&self, settings: &ComparisonTable) -> [ComparisonRow; 3] {
        let horizontal = Some(self.record.scaled(self.scale));
        let shaking = Shaking { horizontal, vertical: None, tail_s: settings.tail_s };
        let accuracy = Accuracy { tolerance: settings.tolerance };
        let mut openings = [CrackOpening::default(), CrackOpening::default(), CrackOpening::default()];
        let responses =
            [0, 1, 2].map(|m| simulate_observed(&self.models[m], &shaking, accuracy, &mut openings[m]));
        let all_stand_s = responses.iter().map(|r| r.end_time_s).fold(f64::INFINITY, f64::min);
        [0, 1, 2].map(|m| {
            let over_alpha = responses[m].theta_max_over_alpha_i();
            ComparisonRow {
                law: self.law.name(),
                record: self.name.clone(),
                scale: self.scale,
                model: MODELS[m],
                outcome: responses[m].outcome.name(),
                collapse_time_s: responses[m].collapsed().then_some(responses[m].end_time_s),
                theta1_max_over_alpha1: over_alpha[0],
                theta2_max_over_alpha2: over_alpha[1],
                crack_opening_while_all_stand_rad: openings[m].largest_until(all_stand_s),
            }
        })
    }
}

/// How far the crack had opened by when.
#[derive(Debug, Default)]
struct CrackOpening {
    /// Times and openings, rad, each larger than the one before.
    record: Vec<(f64, f64)>,
}

impl CrackOpening {
    fn largest_until(&self, time_s: f64) -> f64 {
        self.record.iter().take_while(|(t, _)| *t <= time_s).last().map_or(0.0, |(_, opening)| *opening)
    }
}

impl Observer for CrackOpening {
    fn moved(&mut self, start_s: f64, _: Contact, motion: &Quintic) {
        let so_far = self.record.last().map_or(0.0, |(_, opening)| *opening);
        // Steps are shorter than a record's sample, so their ends find the largest opening to plotting accuracy.
        let opening = motion.difference().value(1.0).abs();
        if opening > so_far {
            self.record.push((start_s + motion.h(), opening));
        }
    }

    fn stood(&mut self, _: f64, _: f64) {}

    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

/// How bad a run was: a collapse is worse than any rotation, an early one worse than a late one.
fn severity(row: &ComparisonRow) -> (bool, f64) {
    match row.collapse_time_s {
        Some(time_s) => (true, -time_s),
        None => (false, row.theta1_max_over_alpha1.max(row.theta2_max_over_alpha2)),
    }
}

fn milder(a: &ComparisonRow, b: &ComparisonRow) -> bool {
    severity(a) < severity(b)
}

fn findings(law: &'static str, cases: &[[ComparisonRow; 3]]) -> Vec<Finding> {
    let cases = cases.iter().filter(|case| case[0].law == law && case.iter().all(|r| r.outcome != "failed"));
    let moved = |case: &&[ComparisonRow; 3]| case.iter().any(|row| row.theta1_max_over_alpha1 > 0.0);
    let cases = cases.filter(moved).collect::<Vec<_>>();
    let count = |claim: &'static str, judged: &dyn Fn(&[ComparisonRow; 3]) -> Option<bool>| {
        let verdicts = cases.iter().filter_map(|case| judged(case)).collect::<Vec<_>>();
        Finding { law, claim, holds: verdicts.iter().filter(|v| **v).count(), of: verdicts.len() }
    };
    let opening = |row: &ComparisonRow| row.crack_opening_while_all_stand_rad;
    vec![
        count("the calibrated model rotates less than the updated one", &|[c, u, _]| Some(milder(c, u))),
        count("the calibrated model rotates least of the three", &|[c, u, l]| {
            Some(milder(c, u) && milder(c, l))
        }),
        count("the lumped model opens its crack less than the updated one", &|[_, u, l]| {
            (opening(u) > 0.0 || opening(l) > 0.0).then(|| opening(l) < opening(u))
        }),
        count("where updated and lumped collapse, the updated one does first", &|[_, u, l]| {
            u.collapse_time_s.zip(l.collapse_time_s).map(|(u, l)| u < l)
        }),
        count("where another model collapses, the calibrated one stands or collapses last", &|[c, u, l]| {
            let first = u.collapse_time_s.into_iter().chain(l.collapse_time_s).fold(f64::INFINITY, f64::min);
            first.is_finite().then(|| c.collapse_time_s.is_none_or(|c| c > first))
        }),
    ]
}

/// The rows as CSV.
///
/// # Errors
/// What the stream says.
pub fn print_rows(out: &mut dyn Write, rows: &[ComparisonRow]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    for row in rows {
        csv.serialize(row)?;
    }
    csv.flush()
}

//! Quantiles over drawn façades and over records.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use polars::prelude::{Float64Chunked, PolarsResult};

use super::distributions::{Distribution, Distributions};
use super::group::{Group, in_plan_order};
use super::moved::{Comparison, moved};
use super::quantile::quantiles;
use super::resampled::Interval;
use super::two_way::{Drawn, Kept, intervals};
use super::variants::variant_notes;
use crate::error::{Error, Result};
use crate::store::frame::{self, Frame};
use crate::study::pipeline::Kind;
use crate::study::runs::{Completeness, run_files};

/// What is told of runs at given intensities.
const ROTATIONS: &[&str] = &[
    "theta1_max_over_alpha1",
    "theta2_max_over_alpha2",
    "theta_max_over_own_alpha",
    "theta1_max_over_alpha",
    "theta2_max_over_alpha",
];

/// What is told of incremental analyses: the intensity at which a limit is exceeded.
///
/// It lies between two columns, `stood_intensity` and `intensity`. The search halves the logarithm of that bracket,
/// so the geometric middle stands for it.
pub const CAPACITY: &str = "capacity";

/// The ends of the bracket.
const BRACKET: [&str; 2] = ["stood_intensity", "intensity"];

/// How runs at given intensities are compared between variants. Intensities are those asked for, to the bit.
const BY_ROTATION: Comparison = Comparison {
    labels: &[],
    numbers: &["draw", "factor"],
    outcome: "outcome",
    usable: "stood",
    compared: &["theta1_max_over_alpha1", "theta2_max_over_alpha2"],
};

/// The same of incremental analyses.
const BY_CAPACITY: Comparison = Comparison {
    labels: &["limit"],
    numbers: &["draw"],
    outcome: "limit_exceeded",
    usable: "true",
    compared: &["intensity"],
};

/// Runs that are listed for their intervals at once, of one quantity or of several: the lists of a million runs would take more memory
/// than all else.
const LISTED_AT_ONCE: usize = 200_000;

/// Quantiles of the study of drawn façades in `folder`: over all records, and by record.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn distributions(folder: &Path, kind: Kind) -> Result<Distributions> {
    let files = run_files(folder)?;
    let completeness = Completeness::of_files(folder, &files)?;
    let read = read(&files, kind).map_err(|e| Error::table(folder, e))?;
    Ok(Distributions { completeness, ..read })
}

fn read(files: &[PathBuf], kind: Kind) -> PolarsResult<Distributions> {
    let variants = variant_notes(files)?;
    let comparison = if kind == Kind::Incremental { &BY_CAPACITY } else { &BY_ROTATION };
    let moved = moved(files, &variants, comparison)?;
    let measure = measure(files)?;
    Ok(Distributions { kind, variants, moved, measure, completeness: None, rows: rows(files, kind)? })
}

fn rows(files: &[PathBuf], kind: Kind) -> PolarsResult<Vec<Distribution>> {
    let told = Told::of(kind);
    let frame = frame::read(files, &told.columns())?;
    let quantities: Vec<Quantity> =
        told.quantities.iter().map(|&name| Quantity::of(&frame, name)).collect::<PolarsResult<_>>()?;
    let places = Places::of(&frame)?;
    // Both before any draws stand in memory: of a million runs it is grouping them that takes most.
    let grouped = [false, true].map(|by_record| (by_record, in_plan_order(&frame, &told.keys(by_record))));
    let (mut rows, mut kept) = (Vec::new(), Kept::default());
    for (by_record, groups) in grouped {
        for group in groups? {
            rows.extend(told.distributions((&frame, &quantities, &places), &group, by_record, &mut kept)?);
        }
    }
    Ok(rows)
}

/// A quantity of every run.
struct Quantity<'a> {
    name: &'static str,
    numbers: Cow<'a, Float64Chunked>,
}

impl<'a> Quantity<'a> {
    fn of(frame: &'a Frame, name: &'static str) -> PolarsResult<Self> {
        let numbers = match name {
            CAPACITY => Cow::Owned(middles(frame)?),
            _ => Cow::Borrowed(frame.numbers(name)?),
        };
        Ok(Self { name, numbers })
    }
}

/// Of which record and façade each run is, by number.
struct Places {
    records: Vec<u32>,
    facades: Vec<u32>,
}

impl Places {
    fn of(frame: &Frame) -> PolarsResult<Self> {
        let (records, draws) = (frame.texts("record")?, frame.counts("draw")?);
        let (mut names, mut numbers) = (HashMap::new(), HashMap::new());
        let room = || Vec::with_capacity(frame.height());
        let mut places = Self { records: room(), facades: room() };
        for row in 0..frame.height() {
            let next = names.len() as u32;
            places.records.push(*names.entry(records.get(row)).or_insert(next));
            let next = numbers.len() as u32;
            places.facades.push(*numbers.entry(draws.get(row)).or_insert(next));
        }
        Ok(places)
    }

    /// The intervals of the quantiles of some quantities of a group: over façades and records, of one record over façades.
    /// `value` tells that of a quantity in a row.
    fn intervals(
        &self,
        group: &Group,
        by_record: bool,
        quantities: usize,
        value: impl Fn(usize, usize) -> Option<Option<f64>>,
        kept: &mut Kept,
    ) -> Vec<[Option<Interval>; 7]> {
        let all = group.rows.iter().map(|&row| self.records[row] as usize + 1);
        let records = if by_record { 1 } else { all.max().unwrap_or(1) };
        let runs_of = |quantity: usize| {
            let run = |&row: &usize| {
                let record = if by_record { 0 } else { self.records[row] };
                let value = value(quantity, row)?.unwrap_or(f64::INFINITY);
                Some(Drawn { value, record, facade: self.facades[row] })
            };
            // A million runs: not half as much memory again, as a list that grows would take.
            let mut runs = Vec::with_capacity(group.rows.len());
            runs.extend(group.rows.iter().filter_map(run));
            runs
        };
        let at_once = (LISTED_AT_ONCE / group.rows.len().max(1)).max(1);
        let some = |first: usize| (first..quantities.min(first + at_once)).map(runs_of).collect();
        (0..quantities).step_by(at_once).flat_map(|first| intervals(some(first), records, kept)).collect()
    }
}

/// Geometric middles of the brackets.
fn middles(frame: &Frame) -> PolarsResult<Float64Chunked> {
    let [stood, exceeded] = [frame.numbers(BRACKET[0])?, frame.numbers(BRACKET[1])?];
    let pairs = stood.iter().zip(exceeded.iter());
    Ok(pairs.map(|(stood, exceeded)| Some((stood? * exceeded?).sqrt())).collect())
}

/// What is told of the runs of a study, and the columns that it is read off.
struct Told {
    /// Column that tells runs apart beside variant, configuration and record.
    stratum: Option<&'static str>,
    quantities: &'static [&'static str],
    /// How a run ended, its value where the numbers exist, and its value where they lie above all numbers.
    ended: [&'static str; 3],
}

impl Told {
    fn of(kind: Kind) -> Self {
        let rotations =
            |stratum| Self { stratum, quantities: ROTATIONS, ended: ["outcome", "stood", "collapsed"] };
        match kind {
            Kind::Incremental => Self {
                stratum: Some("limit"),
                quantities: &[CAPACITY],
                // Null for a failed run, which has no answer.
                ended: ["limit_exceeded", "true", "false"],
            },
            Kind::Stripes => rotations(Some("intensity")),
            _ => rotations(None),
        }
    }

    fn keys(&self, by_record: bool) -> Vec<&'static str> {
        let record = by_record.then_some("record");
        ["variant", "configuration"].into_iter().chain(record).chain(self.stratum).collect()
    }

    fn columns(&self) -> Vec<&'static str> {
        let mut columns = self.keys(true);
        columns.extend(["run", "draw", "outcome"]);
        columns.extend(self.quantities.iter().filter(|name| **name != CAPACITY));
        if self.quantities.contains(&CAPACITY) {
            columns.extend(BRACKET);
        }
        columns.push(self.ended[0]);
        columns.sort_unstable();
        columns.dedup();
        columns
    }

    /// One row a quantity.
    fn distributions(
        &self,
        (frame, quantities, places): (&Frame, &[Quantity], &Places),
        group: &Group,
        by_record: bool,
        kept: &mut Kept,
    ) -> PolarsResult<Vec<Distribution>> {
        let first = group.first(frame);
        let [ended, numbered, beyond_text] = self.ended;
        let ended = frame.texts(ended)?;
        let beyond = group.how_many(ended, beyond_text);
        let value = |quantity: usize, row: usize| match ended.get(row) {
            Some(text) if text == numbered => quantities[quantity].numbers.get(row).map(Some),
            // Above all numbers.
            Some(text) if text == beyond_text => Some(None),
            _ => None,
        };
        let intervals = places.intervals(group, by_record, quantities.len(), value, kept);
        let one = |(quantity, intervals): (&Quantity, _)| {
            let numbers = group.sorted(&quantity.numbers, ended, numbered);
            Ok(Distribution {
                variant: first.text("variant")?,
                configuration: first.text("configuration")?,
                record: by_record.then(|| first.text("record")).transpose()?,
                intensity: match self.stratum {
                    Some("intensity") => first.optional_number("intensity")?,
                    _ => None,
                },
                limit: match self.stratum {
                    Some("limit") => Some(first.text("limit")?),
                    _ => None,
                },
                quantity: quantity.name,
                runs: group.len(),
                failed: group.how_many(frame.texts("outcome")?, "failed"),
                beyond,
                quantiles: quantiles(&numbers, beyond as usize),
                intervals,
            })
        };
        quantities.iter().zip(intervals).map(one).collect()
    }
}

/// The measure that records are scaled by, the same in all runs.
fn measure(files: &[PathBuf]) -> PolarsResult<Option<String>> {
    let first = frame::read(files.get(..1).unwrap_or_default(), &["intensity_measure"])?;
    Ok(first.texts("intensity_measure")?.get(0).map(str::to_owned))
}
